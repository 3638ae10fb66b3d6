#pragma once

#include "image/sampler.hpp"
#include "raster/fragment.hpp"

#include <surfgrad/screen.hpp>

#include <memory>
#include <optional>

namespace surfgrad::engine {

/// A map laid on a texture coordinate: st' = R * (tile * st) + offset.
struct Texture {
  std::shared_ptr<const image::Map> map;
  int slot = 0;
  vec2<double> tile{1, 1};
  vec2<double> rotation{1, 0}; ///< cosine and sine
  vec2<double> offset{0, 0};
  image::Wraps wrap{};
  image::Filter filter = image::Filter::trilinear;
};

/// v turned counter-clockwise by the texture's rotation.
template <Scalar T>
[[nodiscard]] vec2<T> rotated(const Texture& texture, vec2<T> v) {
  const T c = constant<T>(texture.rotation.x);
  const T s = constant<T>(texture.rotation.y);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// A direction of the texture's image expressed along the texture coordinate again: the rotation
/// undone, mirrored axes turned over. The size of the tile is left alone: a bump as steep in the map
/// is as steep on the surface, however often the map repeats (section 2.5).
template <Scalar T>
[[nodiscard]] vec2<T> along_coordinate(const Texture& texture, vec2<T> v) {
  const T c = constant<T>(texture.rotation.x);
  const T s = constant<T>(texture.rotation.y);
  return {constant<T>(texture.tile.x < 0 ? -1 : 1) * (c * v.x + s * v.y),
          constant<T>(texture.tile.y < 0 ? -1 : 1) * (c * v.y - s * v.x)};
}

/// The map's components under the fragment, filtered for its footprint.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const Texture& texture, const raster::Fragment<T>& fragment) {
  const raster::UvFragment<T>& uv = fragment.uvs[static_cast<std::size_t>(texture.slot)];
  const vec2<T> tile{constant<T>(texture.tile.x), constant<T>(texture.tile.y)};
  const vec2<T> offset{constant<T>(texture.offset.x), constant<T>(texture.offset.y)};
  const vec2<T> st = rotated(texture, tile * uv.st) + offset;
  const vec2<T> size{T(static_cast<value_t<T>>(texture.map->width())),
                     T(static_cast<value_t<T>>(texture.map->height()))};
  const T lod = texture_lod(rotated(texture, tile * uv.dst_dx), rotated(texture, tile * uv.dst_dy), size);
  const T one = T(value_t<T>(1));
  return image::sample<N>(*texture.map, st, lod, texture.wrap, texture.filter, mask_t<T>(one == one));
}

/// Weight and blend of a layer within its pass.
struct Influence {
  double scale = 1;
  double opacity = 1;
  bool mix = false; ///< else add
  std::optional<Texture> mask{};
};

/// The pass's sum with one more surface gradient g. With w = mask * opacity:
/// add: G + w * scale * g; mix: (1 - w) * G + w * scale * g. Saturates: no scale makes it infinite.
template <LaneScalar T>
[[nodiscard]] vec3<T> blended(const Influence& influence, const raster::Fragment<T>& fragment, vec3<T> sum,
                              vec3<T> g) {
  T w = constant<T>(influence.opacity);
  if (influence.mask) w = w * sample<1>(*influence.mask, fragment)[0];
  const vec3<T> scaled = (w * constant<T>(influence.scale)) * g;
  return saturated(influence.mix ? (T(value_t<T>(1)) - w) * sum + scaled : sum + scaled);
}

} // namespace surfgrad::engine
