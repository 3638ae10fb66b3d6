#pragma once

#include "engine/point.hpp"
#include "engine/texture.hpp"

#include <optional>

namespace surfgrad::engine {

/// Weight and blend of a layer within its pass.
struct Influence {
  double scale = 1;
  double opacity = 1;
  bool mix = false; ///< else add
  std::optional<Texture> mask{};
};

/// w = mask * opacity.
template <LaneScalar T>
[[nodiscard]] T weight(const Influence& influence, const raster::Fragment<T>& fragment) {
  const T w = constant<T>(influence.opacity);
  return influence.mask ? w * sample<1>(*influence.mask, fragment)[0] : w;
}

/// The pass's sum with one more surface gradient g, of weight w:
/// add: G + w * scale * g; mix: (1 - w) * G + w * scale * g. Saturates: no scale makes it infinite.
template <LaneScalar T>
[[nodiscard]] vec3<T> blended(const Influence& influence, T w, vec3<T> sum, vec3<T> g) {
  const vec3<T> scaled = (w * constant<T>(influence.scale)) * g;
  return saturated(influence.mix ? (T(value_t<T>(1)) - w) * sum + scaled : sum + scaled);
}

} // namespace surfgrad::engine
