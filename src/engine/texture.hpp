#pragma once

#include "image/anisotropy.hpp"
#include "image/height_map.hpp"
#include "image/sampler.hpp"
#include "raster/fragment.hpp"

#include <surfgrad/derivative.hpp>
#include <surfgrad/hex_tiles.hpp>
#include <surfgrad/screen.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <type_traits>

namespace surfgrad::engine {

/// A map laid on a plane of coordinates st: st' = R * (tile * st) + offset.
struct TiledMap {
  std::shared_ptr<const image::Map> map;
  vec2<double> tile{1, 1};
  vec2<double> rotation{1, 0}; ///< cosine and sine
  vec2<double> offset{0, 0};
  image::Wraps wrap{};
  image::Filter filter = image::Filter::trilinear;
  /// Hex tiles instead of plain repetition: how far they turn, 0 to 1 (hex_tiles). Only with wrap repeat.
  std::optional<double> hex_turn{};
  int anisotropy = 1; ///< most trilinear probes for a footprint: 1 to image::most_anisotropy
};

/// A map laid on a texture coordinate of the surface.
struct Texture {
  TiledMap tiled{};
  int slot = 0;
};

/// Most maps are not turned: what would turn them is left out.
[[nodiscard]] inline bool turned(const TiledMap& tiled) {
  return !(tiled.rotation.x == 1 && tiled.rotation.y == 0);
}

/// v turned counter-clockwise by the map's rotation.
template <Scalar T>
[[nodiscard]] vec2<T> rotated(const TiledMap& tiled, vec2<T> v) {
  if (!turned(tiled)) return v;
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

/// A coordinate st relative to a point of the plane.
template <class T>
struct PlanePlace {
  vec2<T> st;
  vec2<double> origin; ///< uniform: may lie far from where the plane's coordinates begin

  PlanePlace(vec2<T> place, vec2<double> from = {0, 0}) : st(place), origin(from) {} // NOLINT: any coordinate
};

/// Where a map is read, relative to whatever is far away and makes no difference: whole periods, and of the
/// grid of hex tiles a vertex.
template <class T>
struct MapPlace {
  vec2<T> st; ///< st', but for what is left out
  HexOrigin<value_t<T>> hex{};
};

/// Where the map is read for a point of the plane.
[[nodiscard]] MapPlace<double> map_origin(const TiledMap& tiled, vec2<double> point);

/// Where the map is read: exact near the place's origin however far away that is.
template <Scalar T>
[[nodiscard]] MapPlace<T> map_place(const TiledMap& tiled, const PlanePlace<T>& place) {
  if (place.origin.x == 0 && place.origin.y == 0) return {map_coordinate(tiled, place.st)};
  using V = value_t<T>;
  const MapPlace<double> origin = map_origin(tiled, place.origin);
  return {in_map(tiled, place.st) + vec2<T>{constant<T>(origin.st.x), constant<T>(origin.st.y)},
          {origin.hex.start, {static_cast<V>(origin.hex.shift.x), static_cast<V>(origin.hex.shift.y)}}};
}

/// Mip level for a footprint on the plane of st.
template <Scalar T>
[[nodiscard]] T level_of_detail(const TiledMap& tiled, vec2<T> footprint_dx, vec2<T> footprint_dy) {
  const vec2<T> size{T(static_cast<value_t<T>>(tiled.map->width())),
                     T(static_cast<value_t<T>>(tiled.map->height()))};
  return texture_lod(in_map(tiled, footprint_dx), in_map(tiled, footprint_dy), size);
}

/// What a footprint on the plane of st is on that of st'.
template <LaneScalar T>
[[nodiscard]] image::Footprint<T> footprint_in_map(const TiledMap& tiled, vec2<T> footprint_dx,
                                                   vec2<T> footprint_dy) {
  if (tiled.anisotropy == 1) {
    const T zero = T(value_t<T>(0));
    return {level_of_detail(tiled, footprint_dx, footprint_dy), {zero, zero}, T(value_t<T>(1))};
  }
  const vec2<T> size{T(static_cast<value_t<T>>(tiled.map->width())),
                     T(static_cast<value_t<T>>(tiled.map->height()))};
  return image::footprint_of(in_map(tiled, footprint_dx), in_map(tiled, footprint_dy), size,
                             tiled.anisotropy);
}

/// v turned clockwise by the map's rotation.
template <Scalar T>
[[nodiscard]] vec2<T> rotated_back(const TiledMap& tiled, vec2<T> v) {
  if (!turned(tiled)) return v;
  const T c = constant<T>(tiled.rotation.x);
  const T s = constant<T>(tiled.rotation.y);
  return {c * v.x + s * v.y, c * v.y - s * v.x};
}

/// A slope of the map's image expressed along st again: the rotation undone, mirrored axes turned over.
/// The size of the tile is left alone: a bump as steep in the map is as steep on the surface, however
/// often the map repeats (section 2.5).
template <Scalar T>
[[nodiscard]] vec2<T> along_coordinate(const TiledMap& tiled, vec2<T> v) {
  const vec2<T> side{constant<T>(tiled.tile.x < 0 ? -1 : 1), constant<T>(tiled.tile.y < 0 ? -1 : 1)};
  return side * rotated_back(tiled, v);
}

/// The same for a derivative of a height by st': its derivative by st. Here the tile's size counts: a
/// map that repeats more often is steeper (section 2.5).
template <Scalar T>
[[nodiscard]] vec2<T> by_coordinate(const TiledMap& tiled, vec2<T> dh) {
  return vec2<T>{constant<T>(tiled.tile.x), constant<T>(tiled.tile.y)} * rotated_back(tiled, dh);
}

/// A part of the plane on which the map is shown: all of it, or one of the hex tiles over a point.
template <class T>
struct MapTile {
  vec2<T> st;          ///< where the map is read
  bool plain;          ///< uniform: the whole plane; st is st' and nothing is turned
  vec2<T> rotation;    ///< cosine and sine: st turns by it as st' moves
  vec2<double> period; ///< of the map in units of its shorter side: where its texels are square
};

/// A change of st' as a change of tile.st.
template <Scalar T>
[[nodiscard]] vec2<T> in_tile(const MapTile<T>& tile, vec2<T> change) {
  if (tile.plain) return change;
  const vec2<T> period{constant<T>(tile.period.x), constant<T>(tile.period.y)};
  const vec2<T> inverse{constant<T>(1 / tile.period.x), constant<T>(1 / tile.period.y)};
  return inverse * rotate(period * change, tile.rotation);
}

/// A footprint on the plane of st' as one of tile.st. A tile turns where texels are square: the footprint is
/// as long and as wide in it.
template <Scalar T>
[[nodiscard]] image::Footprint<T> in_tile(const MapTile<T>& tile, const image::Footprint<T>& footprint) {
  return {footprint.lod, in_tile(tile, footprint.axis), footprint.probes};
}

/// A derivative of a height by tile.st: its derivative by st'.
template <Scalar T>
[[nodiscard]] vec2<T> derivative_from_tile(const MapTile<T>& tile, vec2<T> dh) {
  if (tile.plain) return dh;
  const vec2<T> period{constant<T>(tile.period.x), constant<T>(tile.period.y)};
  const vec2<T> inverse{constant<T>(1 / tile.period.x), constant<T>(1 / tile.period.y)};
  return period * rotate_back(inverse * dh, tile.rotation);
}

/// Side of the triangles of hex tiles, in units of the map's shorter side.
inline constexpr double hex_edge = 0.5;

/// The sides of a map in units of the shorter: in them texels are square.
[[nodiscard]] inline vec2<double> sides_of(const image::Map& map) {
  const double shorter = std::min(map.width(), map.height());
  return {map.width() / shorter, map.height() / shorter};
}

/// The hex tiles over a point of the map's plane.
template <class T>
struct HexMapTiles {
  HexTiles<T> hex; ///< in units of the map's shorter side
  MapTile<T> tile[3];
};

/// st, origin  as map_place gives them
template <LaneScalar T>
[[nodiscard]] HexMapTiles<T> hex_map_tiles(const TiledMap& tiled, vec2<T> st,
                                           HexOrigin<value_t<T>> origin = {}) {
  const vec2<double> period = sides_of(*tiled.map);
  using Value = value_t<T>;
  const vec2<Value> sides{static_cast<Value>(period.x), static_cast<Value>(period.y)};
  HexMapTiles<T> tiles;
  tiles.hex = hex_tiles(vec2<T>{T(sides.x), T(sides.y)} * st, static_cast<Value>(*tiled.hex_turn),
                        static_cast<Value>(hex_edge), sides, origin);
  const vec2<T> inverse{constant<T>(1 / period.x), constant<T>(1 / period.y)};
  for (int k = 0; k < 3; ++k)
    tiles.tile[k] = {inverse * tiles.hex.st[k], false, tiles.hex.rotation[k], period};
  return tiles;
}

/// Weights of tiles that do not depend on what they show.
template <LaneScalar T>
[[nodiscard]] vec3<T> weights_by_place(const HexTiles<T>& tiles) {
  const T zero = T(value_t<T>(0));
  return hex_weights(tiles, {{zero, zero}, {zero, zero}, {zero, zero}}, value_t<T>(7), value_t<T>(0));
}

/// The derivative of a height that a tiled map holds: that of the map itself, or blended from the hex
/// tiles over the point. The weights go by place alone, so that a map's heights and their slopes are
/// blended alike; they count as constant (hex_derivative).
///
/// st       st'
/// of_tile  vec2<T>(const MapTile<T>&): the derivative in a tile by something that is no part of it, such
///          as st' (derivative_from_tile) or the pixel (in_tile)
template <LaneScalar T, class OfTile>
[[nodiscard]] vec2<T> height_derivative(const TiledMap& tiled, vec2<T> st, const OfTile& of_tile,
                                        HexOrigin<value_t<T>> origin = {}) {
  if (!tiled.hex_turn) {
    const T one = T(value_t<T>(1));
    return of_tile(MapTile<T>{st, true, {one, T(value_t<T>(0))}, {1, 1}});
  }
  const HexMapTiles<T> tiles = hex_map_tiles(tiled, st, origin);
  const vec3<T> w = weights_by_place(tiles.hex);
  return w.x * of_tile(tiles.tile[0]) + w.y * of_tile(tiles.tile[1]) + w.z * of_tile(tiles.tile[2]);
}

/// The map's components where a coordinate st' or a tile reads it.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample_at(const TiledMap& tiled, vec2<T> st, T lod) {
  const T one = T(value_t<T>(1));
  return image::sample<N>(*tiled.map, st, lod, tiled.wrap, tiled.filter, mask_t<T>(one == one));
}

/// The same, filtered for a footprint on the plane in which it is read.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample_at(const TiledMap& tiled, vec2<T> st,
                                         const image::Footprint<T>& footprint) {
  if (tiled.anisotropy == 1) return sample_at<N>(tiled, st, footprint.lod);
  const T one = T(value_t<T>(1));
  return image::sample<N>(*tiled.map, st, footprint, tiled.wrap, mask_t<T>(one == one));
}

