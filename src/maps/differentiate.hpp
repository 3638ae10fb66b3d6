#pragma once

#include "image/image.hpp"

namespace surfgrad::maps {

/// How neighbouring heights make a slope. Of a wave of w radians a texel along the slope's axis and v across
/// it, a kernel shows this share of the true slope.
enum class Kernel {
  central, ///< sin(w) / w
  sobel,   ///< sin(w) / w * (1 + cos(v)) / 2
  scharr,  ///< sin(w) / w * (5 + 3 cos(v)) / 8
  bspline, ///< 3 sin(w) / (2 + cos(w)) / w: derivative of the cubic spline through the heights
};

/// What lies beyond the border of a map.
enum class Border {
  repeat, ///< the map again
  clamp,  ///< nothing: slopes there are those of the last texels, so that a plane stays one
};

/// What a kernel makes of a wave: its slopes are i * slope_along(w) * share_across(v) times the wave itself,
/// where true ones are i * w times. w and v in radians a texel.
///
/// source  sums of the kernel's weights times exp(i w x)
[[nodiscard]] double slope_along(Kernel kernel, double w);
[[nodiscard]] double share_across(Kernel kernel, double v);

/// Slopes of heights in units of height per texel: (dh/ds, dh/dt), two channels of floats.
///
/// heights  one channel of finite values
/// scale    factor of the slopes
/// A map with one texel along an axis is flat along it. Computed in double, rounded once; the same for any
/// number of threads. Slopes are shortened along their direction to components within +-max_slope, as those
/// of normal maps are.
[[nodiscard]] image::Image slopes_of_heights(image::Image heights, Kernel kernel, Border border,
                                             double scale);

} // namespace surfgrad::maps
