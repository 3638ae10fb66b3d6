#pragma once

/// The prologue: what every layer of one fragment shares, and tangent frames for texture coordinates.

#include <surfgrad/vec.hpp>

namespace surfgrad {

/// How a double-sided surface looks from behind (section 2.10).
enum class BackFaces {
  same,   ///< the perturbed normal of the front side (the paper's None)
  mirror, ///< the interpolated normal is negated, bumps stay bumps
  flip,   ///< the perturbed normal of the front side, negated: bumps become dents
};

/// Per-fragment state of one pass of bump mapping. All vectors are in one space of the caller's
/// choice, usually world space; positions may be relative to the camera.
template <class T>
struct Frame {
  vec3<T> normal;           ///< base normal: unit, or zero where nothing defines it
  vec3<T> dp_dx, dp_dy;     ///< screen-space derivatives of the surface position
  vec3<T> sigma_x, sigma_y; ///< dp_dx, dp_dy without their part along the normal
  T flip_sign;              ///< +1 or -1: orientation of (dp_dx, dp_dy) seen against the normal
  T resolve_sign;           ///< -1 on a back face in mode flip, else +1
};

/// Directions in which s and t grow. Scale matters: from_tbn uses the vectors as they are.
template <class T>
struct TangentFrame {
  vec3<T> tangent, bitangent;
};

namespace detail {

template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr Frame<T> frame_from_unit_normal(vec3<T> n, vec3<T> dp_dx,
                                                                             vec3<T> dp_dy, T resolve_sign) {
  const T one = T(value_t<T>(1));
  const T orientation = dot(dp_dy, cross(n, dp_dx));
  return {n,
          dp_dx,
          dp_dy,
          dp_dx - dot(dp_dx, n) * n,
          dp_dy - dot(dp_dy, n) * n,
          select(orientation < T(value_t<T>(0)), -one, one),
          resolve_sign};
}

/// normalize(normal), or the direction of plane_sign * cross(dp_dx, dp_dy) where the normal is zero.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> unit_normal_or_plane(vec3<T> normal, vec3<T> dp_dx, vec3<T> dp_dy,
                                                                T plane_sign) {
  const T tiny = T(std::numeric_limits<value_t<T>>::min());
  // One component at a time, so that NaN anywhere is not taken for absence.
  const mask_t<T> no_x = abs(normal.x) < tiny;
  const mask_t<T> no_y = abs(normal.y) < tiny;
  const mask_t<T> no_z = abs(normal.z) < tiny;
  const mask_t<T> absent = no_x & no_y & no_z;
  if (any(absent)) [[unlikely]] {
    // Normalise the factors first: their product would underflow for a microscopic footprint.
    const vec3<T> plane = plane_sign * cross(normalize_or_zero(dp_dx), normalize_or_zero(dp_dy));
    normal = select<T>(absent, plane, normal);
  }
  return normalize_or_zero(normal);
}

} // namespace detail

/// Prologue for a fragment whose back side needs no special care.
///
/// normal        interpolated vertex normal, of any length
/// dp_dx, dp_dy  change of the surface position over one pixel to the right and one pixel along +y
///               of the screen (any rate: no result depends on the pixel's size)
/// returns       frame with unit normal, resolve_sign +1
/// degenerate    zero normal: normalize(cross(dp_dx, dp_dy)), which faces the viewer in a
///               right-handed space where screen y runs up (negate dp_dy, then the normal, where it
///               runs down); zero if that vanishes too, which makes the resolved normal zero. Zero dp:
///               sigma is zero. NaN propagates.
/// error         normal 3 eps per component; sigma 10 eps * |dp|: 4 of its own, twice the normal's 3
/// source        Mikkelsen 2019, listing 16
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE Frame<T> make_frame(vec3<T> normal, vec3<T> dp_dx, vec3<T> dp_dy) {
  const T one = T(value_t<T>(1));
  return detail::frame_from_unit_normal(detail::unit_normal_or_plane(normal, dp_dx, dp_dy, one), dp_dx, dp_dy,
                                        one);
}

/// Prologue for double-sided materials.
///
/// front_facing  mask: the fragment shows its front side. For an object transform with negative
///               determinant invert it first (winding turns over, the surface does not).
/// back_faces    mirror and flip negate the interpolated normal of a back face; flip also sets
///               resolve_sign. Tangents and bitangents never change side.
/// returns       frame with unit normal
/// degenerate    as above, but the cross product that stands in for a zero normal takes the side of the
///               normal it replaces: seen from behind it faces away from the viewer in mode same, and,
///               negated like any other, towards the viewer in modes mirror and flip
/// error         as above: the signs are exact
/// source        Mikkelsen 2019, listing 16 and section 2.10
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE Frame<T> make_frame(vec3<T> normal, vec3<T> dp_dx, vec3<T> dp_dy,
                                                       mask_t<T> front_facing, BackFaces back_faces) {
  const T one = T(value_t<T>(1));
  const T back_sign = select(front_facing, one, -one);
  const T normal_sign = back_faces == BackFaces::same ? one : back_sign;
  const T resolve_sign = back_faces == BackFaces::flip ? back_sign : one;
  // The cross product faces the viewer, the normal of a surface seen from behind does not.
  const vec3<T> front_normal = detail::unit_normal_or_plane(normal, dp_dx, dp_dy, back_sign);
  return detail::frame_from_unit_normal(normal_sign * front_normal, dp_dx, dp_dy, resolve_sign);
}

