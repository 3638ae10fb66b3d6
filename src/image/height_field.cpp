#include "image/height_field.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace surfgrad::image {
namespace {

struct Grid {
  int width;
  int height;
  std::vector<float> values;

  [[nodiscard]] float at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

Grid texels_of(const Map& map, int level) {
  Grid grid{map.width(level), map.height(level), {}};
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) grid.values.push_back(static_cast<float>(map.value(level, x, y)));
  return grid;
}

Grid cell_maxima(const Grid& texels) {
  Grid cells{texels.width, texels.height, {}};
  for (int y = 0; y < texels.height; ++y)
    for (int x = 0; x < texels.width; ++x) {
      const int right = x + 1 < texels.width ? x + 1 : 0;
      const int above = y + 1 < texels.height ? y + 1 : 0;
      cells.values.push_back(std::max(std::max(texels.at(x, y), texels.at(right, y)),
                                      std::max(texels.at(x, above), texels.at(right, above))));
    }
  return cells;
}

Grid next_order(const Grid& nodes) {
  Grid result{(nodes.width + 1) / 2, (nodes.height + 1) / 2, {}};
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      const int right = std::min(2 * x + 1, nodes.width - 1);
      const int above = std::min(2 * y + 1, nodes.height - 1);
      result.values.push_back(std::max(std::max(nodes.at(2 * x, 2 * y), nodes.at(right, 2 * y)),
                                       std::max(nodes.at(2 * x, above), nodes.at(right, above))));
    }
  return result;
}

/// Orders up to the one whose single node holds all cells.
int last_order(int width, int height) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(width, height) - 1)));
}

/// The same map in floats: a ray reads it texel by texel.
Map in_floats(Map map) {
  if (map.format == TexelFormat::unorm16)
    for (std::uint32_t& word : map.words)
      word = std::bit_cast<std::uint32_t>(static_cast<float>(map.scale * (word & 0xffffu)));
  map.format = TexelFormat::floats;
  map.scale = 1;
  return map;
}

} // namespace

HeightField make_height_field(Map heights) {
  assert(heights.components == 1);
  heights = in_floats(std::move(heights));
  assert(std::max(heights.width(), heights.height()) <= height_field_most_texels);
  HeightField field;
  field.row_words = 1 + last_order(heights.width(), heights.height());
  for (int level = 0; level < heights.level_count; ++level) {
    const int last = last_order(heights.width(level), heights.height(level));
    const std::size_t row = field.node_table.size();
    field.node_table.resize(row + static_cast<std::size_t>(field.row_words));
    field.node_table[row] = static_cast<std::uint32_t>(last);
    Grid nodes = cell_maxima(texels_of(heights, level));
    for (int order = 1; order <= last; ++order) {
      nodes = next_order(nodes);
      field.node_table[row + static_cast<std::size_t>(order)] =
          static_cast<std::uint32_t>(field.maxima.size());
      for (const float v : nodes.values) field.maxima.push_back(std::bit_cast<std::uint32_t>(v));
    }
  }
  if (field.maxima.empty()) field.maxima.push_back(0); // see Words
  field.map = std::move(heights);
  return field;
}

TwoSidedField make_two_sided_field(Map heights) {
  heights = in_floats(std::move(heights));
  Map depths = heights;
  for (std::uint32_t& word : depths.words)
    word = std::bit_cast<std::uint32_t>(1.0f - std::bit_cast<float>(word));
  return {make_height_field(std::move(heights)), make_height_field(std::move(depths))};
}

} // namespace surfgrad::image
