#pragma once

#include "engine/placement.hpp"
#include "raster/fragment.hpp"

#include <surfgrad/frame.hpp>
#include <surfgrad/gradient.hpp>

namespace surfgrad::engine {

/// A fragment on its way through the layers: what kernels read, and what a layer may change for those
/// after it.
template <class T>
struct Point {
  raster::Fragment<T>& fragment; ///< the caller's, too large to be moved; parallax changes it
  Frame<T> frame;                ///< of the current pass
  bool first_pass = true;        ///< uniform: no resolve came before
  T sunlight = T(value_t<T>(1)); ///< share of the sun that reaches it, in [0, 1]
  const Placement& placement;

  Point(raster::Fragment<T>& f, const Frame<T>& of_the_pass, const Placement& where)
      : fragment(f), frame(of_the_pass), placement(where) {}

  /// In its first pass.
  ///
  /// back_faces  how a fragment that shows its back is treated
  Point(raster::Fragment<T>& f, BackFaces back_faces, const Placement& where)
      : fragment(f), frame(make_frame(f.normal, f.dp_dx, f.dp_dy, f.front_facing, back_faces)),
        placement(where) {}
};

/// Matrices and vectors of a placement, in every lane.
template <Scalar T>
[[nodiscard]] vec3<T> in_lanes(vec3<double> v) {
  return {constant<T>(v.x), constant<T>(v.y), constant<T>(v.z)};
}
template <Scalar T>
[[nodiscard]] mat3<T> in_lanes(const mat3<double>& m) {
  return {in_lanes<T>(m.x), in_lanes<T>(m.y), in_lanes<T>(m.z)};
}
template <Scalar T>
[[nodiscard]] mat4<T> in_lanes(const mat4<double>& m) {
  const auto row = [](vec4<double> r) {
    return vec4<T>{constant<T>(r.x), constant<T>(r.y), constant<T>(r.z), constant<T>(r.w)};
  };
  return {row(m.x), row(m.y), row(m.z), row(m.w)};
}

/// Position and pixel footprint in the space in which a function of space is sampled.
template <class T>
struct SpacePoint {
  vec3<T> position; ///< relative to the origin
  vec3<T> dp_dx, dp_dy;
  vec3<double> origin{0, 0, 0}; ///< uniform: may lie far from where the space begins, not from the surface
};

/// The point in object space, or in world space relative to the object's origin. The surface's own
/// positions, not displaced ones: detail stays where it was on the surface.
template <Scalar T>
[[nodiscard]] SpacePoint<T> in_space(const Point<T>& point, bool world) {
  const raster::Fragment<T>& f = point.fragment;
  if (!world) {
    const mat3<T> inverse = in_lanes<T>(point.placement.inverse_linear);
    return {f.object_position, inverse * f.dp_dx, inverse * f.dp_dy};
  }
  const mat4<double>& m = point.placement.world_from_object;
  return {in_lanes<T>(point.placement.linear) * f.object_position, f.dp_dx, f.dp_dy, {m.x.w, m.y.w, m.z.w}};
}

/// Whether a position in object space is wanted of an object whose transform has no inverse: footprints
/// and gradients are zero there.
template <Scalar T>
[[nodiscard]] mask_t<T> lacks_space(const Point<T>& point, bool world) {
  const mat3<double>& m = point.placement.inverse_linear;
  const T singular = T(static_cast<value_t<T>>(max_abs(m.x) == 0 && max_abs(m.y) == 0 && max_abs(m.z) == 0));
  return world ? mask_t<T>(singular < singular) : mask_t<T>(T(value_t<T>(0)) < singular);
}

/// The base normal of the pass in object space or world space: unit, or zero where there is none.
template <Scalar T>
[[nodiscard]] vec3<T> normal_in_space(const Point<T>& point, bool world) {
  if (world) return point.frame.normal;
  // The transpose takes normals back: it is the inverse of the inverse transpose.
  return normalize_or_zero(transpose(in_lanes<T>(point.placement.linear)) * point.frame.normal);
}

/// A volume gradient in object space or world space brought to world space, in units of a height along the
/// base normal.
template <Scalar T>
[[nodiscard]] vec3<T> gradient_in_world(const Point<T>& point, bool world, vec3<T> gradient) {
  if (world) return gradient;
  // Gradients move by the inverse transpose; a height of 1 along N = M^T n / |M^T n| is one of
  // dot(n, M N) = |M^T n| along n.
  const T stretch = length(transpose(in_lanes<T>(point.placement.linear)) * point.frame.normal);
  return saturated(stretch * (transpose(in_lanes<T>(point.placement.inverse_linear)) * gradient));
}

/// What a volume gradient G in object space or world space adds to the sum of a pass. A surface bumped in
/// object space is displaced there, then transformed: N - G becomes M^-T (N - G) as a whole (Golubev,
/// equation 33), which in units of n is n - (M^-T G - dot(N, G) n). That is linear in G, so layers add,
/// mix and cancel under every transform. Where the transform is uneven it leans off the tangent plane.
///
/// degenerate  a transform without inverse gives zero for tangential gradients in object space; a result
///             beyond the scalar's range saturates
template <Scalar T>
[[nodiscard]] vec3<T> from_gradient_in_space(const Point<T>& point, bool world, vec3<T> gradient) {
  const vec3<T> n = point.frame.normal;
  if (world) return from_volume_gradient(n, gradient);
  const T along = dot(normal_in_space(point, world), gradient);
  return saturated(gradient_in_world(point, world, gradient) - along * n);
}

} // namespace surfgrad::engine
