#include "image/pyramid.hpp"

#include <algorithm>
#include <bit>

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

} // namespace

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

} // namespace surfgrad::image
