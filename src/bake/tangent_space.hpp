#pragma once

#include <surfgrad/derivative.hpp>
#include <surfgrad/vec.hpp>

namespace surfgrad::bake {

/// A composed normal expressed in a vertex frame.
struct TangentNormal {
  vec3<double> normal{0, 0, 1}; ///< unit, z > 0
  bool singular = false;        ///< the frame cannot be inverted: normal is (0, 0, 1)
  bool clamped = false;         ///< the direction lay at or below the tangent plane: slope clamped to 128
};

/// Solves x * tangent + y * bitangent + z * normal = direction for the raw interpolated frame, so that
/// the standard decode normalize(x T + y B + z N) returns the direction (bitangent = sign * cross(N, T)).
///
/// normal, tangent  interpolated, neither normalised nor perpendicular
/// singular         |N x T|^2 <= 1e-6 |N|^2 |T|^2, or a zero vector: within 0.06 degrees of parallel a
///                  16-bit map could no longer hold the answer
[[nodiscard]] inline TangentNormal in_vertex_frame(vec3<double> normal, vec3<double> tangent, double sign,
                                                   vec3<double> direction) {
  const vec3<double> bitangent = (sign > 0 ? 1.0 : -1.0) * cross(normal, tangent);
  const double area2 = dot(bitangent, bitangent);
  TangentNormal result;
  if (!(area2 > 1e-6 * dot(normal, normal) * dot(tangent, tangent))) {
    result.singular = true;
    return result;
  }
  // Cramer's rule; det[T B N] = sign * |N x T|^2, and only the direction of the result counts.
  const double s = sign > 0 ? 1.0 : -1.0;
  const vec3<double> m{s * dot(cross(bitangent, normal), direction),
                       s * dot(cross(normal, tangent), direction),
                       s * dot(cross(tangent, bitangent), direction)};
  const double widest = max_abs(vec2<double>{m.x, m.y});
  if (m.z > 0 && widest <= max_slope * m.z) {
    result.normal = normalize_or_zero(m);
    return result;
  }
  result.clamped = true;
  result.normal =
      widest > 0 ? normalize_or_zero(vec3<double>{m.x, m.y, widest / max_slope}) : vec3<double>{0, 0, 1};
  return result;
}

} // namespace surfgrad::bake