/// The components of a map of values at a coordinate, filtered for a footprint: weights, heights. What
/// has a direction in the plane is turned with its tile: sample_slopes and sample_height_slopes.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const TiledMap& tiled, const std::type_identity_t<PlanePlace<T>>& st,
                                      const vec2<T>& footprint_dx, const vec2<T>& footprint_dy) {
  const image::Footprint<T> footprint = footprint_in_map(tiled, footprint_dx, footprint_dy);
  const MapPlace<T> here = map_place<T>(tiled, st);
  if (!tiled.hex_turn) return sample_at<N>(tiled, here.st, footprint);
  const HexMapTiles<T> tiles = hex_map_tiles(tiled, here.st, here.hex);
  const vec3<T> w = weights_by_place(tiles.hex);
  const auto of_tile = [&](const MapTile<T>& tile) {
    return sample_at<N>(tiled, tile.st, in_tile(tile, footprint));
  };
  const std::array<T, N> a = of_tile(tiles.tile[0]);
  const std::array<T, N> b = of_tile(tiles.tile[1]);
  const std::array<T, N> c = of_tile(tiles.tile[2]);
  std::array<T, N> blend;
  for (int i = 0; i < N; ++i) blend[i] = w.x * a[i] + w.y * b[i] + w.z * c[i];
  return blend;
}

