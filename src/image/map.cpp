#include "image/map.hpp"

#include "image/parallel.hpp"
#include "image/pyramid.hpp"

#include <surfgrad/derivative.hpp>
#include <surfgrad/moments.hpp>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace surfgrad::image {
namespace {

bool third_channel_is_constant(const Image& image) {
  const float first = image.at(0, 0, 2);
  for (std::size_t i = 2; i < image.texels.size(); i += static_cast<std::size_t>(image.channels))
    if (image.texels[i] != first) return false;
  return true;
}

/// A flat map has a constant third channel too, but a telling one: all its texels are (0, 0, z).
bool other_channels_vary(const Image& image) {
  const auto n = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.texels.size(); i += n)
    if (image.texels[i] != image.texels[0] || image.texels[i + 1] != image.texels[1]) return true;
  return false;
}

/// In double: a slope or direction is rounded once, when it is stored. Zero for a texel of a float file
/// that is not finite, which would otherwise spread over every level.
vec3<double> decoded(const Image& image, std::size_t texel) {
  const float* t = &image.texels[texel * static_cast<std::size_t>(image.channels)];
  const vec3<double> m{2.0 * t[0] - 1, 2.0 * t[1] - 1, image.channels > 2 ? 2.0 * t[2] - 1 : 1.0};
  const bool finite = std::isfinite(m.x) && std::isfinite(m.y) && std::isfinite(m.z);
  return finite ? m : vec3<double>{0, 0, 0};
}

std::size_t texel_count(const Image& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

NormalChannels believed(const Image& image, NormalChannels channels) {
  if (channels != NormalChannels::automatic) return channels;
  const bool two = image.channels <= 2 || (third_channel_is_constant(image) && other_channels_vary(image));
  return two ? NormalChannels::xy : NormalChannels::xyz;
}

/// Runs over the texels in parallel, each writing to its own place, and counts those that say so.
template <class Texel>
std::int64_t count_in_texels(const Image& image, const Texel& texel) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, texel_count(image), 32768), std::int64_t{0},
      [&](const tbb::blocked_range<std::size_t>& block, std::int64_t count) {
        for (std::size_t i = block.begin(); i != block.end(); ++i) count += texel(i) ? 1 : 0;
        return count;
      },
      std::plus<>());
}

/// Of 8-bit files slopes need no more than 16 bits.
TexelCode code_for(const Image& image, const std::vector<float>& slopes) {
  return image.depth == Depth::unorm8 ? code_for_slopes(slopes) : TexelCode{};
}

} // namespace

SlopeMap make_slope_map(const Image& image, NormalChannels channels, bool green_up) {
  SlopeMap result;
  result.channels = believed(image, channels);
  std::vector<float> slopes(2 * texel_count(image));
  result.inward_texels = count_in_texels(image, [&](std::size_t i) {
    const vec3<double> m = decoded(image, i);
    const bool two = result.channels == NormalChannels::xy;
    const vec2<double> d = two ? derivative_from_normal(vec2<double>{m.x, m.y}) : derivative_from_normal(m);
    slopes[2 * i] = static_cast<float>(d.x);
    slopes[2 * i + 1] = static_cast<float>(green_up ? d.y : -d.y);
    return !two && !(m.z > 0);
  });
  const TexelCode code = code_for(image, slopes);
  result.map = with_pyramid(std::move(slopes), image.width, image.height, 2, code);
  return result;
}

SlopeMap make_encoded_map(const Image& image, NormalChannels channels, bool green_up) {
  SlopeMap result;
  result.channels = believed(image, channels);
  const std::size_t components = result.channels == NormalChannels::xy ? 2 : 3;
  std::vector<float> normals(components * texel_count(image));
  result.inward_texels = count_in_texels(image, [&](std::size_t i) {
    const vec3<double> m = decoded(image, i);
    const double encoded[] = {m.x, green_up ? m.y : -m.y, m.z};
    for (std::size_t c = 0; c < components; ++c) normals[components * i + c] = static_cast<float>(encoded[c]);
    return components == 3 && !(m.z > 0);
  });
  result.map = with_pyramid(std::move(normals), image.width, image.height, static_cast<int>(components));
  result.map.encoded = true;
  return result;
}

Map make_slope_moments(const Map& slopes) {
  const int width = slopes.width();
  const int height = slopes.height();
  std::vector<float> moments(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  in_parallel(static_cast<std::size_t>(height), static_cast<std::size_t>(width), [&](std::size_t y) {
    float* texel = &moments[3 * y * static_cast<std::size_t>(width)];
    for (int x = 0; x < width; ++x, texel += 3) {
      const int row = static_cast<int>(y);
      const SlopeMoments<double> m =
          moments_from_derivative(vec2<double>{slopes.value(0, x, row, 0), slopes.value(0, x, row, 1)});
      texel[0] = static_cast<float>(m.square.x);
      texel[1] = static_cast<float>(m.square.y);
      texel[2] = static_cast<float>(m.product);
    }
  });
  return with_pyramid(std::move(moments), width, height, 3);
}

Map make_derivative_map(const Image& image, double range, bool green_up, NeutralCode neutral) {
  const double most = image.depth == Depth::unorm8 ? 255 : 65535;
  const double half = neutral == NeutralCode::between ? most / 2 : (most - 1) / 2; // codes of `range`
  const auto slope = [&](double value) {
    if (!is_integer(image.depth)) return range * value;
    return range * std::max(-1.0, (value * most - (most - half)) / half);
  };
  std::vector<float> slopes(2 * texel_count(image));
  in_parallel(texel_count(image), 1, [&](std::size_t i) {
    const float* t = &image.texels[i * static_cast<std::size_t>(image.channels)];
    vec2<double> d{slope(t[0]), slope(t[1])};
    if (!std::isfinite(d.x) || !std::isfinite(d.y)) d = {0, 0};
    d = (max_slope / std::max<double>(max_slope, max_abs(d))) * d;
    slopes[2 * i] = static_cast<float>(d.x);
    slopes[2 * i + 1] = static_cast<float>(green_up ? d.y : -d.y);
  });
  const TexelCode code = code_for(image, slopes);
  return with_pyramid(std::move(slopes), image.width, image.height, 2, code);
}

Map make_direction_map(const Image& image, bool green_up) {
  std::vector<float> directions(3 * texel_count(image));
  in_parallel(texel_count(image), 1, [&](std::size_t i) {
    const vec3<double> u = normalize_or_zero(decoded(image, i));
    directions[3 * i] = static_cast<float>(u.x);
    directions[3 * i + 1] = static_cast<float>(green_up ? u.y : -u.y);
    directions[3 * i + 2] = static_cast<float>(u.z);
  });
  return with_pyramid(std::move(directions), image.width, image.height, 3);
}

Map make_channel_map(const Image& image, int channel) {
  const int source = image.source_of(channel);
  std::vector<float> values(texel_count(image), 1.0f);
  for (std::size_t i = 0; source >= 0 && i < values.size(); ++i) {
    const float value = image.texels[i * static_cast<std::size_t>(image.channels) + source];
    values[i] = min(max(value, 0.0f), 1.0f); // NaN becomes 0
  }
  const TexelCode code = is_integer(image.depth) ? code_for_scalars(values) : TexelCode{};
  return with_pyramid(std::move(values), image.width, image.height, 1, code);
}

} // namespace surfgrad::image
