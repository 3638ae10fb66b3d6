#pragma once

#include "shadergen/maps.hpp"

namespace surfgrad::shadergen {

/// How the slope of heights is measured in a pixel (engine/layers/height_map.hpp).
struct HeightTaps {
  bool smooth = false;      ///< where magnified, from a smooth surface through 4x4 texels
  bool across_quad = false; ///< one height a pixel, differences within blocks of 2x2
};

/// Change of the height per pixel to the right and upwards, in units of the map's values: a function of (vec2
/// st, vec2 dst_dx, vec2 dst_dy, vec2 step_x, vec2 step_y), the footprint of mip levels and the pixel's own
/// steps, and with across_quad (vec2 raster); its name.
[[nodiscard]] std::string height_per_pixel_function(const MapUse& map, Generator& generator, HeightTaps taps);

/// Slope of the smooth surface by the whole map: a function of (vec2 at); its name.
[[nodiscard]] std::string smooth_slope_function(const MapUse& heights, Generator& generator);

/// The same and the height itself: a function that gives vec3.
[[nodiscard]] std::string smooth_function(const MapUse& heights, Generator& generator);

/// The mip level on the plane of a map, unclamped: an expression of dst_dx and dst_dy.
[[nodiscard]] std::string level_of_detail(const MapUse& map);

} // namespace surfgrad::shadergen
