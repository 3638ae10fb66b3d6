#pragma once

#include "image/image.hpp"
#include "maps/differentiate.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::maps {

/// Heights whose slopes are nearest to those of a map.
struct Integrated {
  image::Image heights{}; ///< one channel of floats with the mean 0, in texels as far as slopes have no scale
  /// Slopes of these heights by the same kernel leave out what no surface has: the root of its mean square,
  /// over that of all slopes but their mean. 0 for a map that was made from heights.
  double not_integrable = 0;
  vec2<double> tilt{0, 0}; ///< mean slope, which repeated heights cannot have
};

/// Integrates slopes: of all heights those whose slopes differ least in the mean square.
///
/// slopes  two channels, (dh/ds, dh/dt) in units of height per texel
/// repeat  heights that repeat, by a Fourier transform: their slopes by `kernel` are the nearest to the
/// map's.
///         The mean slope is left out. Waves of which the kernel shows less than a third of the slopes
///         (nearly half a period a texel) fade: they would be made of noise.
/// clamp   heights whose steps from texel to texel are nearest to the integral of the slopes between them (of
///         the cubic through four texels, at a border of the parabola through three): a Poisson equation
///         with natural borders, by a cosine transform. A tilted plane stays one; `kernel` does not matter.
/// source  Frankot and Chellappa 1988, "A method for enforcing integrability in shape from shading", with the
///         kernel's own response in place of the true derivative's; Simchony, Chellappa and Shao 1990,
///         "Direct analytical methods for solving Poisson equations in computer vision problems"
/// memory  12 bytes a texel while it works, slopes that are moved here among them
[[nodiscard]] Integrated integrate(image::Image slopes, Kernel kernel, Border border);

} // namespace surfgrad::maps
