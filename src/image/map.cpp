#include "image/map.hpp"

#include "image/pyramid.hpp"
#include "image/slope_row.hpp"

#include <surfgrad/derivative.hpp>
#include <surfgrad/moments.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

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
  const std::size_t t = texel * static_cast<std::size_t>(image.channels);
  const vec3<double> m{2.0 * image.texels[t] - 1, 2.0 * image.texels[t + 1] - 1,
                       image.channels > 2 ? 2.0 * image.texels[t + 2] - 1 : 1.0};
  const bool finite = std::isfinite(m.x) && std::isfinite(m.y) && std::isfinite(m.z);
  return finite ? m : vec3<double>{0, 0, 0};
}

NormalChannels believed(const Image& image, NormalChannels channels) {
  if (channels != NormalChannels::automatic) return channels;
  const bool two = image.channels <= 2 || (third_channel_is_constant(image) && other_channels_vary(image));
  return two ? NormalChannels::xy : NormalChannels::xyz;
}

/// Of 8-bit files slopes need no more than 16 bits.
TexelCode code_for(const Image& image, const TexelRows& slopes) {
  return image.depth == Depth::unorm8 ? code_for_slopes(slopes, image.width, image.height) : TexelCode{};
}

/// The texels of a row of an image, one after the other: made(texel, where its components go).
template <class Made>
TexelRows rows_of_texels(const Image& image, std::size_t components, const Made& made) {
  return [&image, components, made](int y, float* row) {
    const auto width = static_cast<std::size_t>(image.width);
    for (std::size_t x = 0; x < width; ++x)
      made(static_cast<std::size_t>(y) * width + x, row + x * components);
  };
}

} // namespace

SlopeMap make_slope_map(const Image& image, NormalChannels channels, bool green_up, const RowsRead& read) {
  SlopeMap result;
  result.channels = believed(image, channels);
  const SlopeCode code{result.channels == NormalChannels::xy, green_up};
  std::vector<int> inward(static_cast<std::size_t>(image.height)); // of each row, however often it is made
  const TexelRows rows = [&](int y, float* row) {
    thread_local std::vector<float> scratch;
    scratch.resize(image.index(image.width, 0));
    const float* texels = image.texels.read(image.index(0, y), scratch.size(), scratch.data());
    inward[static_cast<std::size_t>(y)] =
        slope_row({texels, image.width, image.channels, code, !is_integer(image.depth), row});
  };
  result.map = with_pyramid(rows, image.width, image.height, 2, code_for(image, rows), read);
  result.inward_texels = std::accumulate(inward.begin(), inward.end(), std::int64_t{0});
  return result;
}

SlopeMap make_encoded_map(const Image& image, NormalChannels channels, bool green_up) {
  SlopeMap result;
  result.channels = believed(image, channels);
  const std::size_t components = result.channels == NormalChannels::xy ? 2 : 3;
  std::vector<int> inward(static_cast<std::size_t>(image.height)); // of each row, however often it is made
  const TexelRows rows = [&](int y, float* normal) {
    int count = 0;
    for (int x = 0; x < image.width; ++x) {
      const vec3<double> m = decoded(image, static_cast<std::size_t>(y) * image.width + x);
      const double encoded[] = {m.x, green_up ? m.y : -m.y, m.z};
      for (std::size_t c = 0; c < components; ++c) *normal++ = static_cast<float>(encoded[c]);
      count += components == 3 && !(m.z > 0) ? 1 : 0;
    }
    inward[static_cast<std::size_t>(y)] = count;
  };
  result.map = with_pyramid(rows, image.width, image.height, static_cast<int>(components));
  result.map.encoded = true;
  result.inward_texels = std::accumulate(inward.begin(), inward.end(), std::int64_t{0});
  return result;
}

Map make_slope_moments(const Map& slopes) {
  const TexelRows rows = [&](int y, float* texel) {
    for (int x = 0; x < slopes.width(); ++x, texel += 3) {
      const SlopeMoments<double> m =
          moments_from_derivative(vec2<double>{slopes.value(0, x, y, 0), slopes.value(0, x, y, 1)});
      texel[0] = static_cast<float>(m.square.x);
      texel[1] = static_cast<float>(m.square.y);
      texel[2] = static_cast<float>(m.product);
    }
  };
  return with_pyramid(rows, slopes.width(), slopes.height(), 3);
}

Map make_derivative_map(const Image& image, double range, bool green_up, NeutralCode neutral,
                        const RowsRead& read) {
  const double most = image.depth == Depth::unorm8 ? 255 : 65535;
  const double half = neutral == NeutralCode::between ? most / 2 : (most - 1) / 2; // codes of `range`
  const auto slope = [&](double value) {
    if (!is_integer(image.depth)) return range * value;
    return range * std::max(-1.0, (value * most - (most - half)) / half);
  };
  const TexelRows rows = rows_of_texels(image, 2, [&](std::size_t i, float* texel) {
    const std::size_t t = i * static_cast<std::size_t>(image.channels);
    vec2<double> d{slope(image.texels[t]), slope(image.texels[t + 1])};
    if (!std::isfinite(d.x) || !std::isfinite(d.y)) d = {0, 0};
    d = (max_slope / std::max<double>(max_slope, max_abs(d))) * d;
    texel[0] = static_cast<float>(d.x);
    texel[1] = static_cast<float>(green_up ? d.y : -d.y);
  });
  return with_pyramid(rows, image.width, image.height, 2, code_for(image, rows), read);
}

Map make_direction_map(const Image& image, bool green_up) {
  const TexelRows rows = rows_of_texels(image, 3, [&](std::size_t i, float* direction) {
    const vec3<double> u = normalize_or_zero(decoded(image, i));
    direction[0] = static_cast<float>(u.x);
    direction[1] = static_cast<float>(green_up ? u.y : -u.y);
    direction[2] = static_cast<float>(u.z);
  });
  return with_pyramid(rows, image.width, image.height, 3);
}

Map make_channel_map(const Image& image, int channel) {
  const int source = image.source_of(channel);
  const TexelRows rows = rows_of_texels(image, 1, [&](std::size_t i, float* weight) {
    const float value =
        source < 0 ? 1.0f : image.texels[i * static_cast<std::size_t>(image.channels) + source];
    *weight = min(max(value, 0.0f), 1.0f); // NaN becomes 0
  });
  const TexelCode code =
      is_integer(image.depth) ? code_for_scalars(rows, image.width, image.height) : TexelCode{};
  return with_pyramid(rows, image.width, image.height, 1, code);
}

} // namespace surfgrad::image