/// Where a coordinate st' or a tile reads a map of slopes, or of encoded normals: the slope.
template <LaneScalar T>
[[nodiscard]] vec2<T> slope_at(const TiledMap& tiled, vec2<T> st, const image::Footprint<T>& footprint) {
  if (tiled.map->encoded && tiled.map->components == 3) {
    const std::array<T, 3> normal = sample_at<3>(tiled, st, footprint);
    return derivative_from_normal(vec3<T>{normal[0], normal[1], normal[2]});
  }
  const std::array<T, 2> texel = sample_at<2>(tiled, st, footprint);
  const vec2<T> of_texel{texel[0], texel[1]};
  return tiled.map->encoded ? derivative_from_normal(of_texel) : of_texel;
}

/// The slopes of a map of slopes along st' (along_coordinate takes them to st). Of hex tiles the steeper
/// prevail.
template <LaneScalar T>
[[nodiscard]] vec2<T> sample_slopes(const TiledMap& tiled, const std::type_identity_t<PlanePlace<T>>& st,
                                    const vec2<T>& footprint_dx, const vec2<T>& footprint_dy) {
  const image::Footprint<T> footprint = footprint_in_map(tiled, footprint_dx, footprint_dy);
  const MapPlace<T> here = map_place<T>(tiled, st);
  if (!tiled.hex_turn) return slope_at(tiled, here.st, footprint);
  const HexMapTiles<T> tiles = hex_map_tiles(tiled, here.st, here.hex);
  const auto of_tile = [&](const MapTile<T>& tile) {
    return slope_at(tiled, tile.st, in_tile(tile, footprint));
  };
  const vec2<T> slopes[3] = {of_tile(tiles.tile[0]), of_tile(tiles.tile[1]), of_tile(tiles.tile[2])};
  return hex_derivative(tiles.hex, hex_weights(tiles.hex, slopes), slopes);
}

