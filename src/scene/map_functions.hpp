#pragma once

/// What procedural maps are made of: periodic functions and the normal map of a height function.

#include "image/image.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <cmath>

namespace surfgrad::scene {

/// Stores a unit normal in a texel of a 16-bit normal map.
inline void set_normal(image::Image& map, int x, int y, vec3<double> n) {
  const auto code = [](double v) {
    return static_cast<float>(std::floor((0.5 * v + 0.5) * 65535 + 0.5) / 65535);
  };
  map.at(x, y, 0) = code(n.x);
  map.at(x, y, 1) = code(n.y);
  map.at(x, y, 2) = code(n.z);
}

/// Normal map of a periodic height function h(s, t), slopes by central differences of the function
/// itself (not of texels), stored as 16-bit codes.
template <class Height>
image::Image normal_map_of(int size, const Height& height) {
  image::Image map = image::make_image(size, size, 3, image::Depth::unorm16);
  const double step = 0.25 / size; // a quarter texel: finer than the map, coarser than rounding
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double s = (x + 0.5) / size;
      const double t = (y + 0.5) / size;
      const vec2<double> slope{(height(s + step, t) - height(s - step, t)) / (2 * step),
                               (height(s, t + step) - height(s, t - step)) / (2 * step)};
      set_normal(map, x, y, normal_from_derivative(slope));
    }
  return map;
}

inline double fraction(double v) { return v - std::floor(v); }

/// 0 below a, 1 above b, smooth in between.
inline double smooth(double a, double b, double v) {
  const double t = std::clamp((v - a) / (b - a), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// One smooth bump over a period, 0 at both ends: a polynomial, so that it is the same everywhere.
inline double arch(double v) {
  const double u = 2 * fraction(v) - 1;
  return (1 - u * u) * (1 - u * u);
}

} // namespace surfgrad::scene
