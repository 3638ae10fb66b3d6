#pragma once

#include <surfgrad/derivative.hpp>
#include <surfgrad/vec.hpp>

namespace surfgrad::bake {

/// A composed normal expressed in a vertex frame.
template <class T>
struct TangentNormal {
  vec3<T> normal;     ///< unit, z > 0
  mask_t<T> singular; ///< the frame cannot be inverted: normal is (0, 0, 1)
  mask_t<T> clamped;  ///< the direction lay at or below the tangent plane: slope clamped to 128
};

/// Solves x * tangent + y * bitangent + z * normal = direction for the raw interpolated frame, so that
/// the standard decode normalize(x T + y B + z N) returns the direction (bitangent = sign * cross(N, T)).
///
/// normal, tangent  interpolated, neither normalised nor perpendicular
/// singular         |N x T|^2 <= 1e-6 |N|^2 |T|^2, or a zero vector: within 0.06 degrees of parallel a
///                  16-bit map could no longer hold the answer
template <Scalar T>
[[nodiscard]] TangentNormal<T> in_vertex_frame(vec3<T> normal, vec3<T> tangent, T sign, vec3<T> direction) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const vec3<T> flat{zero, zero, one};
  const T s = select(zero < sign, one, -one);
  const vec3<T> bitangent = s * cross(normal, tangent);
  const T area2 = dot(bitangent, bitangent);
  const mask_t<T> regular = constant<T>(1e-6) * (dot(normal, normal) * dot(tangent, tangent)) < area2;
  // Cramer's rule; det[T B N] = sign * |N x T|^2, and only the direction of the result counts.
  const vec3<T> m{s * dot(cross(bitangent, normal), direction), s * dot(cross(normal, tangent), direction),
                  s * dot(cross(tangent, bitangent), direction)};
  const T widest = max_abs(vec2<T>{m.x, m.y});
  const T steepest = constant<T>(max_slope);
  const mask_t<T> below = (!(zero < m.z)) | (steepest * m.z < widest);
  const vec3<T> solved = normalize_or_zero(vec3<T>{m.x, m.y, select(below, widest / steepest, m.z)});
  const mask_t<T> directed = regular & (zero < max_abs(solved));
  return {select<T>(directed, solved, flat), !regular, mask_t<T>(regular & below)};
}

} // namespace surfgrad::bake
