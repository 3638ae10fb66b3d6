#pragma once

/// From surface gradients back to normals, and normals through object transforms.

#include <surfgrad/frame.hpp>

namespace surfgrad {

/// The perturbed normal: normalize(normal - resolve_sign * surfgrad).
///
/// frame       the pass's frame; surfgrad is the weighted sum of all its surface gradients
/// returns     unit normal, in the frame's space. On a back face in mode flip it is the negative of
///             the front side's.
/// degenerate  a zero base normal gives zero, whatever the gradient; NaN propagates
/// error       4 eps per component
/// source      Mikkelsen 2019, listing 1, equation 1
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> resolve_normal(const Frame<T>& frame, vec3<T> surfgrad) {
  const T zero = T(value_t<T>(0));
  const mask_t<T> absent = (frame.normal.x == zero) & (frame.normal.y == zero) & (frame.normal.z == zero);
  vec3<T> resolved = normalize_or_zero(frame.normal - frame.resolve_sign * surfgrad);
  if (any(absent)) [[unlikely]]
    resolved = select<T>(absent, vec3<T>{zero, zero, zero}, resolved);
  return resolved;
}

/// Turns the result of mode mirror into that of mode flip, after the last resolve: reflect(-n', n).
///
/// resolved        perturbed normal
/// initial_normal  unit base normal (negated on back faces) as it was before the first resolve
/// degenerate      a zero initial normal gives -resolved; NaN propagates
/// error           6 eps per component
/// source          Mikkelsen 2019, section 2.10. Equal to BackFaces::flip for one pass; across a
///                 post-resolve volume layer it is not, so prefer the mode.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> flip_from_mirror(vec3<T> resolved,
                                                                      vec3<T> initial_normal) {
  const T two = T(value_t<T>(2));
  return (two * dot(resolved, initial_normal)) * initial_normal - resolved;
}

/// A normal through an object transform: sign(det M) * cof(M) * v.
///
/// M        linear part of the transform; may scale non-uniformly or mirror
/// v        a normal, or N - surfgrad as a whole. A surface gradient alone does not transform this
///          way: it would leave the tangent plane.
/// returns  not unit. Points outward for mirrored objects too, where cof(M) alone points inward.
/// degenerate  a singular M gives cof(M) * v, which may be zero. Elements of M beyond 1e12 or below
///             1e-12 may leave the range of float: the result has the square of their size.
/// error    8 eps * |M|^2 * |v|
/// source   Golubev, equations 25, 33, 36
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> transform_normal(const mat3<T>& M, vec3<T> v) {
  const T one = T(value_t<T>(1));
  return select(determinant(M) < T(value_t<T>(0)), -one, one) * (cofactor(M) * v);
}

/// Matrix that takes implicit gradients (-dh/du, -dh/dv, 1) = N_t / n_t.z to world space, with the
/// object's scale and rotation folded in: constant over a surface point, so it can be precomputed.
///
/// rotation      world from scaled object, a proper rotation
/// scale         the object's scale matrix, applied before the rotation; may mirror
/// dp_du, dp_dv  object-space derivatives of the position by the texture coordinate
/// normal        object-space unit normal
/// returns       rotation * sign(det scale) * cof(scale) * inverse_transpose([dp_du dp_dv normal]);
///               times M_tile * N_t and normalised it is the world-space perturbed normal
/// degenerate    parallel dp_du, dp_dv: the first two columns are zero (no bump), the third carries
///               the transformed normal. Elements beyond the scalar's range saturate.
/// error         16 eps * |scale|^2 in the third column; in the first two kappa^2 / |dp_du| and
///               kappa^2 / |dp_dv| times that, kappa = |dp_du| |dp_dv| / |det|
/// source        Golubev, equations 6, 28, 29
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr mat3<T>
tangent_normal_matrix(const mat3<T>& rotation, const mat3<T>& scale, vec3<T> dp_du, vec3<T> dp_dv,
                      vec3<T> normal) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T inverse_u = reciprocal_or_zero(max_abs(dp_du));
  const T inverse_v = reciprocal_or_zero(max_abs(dp_dv));
  const vec3<T> a = inverse_u * dp_du;
  const vec3<T> b = inverse_v * dp_dv;
  const T det = dot(cross(a, b), normal);
  const mask_t<T> collapsed = abs(det) < T(epsilon_v<T>);
  const T s = select(collapsed, zero, one / select(collapsed, one, det));
  // Columns: what +du, +dv of the height and the base normal contribute (Golubev, equation 6).
  const vec3<T> column_u = saturated(s * inverse_u) * cross(b, normal);
  const vec3<T> column_v = saturated(s * inverse_v) * cross(normal, a);
  const mat3<T> inverse_transpose{{column_u.x, column_v.x, normal.x},
                                  {column_u.y, column_v.y, normal.y},
                                  {column_u.z, column_v.z, normal.z}};
  // The scale in units of its own magnitude, too: its cofactors are products of two.
  const T size = max(max(max_abs(scale.x), max_abs(scale.y)), max_abs(scale.z));
  const T inverse_size = reciprocal_or_zero(size);
  const mat3<T> unit{inverse_size * scale.x, inverse_size * scale.y, inverse_size * scale.z};
  const T side = select(determinant(unit) < zero, -one, one);
  const mat3<T> c = cofactor(unit);
  const mat3<T> m = rotation * (mat3<T>{side * c.x, side * c.y, side * c.z} * inverse_transpose);
  const T area = saturated(size * size);
  return {saturated(area * m.x), saturated(area * m.y), saturated(area * m.z)};
}

/// The same for a scale along the object's axes.
///
/// scale  factors along x, y and z; negative ones mirror
/// other parameters, returns, degenerate, error, source  as above, |scale| being the vector's length
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr mat3<T>
tangent_normal_matrix(const mat3<T>& rotation, vec3<T> scale, vec3<T> dp_du, vec3<T> dp_dv, vec3<T> normal) {
  const T zero = T(value_t<T>(0));
  return tangent_normal_matrix(rotation,
                               mat3<T>{{scale.x, zero, zero}, {zero, scale.y, zero}, {zero, zero, scale.z}},
                               dp_du, dp_dv, normal);
}

} // namespace surfgrad
