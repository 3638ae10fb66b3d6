#pragma once

#include "image/sampler.hpp"
#include "raster/fragment.hpp"

#include <surfgrad/screen.hpp>

#include <memory>

namespace surfgrad::engine {

/// A map laid on a plane of coordinates st: st' = R * (tile * st) + offset.
struct TiledMap {
  std::shared_ptr<const image::Map> map;
  vec2<double> tile{1, 1};
  vec2<double> rotation{1, 0}; ///< cosine and sine
  vec2<double> offset{0, 0};
  image::Wraps wrap{};
  image::Filter filter = image::Filter::trilinear;
};

/// A map laid on a texture coordinate of the surface.
struct Texture {
  TiledMap tiled{};
  int slot = 0;
};

/// v turned counter-clockwise by the map's rotation.
template <Scalar T>
[[nodiscard]] vec2<T> rotated(const TiledMap& tiled, vec2<T> v) {
  const T c = constant<T>(tiled.rotation.x);
  const T s = constant<T>(tiled.rotation.y);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

/// A change of st as a change of st': what a direction or a footprint becomes in the map.
template <Scalar T>
[[nodiscard]] vec2<T> in_map(const TiledMap& tiled, vec2<T> change) {
  return rotated(tiled, vec2<T>{constant<T>(tiled.tile.x), constant<T>(tiled.tile.y)} * change);
}

/// Where the map is read for a coordinate: st'.
template <Scalar T>
[[nodiscard]] vec2<T> map_coordinate(const TiledMap& tiled, vec2<T> st) {
  return in_map(tiled, st) + vec2<T>{constant<T>(tiled.offset.x), constant<T>(tiled.offset.y)};
}

/// Mip level for a footprint on the plane of st.
template <Scalar T>
[[nodiscard]] T level_of_detail(const TiledMap& tiled, vec2<T> footprint_dx, vec2<T> footprint_dy) {
  const vec2<T> size{T(static_cast<value_t<T>>(tiled.map->width())),
                     T(static_cast<value_t<T>>(tiled.map->height()))};
  return texture_lod(in_map(tiled, footprint_dx), in_map(tiled, footprint_dy), size);
}

/// A slope of the map's image expressed along st again: the rotation undone, mirrored axes turned over.
/// The size of the tile is left alone: a bump as steep in the map is as steep on the surface, however
/// often the map repeats (section 2.5).
template <Scalar T>
[[nodiscard]] vec2<T> along_coordinate(const TiledMap& tiled, vec2<T> v) {
  const T c = constant<T>(tiled.rotation.x);
  const T s = constant<T>(tiled.rotation.y);
  return {constant<T>(tiled.tile.x < 0 ? -1 : 1) * (c * v.x + s * v.y),
          constant<T>(tiled.tile.y < 0 ? -1 : 1) * (c * v.y - s * v.x)};
}

/// The same for a derivative of a height by st': its derivative by st. Here the tile's size counts: a
/// map that repeats more often is steeper (section 2.5).
template <Scalar T>
[[nodiscard]] vec2<T> by_coordinate(const TiledMap& tiled, vec2<T> dh) {
  const T c = constant<T>(tiled.rotation.x);
  const T s = constant<T>(tiled.rotation.y);
  return {constant<T>(tiled.tile.x) * (c * dh.x + s * dh.y),
          constant<T>(tiled.tile.y) * (c * dh.y - s * dh.x)};
}

/// The map's components at a coordinate, filtered for a footprint.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const TiledMap& tiled, vec2<T> st, vec2<T> footprint_dx,
                                      vec2<T> footprint_dy) {
  const T lod = level_of_detail(tiled, footprint_dx, footprint_dy);
  const T one = T(value_t<T>(1));
  return image::sample<N>(*tiled.map, map_coordinate(tiled, st), lod, tiled.wrap, tiled.filter,
                          mask_t<T>(one == one));
}

/// The map's components under the fragment, filtered for its footprint.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const Texture& texture, const raster::Fragment<T>& fragment) {
  const raster::UvFragment<T>& uv = fragment.uvs[static_cast<std::size_t>(texture.slot)];
  return sample<N>(texture.tiled, uv.st, uv.footprint_dx, uv.footprint_dy);
}

} // namespace surfgrad::engine
