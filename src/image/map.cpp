#include "image/map.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace surfgrad::image {
namespace {

using Texels = std::vector<float>;

/// Texels of the next lower level along one axis: the average over each texel's exact footprint, so
/// that odd sizes neither shift nor lose energy.
struct Footprint {
  int first;
  std::vector<double> weights; // sum to 1
};

std::vector<Footprint> footprints(int from, int to) {
  std::vector<Footprint> result;
  const double scale = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double low = i * scale;
    const double high = (i + 1) * scale;
    Footprint f{static_cast<int>(low), {}};
    for (int j = f.first; j < from && j < high; ++j)
      f.weights.push_back((std::min<double>(j + 1, high) - std::max<double>(j, low)) / scale);
    result.push_back(std::move(f));
  }
  return result;
}

Texels halve(const Texels& source, int width, int height, int to_width, int to_height, int components) {
  const auto columns = footprints(width, to_width);
  const auto rows = footprints(height, to_height);
  Texels result(static_cast<std::size_t>(to_width) * to_height * components);
  for (int y = 0; y < to_height; ++y)
    for (int x = 0; x < to_width; ++x)
      for (int c = 0; c < components; ++c) {
        double sum = 0; // double: a sum of up to nine terms stays exact to float rounding
        for (std::size_t j = 0; j < rows[y].weights.size(); ++j)
          for (std::size_t i = 0; i < columns[x].weights.size(); ++i) {
            const std::size_t texel = (rows[y].first + j) * width + columns[x].first + i;
            sum += rows[y].weights[j] * columns[x].weights[i] * source[texel * components + c];
          }
        result[(static_cast<std::size_t>(y) * to_width + x) * components + c] = static_cast<float>(sum);
      }
  return result;
}

Map with_pyramid(Texels texels, int width, int height, int components) {
  Map map;
  map.components = components;
  for (;;) {
    map.level_table.insert(map.level_table.end(),
                           {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                            static_cast<std::uint32_t>(map.words.size())});
    ++map.level_count;
    for (const float t : texels) map.words.push_back(std::bit_cast<std::uint32_t>(t));
    if (width == 1 && height == 1) return map;
    const int to_width = std::max(1, width / 2);
    const int to_height = std::max(1, height / 2);
    texels = halve(texels, width, height, to_width, to_height, components);
    width = to_width;
    height = to_height;
  }
}

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

} // namespace

SlopeMap make_slope_map(const Image& image, NormalChannels channels, bool green_up) {
  SlopeMap result;
  if (channels == NormalChannels::automatic) {
    const bool two = image.channels <= 2 || (third_channel_is_constant(image) && other_channels_vary(image));
    channels = two ? NormalChannels::xy : NormalChannels::xyz;
  }
  result.channels = channels;
  Texels slopes(2 * texel_count(image));
  for (std::size_t i = 0; i < texel_count(image); ++i) {
    const vec3<double> m = decoded(image, i);
    const vec2<double> d = channels == NormalChannels::xy ? derivative_from_normal(vec2<double>{m.x, m.y})
                                                          : derivative_from_normal(m);
    if (channels == NormalChannels::xyz && !(m.z > 0)) ++result.inward_texels;
    slopes[2 * i] = static_cast<float>(d.x);
    slopes[2 * i + 1] = static_cast<float>(green_up ? d.y : -d.y);
  }
  result.map = with_pyramid(std::move(slopes), image.width, image.height, 2);
  return result;
}

Map make_direction_map(const Image& image, bool green_up) {
  Texels directions(3 * texel_count(image));
  for (std::size_t i = 0; i < texel_count(image); ++i) {
    const vec3<double> u = normalize_or_zero(decoded(image, i));
    directions[3 * i] = static_cast<float>(u.x);
    directions[3 * i + 1] = static_cast<float>(green_up ? u.y : -u.y);
    directions[3 * i + 2] = static_cast<float>(u.z);
  }
  return with_pyramid(std::move(directions), image.width, image.height, 3);
}

Map make_channel_map(const Image& image, int channel) {
  const int alpha = image.has_alpha ? image.channels - 1 : image.channels == 4 ? 3 : -1;
  const int colors = image.has_alpha ? image.channels - 1 : image.channels;
  const int source = channel == 3 ? alpha : std::min(channel, colors - 1);
  Texels values(texel_count(image), 1.0f);
  for (std::size_t i = 0; source >= 0 && i < values.size(); ++i) {
    const float value = image.texels[i * static_cast<std::size_t>(image.channels) + source];
    values[i] = min(max(value, 0.0f), 1.0f); // NaN becomes 0
  }
  return with_pyramid(std::move(values), image.width, image.height, 1);
}

} // namespace surfgrad::image
