#pragma once

#include "image/map.hpp"
#include "image/sampler.hpp"

namespace surfgrad::gpu {

/// How far what a device's filters weigh by may lie from what it is given.
struct FilterPrecision {
  double texel = 0; ///< of a coordinate, in texels of a level
  double level = 0; ///< of a level of detail
};

/// How far a map filtered so is at most from the map filtered exactly: the length of the difference of their
/// components.
///
/// derivation  Within a cell of four texels a bilinear filter changes along an axis, per texel, by no more
///             than the cell's edges along that axis. A coordinate that is off by e texels along both axes
///             passes cells none of which is steeper than the steepest. A blend of two levels changes, per
///             level, by their difference there. Both are bilinear between the lines through texels of
///             either, so that it is largest where two such lines cross. The error is at most
///
///               precision.texel * steepest cell + precision.level * largest difference of levels
///
///             of all levels, and what rounding adds, of coordinates in float and of texels.
/// nearest     the texel is found as the engine finds it: rounding alone
[[nodiscard]] double filter_error(const image::Map& map, image::Wraps wraps, image::Filter filter,
                                  FilterPrecision precision);

/// The longest texel, all components together: no filter gives more.
[[nodiscard]] double longest_texel(const image::Map& map);

} // namespace surfgrad::gpu
