#pragma once

#include "engine/layers/planar.hpp"

#include <surfgrad/resolve.hpp>

#include <array>

namespace surfgrad::engine {

/// Images projected along the three axes of object space or world space, blended by the base normal of
/// the pass there.
struct Triplanar {
  Influence influence{};
  std::array<BumpMap, 3> planes{}; ///< x-, y- and z-plane
  bool whole_normals = false;      ///< texels are normals of the space, not bumps on the planes
  double sharpness = 3;
  bool world = false;
  TriplanarConvention convention{};
};

/// A value for each plane: what `sampled(axis, map)` gives where the plane has a weight, else `none`. A
/// plane without weight in any lane is not sampled.
template <class Value, LaneScalar T, class Sampled>
[[nodiscard]] std::array<Value, 3> of_weighted_planes(const Triplanar& layer, vec3<T> weights, Value none,
                                                      const Sampled& sampled) {
  const T zero = T(value_t<T>(0));
  const auto value = [&](PlaneAxis axis, T weight) {
    const mask_t<T> counts = zero < weight;
    if (!any(counts)) return none;
    return select<T>(counts, sampled(axis, layer.planes[static_cast<std::size_t>(axis)]), none);
  };
  return {value(PlaneAxis::x, weights.x), value(PlaneAxis::y, weights.y), value(PlaneAxis::z, weights.z)};
}

/// Surface gradient of maps of bumps (listing 13; Golubev, equation 49).
template <LaneScalar T>
[[nodiscard]] vec3<T> of_bumps(const Triplanar& layer, const Point<T>& point,
                               const PlaneFootprints<T>& planes, vec3<T> weights) {
  const T zero = T(value_t<T>(0));
  const vec2<T> none{zero, zero};
  const auto d = of_weighted_planes(layer, weights, none, [&](PlaneAxis axis, const BumpMap& bumps) {
    return derivative(bumps, place_on_plane(planes, axis), of_plane(planes.dst_dx, axis),
                      of_plane(planes.dst_dy, axis));
  });
  return from_gradient_in_space(point, layer.world,
                                triplanar_gradient(weights, d[0], d[1], d[2], layer.convention));
}

/// Surface gradient of maps of whole normals (Golubev, equation 45; an object's scale by equation 36).
///
/// degenerate  (out) set where a map that counts holds no direction; it adds nothing there
template <LaneScalar T>
[[nodiscard]] vec3<T> of_normals(const Triplanar& layer, const Point<T>& point,
                                 const PlaneFootprints<T>& planes, vec3<T> weights, mask_t<T>& degenerate) {
  const T zero = T(value_t<T>(0));
  const vec3<T> none{zero, zero, zero};
  const mask_t<T> lacking = lacks_space(point, layer.world);
  const auto v = of_weighted_planes(layer, weights, none, [&](PlaneAxis axis, const BumpMap& bumps) {
    const std::array<T, 3> texel = sample<3>(bumps.tiled, place_on_plane(planes, axis),
                                             of_plane(planes.dst_dx, axis), of_plane(planes.dst_dy, axis));
    return vec3<T>{texel[0], texel[1], texel[2]};
  });
  const auto weighted = [&](T weight, vec3<T> direction) {
    if (!layer.world) direction = transform_normal(in_lanes<T>(point.placement.linear), direction);
    direction = select<T>(lacking, none, direction);
    degenerate = degenerate | ((zero < weight) & (max_abs(direction) == zero));
    return weight * from_perturbed_normal(point.frame.normal, direction);
  };
  return weighted(weights.x, v[0]) + weighted(weights.y, v[1]) + weighted(weights.z, v[2]);
}

/// Surface gradient of a triplanar projection at a point.
///
/// degenerate   (out) set where object space is wanted of an object whose transform has no inverse, and
///              where a map of whole normals holds no direction; the gradient is zero there
template <LaneScalar T>
[[nodiscard]] vec3<T> surface_gradient(const Triplanar& layer, const Point<T>& point, mask_t<T>& degenerate) {
  degenerate = degenerate | lacks_space(point, layer.world);
  const PlaneFootprints<T> planes = on_planes(in_space(point, layer.world), layer.convention);
  const vec3<T> weights =
      triplanar_weights(normal_in_space(point, layer.world), static_cast<value_t<T>>(layer.sharpness));
  return layer.whole_normals ? of_normals(layer, point, planes, weights, degenerate)
                             : of_bumps(layer, point, planes, weights);
}

} // namespace surfgrad::engine
