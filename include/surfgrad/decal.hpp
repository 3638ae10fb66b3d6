#pragma once

/// Decal projectors as volume bump maps (section 2.9).
///
/// A shape answers, for a point in space, where its image lies there and how strongly it acts. Volume
/// gradients of many decals may be summed before the normal is known and projected once with
/// from_volume_gradient; falloff * opacity scales the gradient as a bump scale (it is not
/// differentiated).
///
/// What a derivative means decides which vectors carry it:
///   slopes (normal maps; scale-free)   decal_gradient(deriv, axis_s, axis_t)
///   dh/ds, dh/dt (height in the units of the position for st over the image)
///                                      decal_gradient(dh_dst, grad_s, grad_t)
///   mip footprint, in either case      projected_derivatives(grad_s, grad_t, dp_dx, dp_dy)

#include <surfgrad/gradient.hpp>

namespace surfgrad {

/// Volume gradient of a projected image: no normal needed.
///
/// deriv           derivative along the image's s and t
/// axis_x, axis_y  axes of the projector for slopes, gradients of s and t for heights per image
/// returns         deriv.x * axis_x + deriv.y * axis_y
/// degenerate      zero axes, as outside a shape, give zero; NaN and Inf propagate
/// error, component i  eps * (|deriv.x * axis_x[i]| + |deriv.y * axis_y[i]|), first order
/// source          Mikkelsen 2019, listing 15
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> decal_gradient(vec2<T> deriv, vec3<T> axis_x,
                                                                    vec3<T> axis_y) {
  return deriv.x * axis_x + deriv.y * axis_y;
}

/// Surface gradient of a projected image.
///
/// normal      unit base normal, in the space of the axes
/// returns     from_volume_gradient(normal, decal_gradient(deriv, axis_x, axis_y))
/// degenerate  as these two: zero axes give zero, a zero normal leaves the volume gradient
/// error       5 eps * (|deriv.x| |axis_x| + |deriv.y| |axis_y|): 1 of the sum, 4 of the projection
/// source      Mikkelsen 2019, listing 15
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> from_decal(vec3<T> normal, vec2<T> deriv, vec3<T> axis_x,
                                                                vec3<T> axis_y) {
  return from_volume_gradient(normal, decal_gradient(deriv, axis_x, axis_y));
}

/// Placement of a decal in the space of the positions: its origin and orthonormal axes, either
/// handedness. Sizes belong to the shapes.
template <class T>
struct DecalFrame {
  vec3<T> origin;
  vec3<T> axis_x, axis_y, axis_z;
};

/// An image projected by a box, cone or wedge, at one point. All zero outside the shape.
template <class T>
struct DecalProjection {
  vec2<T> texture_coordinate; ///< [0, 1]^2 over the image
  vec3<T> grad_s, grad_t;     ///< exact gradients of the texture coordinate in space
  vec3<T> axis_s, axis_t;     ///< what a unit slope along s and t adds to the volume gradient
  T falloff;                  ///< 1 in the core, falling smoothly to 0 at the shape's surface
  mask_t<T> inside;
};

/// A direction projected by a sphere or capsule, for a cube map of normals, at one point. All zero
/// outside the shape.
template <class T>
struct DecalDirection {
  vec3<T> direction;  ///< unit, in the space of the positions; zero at the centre
  vec3<T> lookup;     ///< the same in the decal's frame: for the cube map
  vec3<T> unchanging; ///< unit vector along which the direction does not change; zero where none
  T falloff;
  mask_t<T> inside;
};

/// What a slope in the image of a cone or wedge adds to the volume gradient.
enum class ConeGradient {
  exact,      ///< the gradient of (x/z, y/z), perspective term included
  scale_free, ///< the unit axes: the perspective term left out, as for a box
};

namespace detail {

/// Falloff at the fraction e of the way from the core to the surface: 1 up to 1 - fade, 0 at 1, a
/// smoothstep between.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T edge_falloff(T e, T fade) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T t = min(max((e - (one - fade)) * reciprocal_or_zero(fade), zero), one);
  return one - t * t * (constant<T>(3) - constant<T>(2) * t);
}

template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> to_decal(const DecalFrame<T>& frame, vec3<T> p) {
  const vec3<T> d = p - frame.origin;
  return {dot(d, frame.axis_x), dot(d, frame.axis_y), dot(d, frame.axis_z)};
}

template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> from_decal_frame(const DecalFrame<T>& frame, vec3<T> v) {
  return v.x * frame.axis_x + v.y * frame.axis_y + v.z * frame.axis_z;
}

/// x clamped to the segment, and 1 where x moves along it, 0 beyond its ends.
template <class T>
struct OnSegment {
  T nearest, moves;
};

template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr OnSegment<T> clamp_to_segment(T x, T half_length) {
  const T one = T(value_t<T>(1));
  return {max(-half_length, min(x, half_length)), select(abs(x) < half_length, one, T(value_t<T>(0)))};
}

/// Cone at the frame's origin for the point q in the decal's frame; dx_dx is the derivative of q.x by
/// the position along axis_x (0 where a wedge's apex follows the point).
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE DecalProjection<T> cone_projection(const DecalFrame<T>& frame, vec3<T> q,
                                                                      T dx_dx, T tan_half_angle, T range,
                                                                      T fade, ConeGradient gradient) {
  const T zero = T(value_t<T>(0));
  const T half = constant<T>(0.5);
  const vec3<T> nowhere{zero, zero, zero};
  const T radius = tan_half_angle * q.z;
  const T across = length(vec2<T>{q.x, q.y});
  const T least = T(std::numeric_limits<value_t<T>>::min());
  const mask_t<T> inside = (least < radius) & (least < q.z) & (q.z < range) & (across < radius);
  // d(x/z) = (dx - (x/z) dz) / z
  const T x_by_z = q.x * reciprocal_or_zero(q.z);
  const T y_by_z = q.y * reciprocal_or_zero(q.z);
  const vec3<T> along_s = dx_dx * frame.axis_x - x_by_z * frame.axis_z;
  const vec3<T> along_t = frame.axis_y - y_by_z * frame.axis_z;
  // The image is 2 * radius wide at this depth.
  const T per_unit = half * reciprocal_or_zero(radius);
  const bool exact = gradient == ConeGradient::exact;
  const vec2<T> st{half + per_unit * q.x, half + per_unit * q.y};
  const T falloff = edge_falloff(across * reciprocal_or_zero(radius), fade) *
                    edge_falloff(q.z * reciprocal_or_zero(range), fade);
  return {select<T>(inside, st, vec2<T>{zero, zero}),
          select<T>(inside, per_unit * along_s, nowhere),
          select<T>(inside, per_unit * along_t, nowhere),
          select<T>(inside, exact ? along_s : dx_dx * frame.axis_x, nowhere),
          select<T>(inside, exact ? along_t : frame.axis_y, nowhere),
          select(inside, falloff, zero),
          inside};
}

/// Sphere at the frame's origin for the point q in the decal's frame.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE DecalDirection<T> sphere_direction(const DecalFrame<T>& frame, vec3<T> q,
                                                                      vec3<T> unchanging, T radius, T fade) {
  const T zero = T(value_t<T>(0));
  const vec3<T> nowhere{zero, zero, zero};
  const T distance = length(q);
  const mask_t<T> inside = distance < radius;
  const vec3<T> lookup = select<T>(inside, normalize_or_zero(q), nowhere);
  return {from_decal_frame(frame, lookup), lookup, select<T>(inside, unchanging, nowhere),
          select(inside, edge_falloff(distance * reciprocal_or_zero(radius), fade), zero), inside};
}

} // namespace detail