/// Frame for layers that need no derivative of the position: volume, object-space normal and decal
/// layers.
///
/// normal      interpolated vertex normal, of any length
/// returns     frame with unit normal; dp and sigma are zero, flip_sign and resolve_sign +1
/// degenerate  zero normal: zero, which makes the resolved normal zero; NaN propagates
/// error       normal 3 eps per component
/// source      Mikkelsen 2019, listing 16, less what depends on the position
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE Frame<T> make_frame(vec3<T> normal) {
  const vec3<T> zero{T(value_t<T>(0)), T(value_t<T>(0)), T(value_t<T>(0))};
  return make_frame(normal, zero, zero);
}

/// Frame of the next pass: bump mapping on top of a resolved normal (section 2.11, post-resolve).
///
/// normal      the resolved normal: unit. It already carries the side, so it is never negated again.
/// returns     frame with sigma and flip_sign recomputed for the new normal; resolve_sign is kept
/// degenerate  zero normal: sigma is dp, flip_sign +1, and the resolved normal zero; NaN propagates
/// error       sigma 4 eps * |dp|
/// source      Mikkelsen 2019, listing 16 and section 2.11
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr Frame<T> rebase_frame(const Frame<T>& frame, vec3<T> normal) {
  return detail::frame_from_unit_normal(normal, frame.dp_dx, frame.dp_dy, frame.resolve_sign);
}

/// The same, where the position changed too (parallax, displacement): dp from screen_derivatives.
///
/// dp_dx, dp_dy  of the new position
/// normal, returns, degenerate, error, source  as above
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr Frame<T> rebase_frame(const Frame<T>& frame, vec3<T> normal,
                                                                   vec3<T> dp_dx, vec3<T> dp_dy) {
  return detail::frame_from_unit_normal(normal, dp_dx, dp_dy, frame.resolve_sign);
}

/// Vertex tangent space in the form that surface gradients need, still compliant with MikkTSpace.
///
/// normal      interpolated vertex normal, neither normalised nor negated: not frame.normal
/// tangent     interpolated vertex tangent, not normalised
/// sign        handedness: positive means bitangent = cross(normal, tangent), else its negative
/// returns     tangent and bitangent, both divided by length(normal): the resolve then equals
///             normalize(x * tangent + y * bitangent + z * normal) of the raw vectors
/// degenerate  zero normal: zero vectors, hence no bump
/// error       tangent 4 eps * |tangent| / |normal|, bitangent 8 eps * |tangent|
/// source      Mikkelsen 2019, listing 16 and section 2.2
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE TangentFrame<T> mikktspace_basis(vec3<T> normal, vec3<T> tangent, T sign) {
  const detail::Normalized<T> n = detail::normalized(normal);
  const T one = T(value_t<T>(1));
  return {n.inverse_length * tangent, select(T(value_t<T>(0)) < sign, one, -one) * cross(n.unit, tangent)};
}

/// Tangent frame of any texture coordinate, made in place: no vertex tangents needed.
///
/// dst_dx, dst_dy  screen-space derivatives of the texture coordinate
/// returns         orthonormal tangent (direction of +s in the tangent plane) and bitangent (on the
///                 side of +t), right for clockwise and counter-clockwise coordinates
/// degenerate      collapsed coordinates (both derivatives parallel to rounding, zero or NaN) and zero
///                 sigma: zero vectors, hence no bump
/// error           8 eps * (|sigma_x| |dt/dy| + |sigma_y| |dt/dx|) / |sigma_x dt/dy - sigma_y dt/dx| per
///                 component: the tangent is the direction of that difference
/// source          Mikkelsen 2019, listing 6 and section 2.3
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE TangentFrame<T> tangent_basis(const Frame<T>& frame, vec2<T> dst_dx,
                                                                 vec2<T> dst_dy) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T size_x = max_abs(dst_dx);
  const T size_y = max_abs(dst_dy);
  T det = cross(dst_dx, dst_dy);
  T area = size_x * size_y;
  const T squares = min(size_x, size_y) * min(size_x, size_y);
  const mask_t<T> usual = (T(detail::least_square<T>) < squares) &
                          (max(size_x, size_y) * max(size_x, size_y) < T(detail::most_square<T>));
  if (!all(usual)) {
    // Unit rates: the determinant of a microscopic footprint must not underflow. Both share one scale
    // below, or the direction would change.
    const vec2<T> a = reciprocal_or_zero(size_x) * dst_dx;
    const vec2<T> b = reciprocal_or_zero(size_y) * dst_dy;
    det = select(usual, det, cross(a, b));
    area = select(usual, area, one);
    const T inverse_rate = select(usual, one, reciprocal_or_zero(max(size_x, size_y)));
    dst_dx = inverse_rate * dst_dx;
    dst_dy = inverse_rate * dst_dy;
  }
  const mask_t<T> collapsed = !(T(epsilon_v<T>) * area < abs(det)); // so that NaN collapses too
  const T sign = select(det < zero, -one, one);
  // (dx/ds, dy/ds) up to the positive factor 1 / |det|, which normalisation removes.
  const T dx_ds = sign * dst_dy.y;
  const T dy_ds = -(sign * dst_dx.y);
  const vec3<T> tangent = normalize_or_zero(frame.sigma_x * dx_ds + frame.sigma_y * dy_ds);
  const vec3<T> bitangent = (sign * frame.flip_sign) * cross(frame.normal, tangent);
  const vec3<T> none{zero, zero, zero};
  return {select<T>(collapsed, none, tangent), select<T>(collapsed, none, bitangent)};
}

} // namespace surfgrad