/// Where a coordinate st' or a tile reads a map of derivatives of heights: the derivative by that.
template <LaneScalar T>
[[nodiscard]] vec2<T> slope_of_heights(const TiledMap& tiled, vec2<T> st, T lod) {
  const std::array<T, 2> texel = sample_at<2>(tiled, st, lod);
  return image::wrapped_slope(st, vec2<T>{texel[0], texel[1]}, tiled.wrap);
}

/// The same over a footprint on the plane in which it is read: of every probe the slope that shows there.
template <LaneScalar T>
[[nodiscard]] vec2<T> slope_of_heights(const TiledMap& tiled, vec2<T> st,
                                       const image::Footprint<T>& footprint) {
  if (tiled.anisotropy == 1) return slope_of_heights(tiled, st, footprint.lod);
  const T one = T(value_t<T>(1));
  const auto slope = image::average_of_probes<2, T>(
      footprint, mask_t<T>(one == one), [&](vec2<T> offset, mask_t<T>) -> std::array<T, 2> {
        const vec2<T> d = slope_of_heights(tiled, st + offset, footprint.lod);
        return {d.x, d.y};
      });
  return {slope[0], slope[1]};
}

/// The derivative by st' of the heights whose derivatives by the whole map `tiled` holds (by_coordinate
/// takes it to st).
template <LaneScalar T>
[[nodiscard]] vec2<T> sample_height_slopes(const TiledMap& tiled,
                                           const std::type_identity_t<PlanePlace<T>>& st,
                                           const vec2<T>& footprint_dx, const vec2<T>& footprint_dy) {
  const image::Footprint<T> footprint = footprint_in_map(tiled, footprint_dx, footprint_dy);
  const MapPlace<T> here = map_place<T>(tiled, st);
  const auto of_tile = [&](const MapTile<T>& tile) {
    return derivative_from_tile(tile, slope_of_heights(tiled, tile.st, in_tile(tile, footprint)));
  };
  return height_derivative(tiled, here.st, of_tile, here.hex);
}

/// The components of a map of values under the fragment, filtered for its footprint.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const Texture& texture, const raster::Fragment<T>& fragment) {
  const raster::UvFragment<T>& uv = fragment.uvs[static_cast<std::size_t>(texture.slot)];
  return sample<N>(texture.tiled, uv.st, uv.footprint_dx, uv.footprint_dy);
}

/// The slopes under the fragment of a map of slopes, along st'.
template <LaneScalar T>
[[nodiscard]] vec2<T> sample_slopes(const Texture& texture, const raster::Fragment<T>& fragment) {
  const raster::UvFragment<T>& uv = fragment.uvs[static_cast<std::size_t>(texture.slot)];
  return sample_slopes(texture.tiled, uv.st, uv.footprint_dx, uv.footprint_dy);
}

} // namespace surfgrad::engine
