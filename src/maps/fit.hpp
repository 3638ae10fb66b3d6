#pragma once

#include "image/image.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::maps {

/// How well one map's slopes follow another's.
struct Fit {
  vec2<double> correlation{0, 0}; ///< along s and t; 0 where either does not vary
  double scale = 0;               ///< by which the first are to be multiplied to be nearest to the second
};

/// slopes, reference  two channels in floats, of the same size
[[nodiscard]] Fit fit_slopes(const image::Image& slopes, const image::Image& reference);

} // namespace surfgrad::maps
