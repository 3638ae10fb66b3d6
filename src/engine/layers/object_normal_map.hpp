#pragma once

#include "engine/layers/influence.hpp"

#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::engine {

/// A map of whole normals in object or world space.
struct ObjectNormalMap {
  Influence influence{};
  Texture texture{};
  bool world = false; ///< already in world space: the object's transform does not touch it
};

/// Surface gradient of an object- or world-space normal map at a point. Object-space normals follow the
/// object's scale.
///
/// degenerate  (out) set where the map holds no direction, or the transform leaves none of it; the
///             gradient is zero there
template <LaneScalar T>
[[nodiscard]] vec3<T> surface_gradient(const ObjectNormalMap& layer, const Point<T>& point,
                                       mask_t<T>& degenerate) {
  const std::array<T, 3> texel = sample<3>(layer.texture, point.fragment);
  vec3<T> v{texel[0], texel[1], texel[2]};
  if (!layer.world) v = transform_normal(in_lanes<T>(point.placement.linear), v);
  degenerate = degenerate | (max_abs(v) == T(value_t<T>(0)));
  return from_perturbed_normal(point.frame.normal, v);
}

} // namespace surfgrad::engine
