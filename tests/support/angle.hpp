#pragma once

/// How far two unit normals are apart.

#include <surfgrad/vec.hpp>

#include <cmath>
#include <numbers>

namespace surfgrad::test {

/// Angle between two unit vectors in degrees; 180 where one of them is none. An angle alone does not tell:
/// atan2 gives 0 for a zero vector, and any length for a scaled one.
///
/// Both zero are no surface, and equal.
inline double unit_angle(vec3<double> a, vec3<double> b) {
  constexpr double most_off = 1e-4; // a normalization in float is off by some 1e-7, a missing one by far more
  if (max_abs(a) == 0 && max_abs(b) == 0) return 0;
  for (const vec3<double>& v : {a, b})
    if (!(std::abs(length(v) - 1) < most_off)) return 180; // NaN too
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

} // namespace surfgrad::test
