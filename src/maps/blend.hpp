#pragma once

#include "image/image.hpp"

#include <surfgrad/vec.hpp>

#include <vector>

namespace surfgrad::maps {

/// How a detail is put onto a base. All but the first are here to be compared with.
enum class Method {
  surface_gradient,   ///< slopes add up, as those of heights do
  linear,             ///< normals add up
  overlay,            ///< as colours are overlaid
  partial_derivative, ///< slopes add up, in a formula for normals: equal to the first
  whiteout,           ///< x and y add up, z is multiplied
  udn,                ///< x and y add up, z is the base's
  rnm,                ///< reoriented: the detail is turned with the base's normal
};

/// A detail over a base whose texture coordinates it shares.
struct Detail {
  image::Image slopes{};     ///< two channels of floats
  double weight = 1;         ///< of its slopes, any sign
  image::Image mask{};       ///< one channel of the base's size, a factor of the weight; empty: 1
  vec2<double> tile{1, 1};   ///< how often it repeats, neither 0; a negative one mirrors
  double rotate_deg = 0;     ///< counter-clockwise, of its coordinates: (s, t)' = R (tile * (s, t)) + offset
  vec2<double> offset{0, 0}; ///< in units of the detail
};

/// The base with all details, one after the other. Slopes of a detail stay what they are however often it
/// repeats, as in a stack's normal maps; where it is minified they are filtered (trilinear).
///
/// base     slopes, two channels of floats
/// returns  slopes, shortened along their direction to components within +-max_slope
/// source   surface_gradient: Mikkelsen 2020, section 2; rnm: Barre-Brisebois and Hill 2012, "Blending in
/// Detail",
///          as are the formulas of the others
/// Same result for any number of threads.
[[nodiscard]] image::Image blended(image::Image base, const std::vector<Detail>& details, Method method);

} // namespace surfgrad::maps
