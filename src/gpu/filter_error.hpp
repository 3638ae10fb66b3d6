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
/// derivation  Within a cell of four texels a bilinear filter changes, per texel along an axis, by no more
/// than
///             the cell's edges along that axis do. A coordinate that is off by e texels along both axes
///             passes cells whose edges sum to no more than the steepest cell's: e times that. Blending two
///             levels changes, per level, by their difference where they are read, which is largest at a
///             texel of one of them: there the two piecewise bilinear functions have their corners. So
///
///               precision.texel * steepest cell of any level + precision.level * largest difference of
///               levels
///
///             to which come the rounding of coordinates in float, and of texels.
/// nearest     the texel is found as the engine finds it: rounding alone
[[nodiscard]] double filter_error(const image::Map& map, image::Wraps wraps, image::Filter filter,
                                  FilterPrecision precision);

/// The longest texel, all components together: no filter gives more.
[[nodiscard]] double longest_texel(const image::Map& map);

} // namespace surfgrad::gpu