/// Box: parallel projection along axis_z.
///
/// p          point, in the space of the frame
/// half_size  half the edges along the axes, positive; the image covers the xy face
/// fade       fraction of the half edges over which the influence fades, in [0, 1]; 0 is a hard edge
/// returns    st = 1/2 + (x, y) / (2 * half_size.xy); axis_s, axis_t are the frame's; falloff the
///            product over the three axes
/// degenerate  a size that is not positive, or NaN in p: outside
/// error      st 4 eps * |p - origin| / half_size; grad 1 eps relative
/// source     Mikkelsen 2019, section 2.9
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr DecalProjection<T>
box_decal(const DecalFrame<T>& frame, vec3<T> p, vec3<T> half_size, T fade) {
  const T zero = T(value_t<T>(0));
  const T half = constant<T>(0.5);
  const vec3<T> nowhere{zero, zero, zero};
  const vec3<T> q = detail::to_decal(frame, p);
  const mask_t<T> inside_x = abs(q.x) < half_size.x;
  const mask_t<T> inside_y = abs(q.y) < half_size.y;
  const mask_t<T> inside_z = abs(q.z) < half_size.z;
  const mask_t<T> inside = inside_x & inside_y & inside_z;
  const vec3<T> per_half{reciprocal_or_zero(half_size.x), reciprocal_or_zero(half_size.y),
                         reciprocal_or_zero(half_size.z)};
  const T falloff = detail::edge_falloff(abs(q.x) * per_half.x, fade) *
                    detail::edge_falloff(abs(q.y) * per_half.y, fade) *
                    detail::edge_falloff(abs(q.z) * per_half.z, fade);
  return {select<T>(inside, vec2<T>{half + half * per_half.x * q.x, half + half * per_half.y * q.y},
                    vec2<T>{zero, zero}),
          select<T>(inside, (half * per_half.x) * frame.axis_x, nowhere),
          select<T>(inside, (half * per_half.y) * frame.axis_y, nowhere),
          select<T>(inside, frame.axis_x, nowhere),
          select<T>(inside, frame.axis_y, nowhere),
          select(inside, falloff, zero),
          inside};
}

