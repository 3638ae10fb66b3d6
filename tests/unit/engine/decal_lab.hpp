#pragma once

/// Decals at fragments whose every number is known.

#include "lab.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace surfgrad::engine::test {

/// Where a decal lies: orthonormal axes along its image and out of the surface.
struct DecalAxes {
  vec3<double> origin, s, t, outward;

  [[nodiscard]] std::array<double, 16> transform(vec3<double> scale = {1, 1, 1}) const {
    return {scale.x * s.x,
            scale.x * s.y,
            scale.x * s.z,
            0,
            scale.y * t.x,
            scale.y * t.y,
            scale.y * t.z,
            0,
            scale.z * outward.x,
            scale.z * outward.y,
            scale.z * outward.z,
            0,
            origin.x,
            origin.y,
            origin.z,
            1};
  }
};

inline DecalAxes random_axes(Random& random, vec3<double> origin) {
  const mat3<double> r = random.rotation();
  return {origin, r.x, random.sign() * r.y, r.z};
}

/// A surface that lies across a pixel a thousandth wide.
inline raster::Fragment<double> surface_at(vec3<double> position, vec3<double> normal) {
  raster::Fragment<double> f{};
  f.position = position;
  f.object_position = position;
  f.normal = normal;
  f.dp_dx = 1e-3 * normalize_or_zero(cross(normal, {0.31, 0.52, 0.8}));
  f.dp_dy = cross(normal, f.dp_dx);
  f.to_viewer = normal;
  f.front_facing = true;
  return f;
}

/// A tangent-space normal map of one slope, which is stored exactly.
inline image::Image slope_image(vec2<double> slope) {
  // Codes of a float file: 2 c - 1 is (-slope, 1).
  return surfgrad::test::constant_image(4, 4, {0.5 - 0.5 * slope.x, 0.5 - 0.5 * slope.y, 1});
}

} // namespace surfgrad::engine::test
