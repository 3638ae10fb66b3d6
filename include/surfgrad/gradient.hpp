#pragma once

/// Surface gradients: every bump influence in the one form that scales, masks and adds linearly.
///
/// A surface gradient is the gradient of a height restricted to the tangent plane of the base
/// surface; resolve_normal turns a sum of them into a normal.

#include <surfgrad/frame.hpp>

namespace surfgrad {

/// Surface gradient from a derivative expressed in a tangent basis:
///   surfgrad = deriv.x * tangent + deriv.y * bitangent
///
/// deriv               (dh/ds, dh/dt): slopes, dimensionless
/// tangent, bitangent  directions of +s, +t: mikktspace_basis or tangent_basis. Neither unit nor
///                     orthogonal vectors are required.
/// returns             vector in span(tangent, bitangent)
/// degenerate          zero basis gives zero; NaN and Inf propagate
/// error, component i  eps * (|deriv.x * tangent[i]| + |deriv.y * bitangent[i]|), first order
/// source              Mikkelsen 2019, listing 5, equation 6
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> from_tbn(vec2<T> deriv, vec3<T> tangent,
                                                              vec3<T> bitangent) {
  return deriv.x * tangent + deriv.y * bitangent;
}

/// Surface gradient that leads from a base normal to a known perturbed one, such as an object-space
/// normal map gives.
///
/// normal      base normal, unit
/// v           perturbed direction in the same space, of any length
/// returns     g with normalize(normal - g) = normalize(v) where dot(normal, v) > 0. Where it is
///             negative the result perturbs towards v, mirrored at the tangent plane (listing 7, not
///             the opposite sign of Golubev's equation 38).
/// degenerate  v = 0 gives zero. |dot(normal, v)| is clamped to eps * |v|, so |g| <= 1 / eps. NaN
///             propagates.
/// error       4 eps * |v| / |dot(normal, v)| relative to max(1, |g|)
/// source      Mikkelsen 2019, listing 7; Golubev, equation 38
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> from_perturbed_normal(vec3<T> normal, vec3<T> v) {
  const vec3<T> u = normalize_or_zero(v); // makes the clamp relative to |v|
  const T along = dot(normal, u);
  const T s = T(value_t<T>(1)) / max(T(epsilon_v<T>), abs(along));
  return s * (along * normal - u);
}

/// Surface gradient from the derivatives of the height by any two parameters of the surface.
///
/// normal        base normal, unit
/// dp_du, dp_dv  derivatives of the position; need be neither orthogonal nor in the tangent plane
///               (their part along the normal has no effect)
/// dh_duv        derivatives of the height by the same parameters, in the units of the position
/// returns       (cross(dp_dv, n) * dh_du + cross(n, dp_du) * dh_dv) / det
/// degenerate    det = dot(dp_du, cross(dp_dv, n)), the area, is clamped to eps times the product of
///               the derivatives' magnitudes: bounded when they are parallel, zero when one is zero.
///               A result beyond the scalar's range saturates; NaN propagates. No result depends on the scale
///               of the scene.
/// error         8 eps * kappa * the largest term's length, kappa = |dp_du| |dp_dv| / |det|: rounding in
///               the cross products and in det is relative to the product of the lengths
/// source        Mikkelsen 2010, equation 3 (listing 8); Golubev, equations 6 and 31
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T>
from_parametric_derivative(vec3<T> normal, vec3<T> dp_du, vec3<T> dp_dv, vec2<T> dh_duv) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  // In units of each derivative's own magnitude everything below is of order one.
  const T inverse_u = reciprocal_or_zero(max_abs(dp_du));
  const T inverse_v = reciprocal_or_zero(max_abs(dp_dv));
  const vec3<T> a = inverse_u * dp_du;
  const vec3<T> b = inverse_v * dp_dv;
  const vec3<T> r1 = cross(b, normal);
  const vec3<T> r2 = cross(normal, a);
  const T det = dot(a, r1);
  const T s = select(det < zero, -one, one) / max(T(epsilon_v<T>), abs(det));
  return saturated(s * (dh_duv.x * inverse_u)) * r1 + saturated(s * (dh_duv.y * inverse_v)) * r2;
}

/// Surface gradient from the screen-space derivative of the height: scale-dependent bump mapping.
///
/// frame    dp_dx, dp_dy of the position *before* displacement (section 2.5)
/// dh_dxy   (dh/dx, dh/dy) per pixel, in the units of the position: derivative_from_heights
/// returns, degenerate, error  as from_parametric_derivative
/// source   Mikkelsen 2019, listing 8 with isDerivScreenSpace
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> from_height_derivative(const Frame<T>& frame,
                                                                            vec2<T> dh_dxy) {
  return from_parametric_derivative(frame.normal, frame.dp_dx, frame.dp_dy, dh_dxy);
}

/// Surface gradient from a height derivative per texel: scale-dependent bump mapping with a map.
///
/// dh_dtexel       height change from one texel to the next along s and t, in units of the position
/// size            width and height of the map in texels
/// dst_dx, dst_dy  screen-space derivatives of the normalised texture coordinate
/// returns, degenerate, error  as from_parametric_derivative, with dh_dxy's own terms by magnitude
/// source          Mikkelsen 2019, listing 8
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> from_texel_derivative(const Frame<T>& frame,
                                                                           vec2<T> dh_dtexel, vec2<T> size,
                                                                           vec2<T> dst_dx, vec2<T> dst_dy) {
  const vec2<T> dh_dst = size * dh_dtexel;
  return from_height_derivative(frame, vec2<T>{dot(dh_dst, dst_dx), dot(dh_dst, dst_dy)});
}

/// Surface gradient of a function of space: its gradient projected onto the tangent plane.
///
/// normal      base normal, unit
/// gradient    volume gradient (dh/dx, dh/dy, dh/dz) in the same space
/// returns     gradient - dot(normal, gradient) * normal
/// degenerate  a zero normal leaves the gradient as it is; NaN propagates
/// error       4 eps * |gradient|
/// source      Mikkelsen 2019, listing 12; Golubev, equation 30
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> from_volume_gradient(vec3<T> normal, vec3<T> gradient) {
  return gradient - dot(normal, gradient) * normal;
}

/// Bump scale applied to a surface gradient.
///
/// degenerate  none: zero gives zero; NaN and Inf propagate
/// error       half an ulp per component
/// source      Mikkelsen 2019, listing 2
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> scale_bump(T scale, vec3<T> surfgrad) {
  return scale * surfgrad;
}

} // namespace surfgrad
