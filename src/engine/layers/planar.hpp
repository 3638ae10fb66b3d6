#pragma once

#include "engine/bump_map.hpp"
#include "engine/layers/influence.hpp"

#include <surfgrad/triplanar.hpp>

namespace surfgrad::engine {

/// An image of bumps projected along an axis of object space or world space: a volume bump map that does
/// not change along the axis.
struct Planar {
  Influence influence{};
  BumpMap bumps{};
  PlaneAxis axis = PlaneAxis::x;
  bool world = false;
};

/// The planes of a single projection: an image appears the right way round to whom looks against the axis.
inline constexpr TriplanarConvention planar_convention{.handedness = Handedness::right};

/// What a point of space is on the planes of a projection: where they are read, and the footprint there.
template <class T>
struct PlaneFootprints {
  TriplanarCoordinates<T> st, dst_dx, dst_dy;
  TriplanarCoordinates<double> origin; ///< that st is relative to
};

/// Where a point of space lies on the planes.
[[nodiscard]] TriplanarCoordinates<double> origin_on_planes(vec3<double> origin,
                                                            TriplanarConvention convention);

template <Scalar T>
[[nodiscard]] PlaneFootprints<T> on_planes(const SpacePoint<T>& at, TriplanarConvention convention) {
  // The coordinates are linear in the position, so what they make of its parts and derivatives are theirs.
  return {triplanar_coordinates(at.position, convention), triplanar_coordinates(at.dp_dx, convention),
          triplanar_coordinates(at.dp_dy, convention), origin_on_planes(at.origin, convention)};
}

/// The coordinate of one of the planes.
template <class T>
[[nodiscard]] vec2<T> of_plane(const TriplanarCoordinates<T>& planes, PlaneAxis axis) {
  return axis == PlaneAxis::x ? planes.x_plane : axis == PlaneAxis::y ? planes.y_plane : planes.z_plane;
}

/// Where one of the planes is read.
template <class T>
[[nodiscard]] PlanePlace<T> place_on_plane(const PlaneFootprints<T>& planes, PlaneAxis axis) {
  const TriplanarCoordinates<double>& origin = planes.origin;
  return {of_plane(planes.st, axis), axis == PlaneAxis::x   ? origin.x_plane
                                     : axis == PlaneAxis::y ? origin.y_plane
                                                            : origin.z_plane};
}

/// Surface gradient of a planar projection at a point (section 2.8; Golubev, equations 44 and 50).
///
/// degenerate   (out) set where object space is wanted of an object whose transform has no inverse; the
///              gradient is zero there
template <LaneScalar T>
[[nodiscard]] vec3<T> surface_gradient(const Planar& layer, const Point<T>& point, mask_t<T>& degenerate) {
  degenerate = degenerate | lacks_space(point, layer.world);
  const PlaneFootprints<T> planes = on_planes(in_space(point, layer.world), planar_convention);
  const vec2<T> d = derivative(layer.bumps, place_on_plane(planes, layer.axis),
                               of_plane(planes.dst_dx, layer.axis), of_plane(planes.dst_dy, layer.axis));
  return from_gradient_in_space(point, layer.world, planar_gradient(layer.axis, d, planar_convention));
}

} // namespace surfgrad::engine
