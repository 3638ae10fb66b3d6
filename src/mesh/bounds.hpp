#pragma once

#include <surfgrad/vec.hpp>

#include <limits>
#include <span>

namespace surfgrad::mesh {

/// An axis-aligned box, closed on all sides. Empty, with low above high, until something is in it.
struct Bounds {
  vec3<double> low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  vec3<double> high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};
};

[[nodiscard]] inline bool is_empty(const Bounds& b) {
  return !(b.low.x <= b.high.x && b.low.y <= b.high.y && b.low.z <= b.high.z);
}

/// The smallest box around both; an empty one adds nothing.
[[nodiscard]] inline Bounds unite(const Bounds& a, const Bounds& b) {
  if (is_empty(a)) return b;
  if (is_empty(b)) return a;
  return {{min(a.low.x, b.low.x), min(a.low.y, b.low.y), min(a.low.z, b.low.z)},
          {max(a.high.x, b.high.x), max(a.high.y, b.high.y), max(a.high.z, b.high.z)}};
}

/// The smallest box around the points. Points with a non-finite coordinate are left out; no points
/// give an empty box.
[[nodiscard]] inline Bounds bounds_of(std::span<const vec3<float>> points) {
  constexpr float largest = std::numeric_limits<float>::max();
  Bounds bounds;
  for (const vec3<float>& p : points) {
    // Comparisons with NaN are false.
    if (!(abs(p.x) <= largest && abs(p.y) <= largest && abs(p.z) <= largest)) continue;
    const vec3<double> q{p.x, p.y, p.z};
    bounds = unite(bounds, {q, q});
  }
  return bounds;
}

/// The middle of the box; the origin if it is empty.
[[nodiscard]] inline vec3<double> center(const Bounds& b) {
  return is_empty(b) ? vec3<double>{0, 0, 0} : 0.5 * (b.low + b.high);
}

/// Half the diagonal: the radius of the sphere around center() that holds the box; 0 if it is empty.
[[nodiscard]] inline double radius(const Bounds& b) {
  return is_empty(b) ? 0.0 : 0.5 * length(b.high - b.low);
}

} // namespace surfgrad::mesh
