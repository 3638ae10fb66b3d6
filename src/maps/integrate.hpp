#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "maps/borders.hpp"
#include "maps/kernels.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::maps {

/// How slopes become heights.
struct Integration {
  Borders borders = Borders::wrap;
  /// With borders that wrap: what the slopes were measured with. The heights that are returned are those it
  /// made these slopes of, but for waves that it hardly sees: they are left out.
  Kernel kernel = Kernel::scharr;
  vec2<double> texel{1, 1}; ///< sides of a texel, in the unit of the heights
};

/// The heights whose slopes are nearest to these in the sum of squares: an image of one channel in floats, of
/// mean 0. Slopes that no surface has (with a curl) are shared out evenly.
///
/// wrap   by Fourier transforms. Heights tile; the mean slope, which no such heights have, is left out.
/// clamp  by cosine transforms of the Poisson equation whose heights are free at the border (Simchony,
/// Chellappa
///        and Shao 1990), for the rise from texel to texel: the integral of the cubic through four slopes, at
///        a border of the parabola through three. Exact for heights of degree 3 there.
/// slopes  taken over: memory is that of the slopes and the heights
///
/// Same result for any number of threads. Throws Cancelled where the progress callback asks to stop.
[[nodiscard]] image::Image heights_of_slopes(image::Image slopes, const Integration& integration,
                                             const Report& report = {});

} // namespace surfgrad::maps