/// Cone: perspective projection from the apex at the frame's origin along +axis_z.
///
/// tan_half_angle  radius of the cone at distance 1, positive; the image encloses the circle
/// range           length along axis_z, positive
/// fade            fraction of the radius, and of the range at its far end, over which the influence
///                 fades, in [0, 1]
/// gradient        uniform: which axis_s, axis_t to give. exact: axis_x - (x/z) axis_z and
///                 axis_y - (y/z) axis_z, so slopes count in lengths on the image plane through the
///                 point. grad_s and grad_t are exact in both cases.
/// returns         st = 1/2 + (x, y) / (2 * z * tan_half_angle)
/// degenerate      the apex and behind it, sizes that are not positive, NaN in p: outside
/// error           st 8 eps * |p - origin| / (z * tan_half_angle); grad the same relative to its size
/// source          Mikkelsen 2019, section 2.9, with the gradient of (x/z, y/z)
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE DecalProjection<T>
cone_decal(const DecalFrame<T>& frame, vec3<T> p, T tan_half_angle, T range, T fade,
           ConeGradient gradient = ConeGradient::exact) {
  return detail::cone_projection(frame, detail::to_decal(frame, p), T(value_t<T>(1)), tan_half_angle, range,
                                 fade, gradient);
}

/// Wedge: a cone whose apex slides along a segment of axis_x, centred on the origin, to stay beside the
/// point. Between the segment's ends it is a prism with s = 1/2, the image's middle column drawn out;
/// beyond them, the two halves of a cone.
///
/// half_length  half the segment's length, not negative; 0 is the cone
/// other parameters, degenerate, error  as cone_decal
/// returns      as cone_decal for x less its part along the segment. Between the ends grad_s and
///              axis_s are zero: s does not change. They jump at the two planes where the segment ends
///              (st itself does not).
/// source       own: cone_decal from the nearest point of a segment
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE DecalProjection<T>
wedge_decal(const DecalFrame<T>& frame, vec3<T> p, T half_length, T tan_half_angle, T range, T fade,
            ConeGradient gradient = ConeGradient::exact) {
  const vec3<T> q = detail::to_decal(frame, p);
  const detail::OnSegment<T> apex = detail::clamp_to_segment(q.x, half_length);
  return detail::cone_projection(frame, vec3<T>{q.x - apex.nearest, q.y, q.z}, T(value_t<T>(1)) - apex.moves,
                                 tan_half_angle, range, fade, gradient);
}

/// Sphere: a cube map of normals seen from its centre.
///
/// radius      positive
/// fade        fraction of the radius over which the influence fades, in [0, 1]
/// returns     direction from the centre: sample the cube map at lookup, bring the normal into the
///             space of the positions, then decal_gradient_from_normal
/// degenerate  the centre has no direction: zero, hence no bump; a radius that is not positive, NaN in
///             p: outside
/// error       3 eps per component, beyond the rounding of p - origin
/// source      Mikkelsen 2019, sections 2.4 and 2.9
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE DecalDirection<T> sphere_decal(const DecalFrame<T>& frame, vec3<T> p,
                                                                  T radius, T fade) {
  const T zero = T(value_t<T>(0));
  return detail::sphere_direction(frame, detail::to_decal(frame, p), vec3<T>{zero, zero, zero}, radius, fade);
}

/// Capsule: a sphere whose centre slides along a segment of axis_x, centred on the origin, to stay
/// beside the point. Between the segment's ends it is a cylinder that draws out the cube map's ring
/// perpendicular to axis_x; beyond them, the two halves of a sphere.
///
/// half_length  half the segment's length, not negative; 0 is the sphere
/// other parameters, degenerate, error  as sphere_decal; the axis itself has no direction
/// returns      as sphere_decal from the nearest point of the segment; unchanging is axis_x between the
///              ends
/// source       own: sphere_decal from the nearest point of a segment
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE DecalDirection<T> capsule_decal(const DecalFrame<T>& frame, vec3<T> p,
                                                                   T half_length, T radius, T fade) {
  const vec3<T> q = detail::to_decal(frame, p);
  const detail::OnSegment<T> centre = detail::clamp_to_segment(q.x, half_length);
  return detail::sphere_direction(frame, vec3<T>{q.x - centre.nearest, q.y, q.z}, centre.moves * frame.axis_x,
                                  radius, fade);
}

/// Volume gradient of a sphere or capsule with a map of normals.
///
/// decal       from sphere_decal or capsule_decal
/// v           perturbed normal sampled at decal.lookup, in the space of the positions, of any length
/// returns     the surface gradient of the sphere, which is the volume gradient because heights do not
///             change along a ray; scale-free. In a capsule's cylinder without its part along the axis,
///             along which heights do not change either.
/// degenerate  no direction: zero. Else as from_perturbed_normal.
/// error       11 eps * |v| / |dot(decal.direction, v)| relative to max(1, |g|): 4 a component of
///             from_perturbed_normal, whose length the projection may turn into one component, and 4 of
///             the projection
/// source      Mikkelsen 2019, listing 7 and section 2.9
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> decal_gradient_from_normal(const DecalDirection<T>& decal,
                                                                      vec3<T> v) {
  const T zero = T(value_t<T>(0));
  const mask_t<T> no_direction = max_abs(decal.direction) == zero;
  const vec3<T> g = from_perturbed_normal(decal.direction, v);
  return select<T>(no_direction, vec3<T>{zero, zero, zero}, g - dot(g, decal.unchanging) * decal.unchanging);
}

} // namespace surfgrad
