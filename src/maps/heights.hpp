#pragma once

#include "image/image.hpp"
#include "maps/borders.hpp"
#include "maps/kernels.hpp"

#include <surfgrad/vec.hpp>

#include <filesystem>

namespace surfgrad::maps {

/// How heights are measured.
struct Relief {
  /// Slopes along s and t where neighbouring texels differ by 1: the height of 1 over the side of a texel.
  vec2<double> slope_scale{1, 1};
  Kernel kernel = Kernel::scharr;
  Borders borders = Borders::wrap;
};

/// Slope scale of a map whose height of 1 is `height` and which is `size` wide and high, in the same units.
[[nodiscard]] inline vec2<double> slope_scale_of(double height, vec2<double> size, const image::Image& map) {
  return {height * map.width / size.x, height * map.height / size.y};
}

/// The slopes (dh/ds, dh/dt) of heights: an image of two channels in floats.
///
/// heights  the first channel of a picture in floats
/// error    computed in double, rounded once
[[nodiscard]] image::Image slopes_of_heights(const image::Image& heights, const Relief& relief);

} // namespace surfgrad::maps
