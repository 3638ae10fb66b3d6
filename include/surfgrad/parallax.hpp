#pragma once

/// Parallax mapping: from a view direction to texture space and back to the surface (section 2.6).

#include <surfgrad/frame.hpp>

namespace surfgrad {

/// Line segment in texture space that a ray covers while it crosses the height range: the search
/// vector of parallax mapping.
///
/// frame            dp_dx, dp_dy, normal of the base surface
/// dir              unit direction in the frame's space, e.g. towards the viewer
/// dst_dx, dst_dy   screen-space derivatives of the texture coordinate
/// bump_scale       displacement of height 1 along the normal, in units of the position
/// skip_projection  uniform: true leaves out the division by dot(normal, dir) (offset limiting)
/// returns          change of st while the height changes by 1 (by dot(normal, dir) when skipped)
/// degenerate       |dot(normal, dir)| and the pixel's area are clamped to eps times the magnitudes
///                  involved; the signed dot product is used, as printed. A result beyond the scalar's
///                  range saturates.
/// error            16 eps * (kappa + 1 / |dot(normal, dir)|) * the largest term, which is at most
///                  kappa * bump_scale * (|dst_dx| / |dp_dx| + |dst_dy| / |dp_dy|) / |dot(normal, dir)|,
///                  kappa = |dp_dx| |dp_dy| / |det|; without the dot products when skipped
/// source           Mikkelsen 2019, listing 10
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec2<T>
project_to_texture_space(const Frame<T>& frame, vec3<T> dir, vec2<T> dst_dx, vec2<T> dst_dy, T bump_scale,
                         bool skip_projection = false) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T inverse_x = reciprocal_or_zero(max_abs(frame.dp_dx));
  const T inverse_y = reciprocal_or_zero(max_abs(frame.dp_dy));
  const vec3<T> a = inverse_x * frame.dp_dx;
  const vec3<T> b = inverse_y * frame.dp_dy;
  const vec3<T> r1 = cross(b, frame.normal);
  const vec3<T> r2 = cross(frame.normal, a);
  const T det = dot(a, r1);
  const T s = select(det < zero, -one, one) / max(T(epsilon_v<T>), abs(det));
  // Pixels covered per unit of dir, then texture units.
  const vec2<T> on_screen =
      saturated(vec2<T>{s * (inverse_x * dot(r1, dir)), s * (inverse_y * dot(r2, dir))});
  const vec2<T> in_texture = saturated(on_screen.x * dst_dx) + saturated(on_screen.y * dst_dy);
  if (skip_projection) return saturated(bump_scale * in_texture);
  const T along = dot(frame.normal, dir);
  const T per_height =
      select(along < zero, -one, one) /
      max(max(T(epsilon_v<T>) * max_abs(dir), T(std::numeric_limits<value_t<T>>::min())), abs(along));
  return saturated((bump_scale * per_height) * in_texture);
}

/// A texture offset in pixels: the step (vx, vy) on the screen that changes st by texture_offset.
///
/// degenerate  collapsed coordinates: the determinant is clamped to eps times the derivatives'
///             magnitudes; zero derivatives give zero; a result beyond the scalar's range saturates
/// error       8 eps * kappa^2 * |texture_offset| / |dst_dx| in x, / |dst_dy| in y,
///             kappa = |dst_dx| |dst_dy| / |det|
/// source      Mikkelsen 2019, listing 11
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> screen_offset(vec2<T> dst_dx, vec2<T> dst_dy,
                                                                   vec2<T> texture_offset) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T inverse_x = reciprocal_or_zero(max_abs(dst_dx));
  const T inverse_y = reciprocal_or_zero(max_abs(dst_dy));
  const vec2<T> a = inverse_x * dst_dx;
  const vec2<T> b = inverse_y * dst_dy;
  const T det = cross(a, b);
  const T s = select(det < zero, -one, one) / max(T(epsilon_v<T>), abs(det));
  return saturated(
      vec2<T>{s * (inverse_x * cross(texture_offset, b)), s * (inverse_y * cross(a, texture_offset))});
}

/// A texture offset as a vector in the tangent plane; adding it and height * bump_scale * normal to
/// the position gives the displaced position.
///
/// degenerate  as screen_offset
/// error       10 eps * kappa^2 * |texture_offset| * (|sigma_x| / |dst_dx| + |sigma_y| / |dst_dy|)
/// source      Mikkelsen 2019, listing 11
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> surface_offset(const Frame<T>& frame, vec2<T> dst_dx,
                                                                    vec2<T> dst_dy, vec2<T> texture_offset) {
  const vec2<T> v = screen_offset(dst_dx, dst_dy, texture_offset);
  return saturated(v.x * frame.sigma_x) + saturated(v.y * frame.sigma_y);
}

/// The base normal at an offset position of a curved surface: normalize(n + vx dn_dx + vy dn_dy).
///
/// dn_dx, dn_dy  screen-space derivatives of the unit base normal
/// v             from screen_offset
/// degenerate    a vanishing sum gives zero
/// error         6 eps * (1 + |v.x dn_dx| + |v.y dn_dy|) / |the sum|, per component
/// source        Mikkelsen 2019, section 2.6
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> offset_normal(const Frame<T>& frame, vec3<T> dn_dx, vec3<T> dn_dy,
                                                         vec2<T> v) {
  return normalize_or_zero(frame.normal + v.x * dn_dx + v.y * dn_dy);
}

} // namespace surfgrad
