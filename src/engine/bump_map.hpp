#pragma once

#include "engine/texture.hpp"

namespace surfgrad::engine {

/// A projected image of bumps, whatever its file held: its texels are slopes, or derivatives of heights.
struct BumpMap {
  TiledMap tiled{};
  bool heights = false; ///< texels are derivatives of heights by the map, else slopes
  double height = 1;    ///< displacement of a height of 1, in units of the coordinates' space
};

/// Derivative along the coordinates st of a bump map: slopes, dimensionless and independent of the
/// tiling, or for heights (dh/ds, dh/dt) in units of the height, which the tiling multiplies.
/// Heights are no steeper than 1e12 along either, so that no transform makes them infinite.
template <LaneScalar T>
[[nodiscard]] vec2<T> derivative(const BumpMap& bumps, const std::type_identity_t<PlanePlace<T>>& st,
                                 const vec2<T>& footprint_dx, const vec2<T>& footprint_dy) {
  if (!bumps.heights)
    return along_coordinate(bumps.tiled, sample_slopes(bumps.tiled, st, footprint_dx, footprint_dy));
  const vec2<T> dh = sample_height_slopes(bumps.tiled, st, footprint_dx, footprint_dy);
  const vec2<T> steep = constant<T>(bumps.height) * saturated(by_coordinate(bumps.tiled, dh));
  // Vertical to rounding; multiplied by a scale of 1e12 and an inverse one it stays within float.
  const T most = constant<T>(1e12);
  return {min(most, max(-most, steep.x)), min(most, max(-most, steep.y))};
}

} // namespace surfgrad::engine
