#pragma once

#include "image/map.hpp"

#include <cstdint>
#include <vector>

namespace surfgrad::image {

/// A height map made ready for rays: for each mip level, a pyramid of maxima over its cells.
///
/// A cell is the bilinear patch between the centres of four neighbouring texels, numbered as the texel at
/// its lower left; the last one of a row or column joins the last texel to the first. That bounds every
/// wrap: the constant cells outside a clamped or mirrored border show one of the same texels.
///
/// Node (i, j) of order k holds the largest height over the cells from (i, j) * 2^k up to, without, (i + 1,
/// j + 1) * 2^k, as far as there are cells. Order 0 is not stored, as a ray that reaches a cell reads its
/// texels anyway; the last order is one node. Minima are not stored either: they could only confirm that a
/// ray is below the surface, and a ray that comes from above stops before it is.
///
/// memory  4 bytes a texel, 1.33 for the mip levels, 1.33 * 0.33 for the maxima: 7.1 bytes a texel of the
///         image (a little more for small maps, and for sizes that are no powers of two)
struct HeightField {
  Map map{}; ///< one component, in floats
  int row_words = 0;
  std::vector<std::uint32_t> maxima{}; ///< float bits, row 0 at the bottom
  /// Of each mip level row_words words: the last order, then the first word of orders 1, 2, ... in maxima.
  std::vector<std::uint32_t> node_table{};

  [[nodiscard]] Words nodes() const { return {maxima.data(), static_cast<std::int32_t>(maxima.size())}; }
  [[nodiscard]] Words rows() const {
    return {node_table.data(), static_cast<std::int32_t>(node_table.size())};
  }
};

/// A height field for rays from either side of the surface.
struct TwoSidedField {
  HeightField from_above{};
  HeightField from_below{}; ///< of the depths 1 - h, which are heights to whoever looks from there
};

/// A map is no wider or higher than this: all cell numbers that a ray meets are then exact in float.
inline constexpr int height_field_most_texels = 1 << 20;

/// heights  one component within [0, 1] (make_channel_map), at most height_field_most_texels a side
[[nodiscard]] HeightField make_height_field(Map heights);
[[nodiscard]] TwoSidedField make_two_sided_field(Map heights);

} // namespace surfgrad::image
