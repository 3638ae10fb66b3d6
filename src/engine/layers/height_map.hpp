#pragma once

#include "engine/layers/normal_map.hpp"
#include "image/bicubic.hpp"
#include "image/height_map.hpp"

#include <surfgrad/derivative.hpp>
#include <surfgrad/gradient.hpp>

namespace surfgrad::engine {

/// A map of heights: displacements of the surface, or what slopes are made of.
struct HeightMap {
  enum class Kind { scene_units, object_units, scale_free };

  Influence influence{};
  Texture texture{};                          ///< heights; scale_free: their slopes by the whole map
  std::shared_ptr<const image::Map> smooth{}; ///< heights read as a B-spline where magnified; may be null
  double height = 1; ///< of the value 1: a displacement; scale_free: in widths of the map
  Kind kind = Kind::scene_units;
  bool across_quad = false; ///< slopes from the heights of a block of 2x2 pixels, one a pixel
  bool derived = true;      ///< scale_free: tangent frame from the texture coordinate
};

/// How much of the slope comes from the B-spline at a mip level: all where the map is magnified, none
/// from half a level of minification on, where a texel's neighbours no longer show. Continuous.
template <Scalar T>
[[nodiscard]] T smooth_share(T lod) {
  // From 0.5 to 0.05, as the paper's reference implementation fades. NaN gives none.
  const T share = (constant<T>(0.5) - lod) * constant<T>(1 / 0.45);
  return min(max(share, T(value_t<T>(0))), T(value_t<T>(1)));
}

/// `coarse`, or what the smooth surface of a layer that has one says in its stead.
///
/// smooth  vec2<T>(vec2<T> dh_dst): what the derivative of the heights by the whole map amounts to
template <LaneScalar T, class Smooth>
[[nodiscard]] vec2<T> smoothed(const HeightMap& layer, vec2<T> st, T lod, vec2<T> coarse, Smooth smooth) {
  if (!layer.smooth) return coarse;
  const T share = smooth_share(lod);
  const mask_t<T> magnified = T(value_t<T>(0)) < share;
  if (!any(magnified)) return coarse;
  const image::Map& map = *layer.smooth;
  const vec2<T> size{T(static_cast<value_t<T>>(map.width())), T(static_cast<value_t<T>>(map.height()))};
  const vec2<T> fine =
      smooth(size * image::sample_bicubic(map, st, layer.texture.tiled.wrap, magnified).derivative);
  return select<T>(magnified, coarse + share * (fine - coarse), coarse);
}

/// Change of the height per pixel to the right and upwards, in units of the map's values: listing 9.
template <LaneScalar T>
[[nodiscard]] vec2<T> height_per_pixel(const HeightMap& layer, const raster::Fragment<T>& fragment) {
  const TiledMap& tiled = layer.texture.tiled;
  const raster::UvFragment<T>& uv = fragment.uvs[static_cast<std::size_t>(layer.texture.slot)];
  const T lod = level_of_detail(tiled, uv.footprint_dx, uv.footprint_dy);
  const image::Footprint<T> footprint = footprint_in_map(tiled, uv.footprint_dx, uv.footprint_dy);
  return height_derivative(tiled, map_coordinate(tiled, uv.st), [&](const MapTile<T>& tile) {
    const vec2<T> dx = in_tile(tile, in_map(tiled, uv.dst_dx));
    const vec2<T> dy = in_tile(tile, in_map(tiled, uv.dst_dy));
    const auto height = [&](vec2<T> st) { return sample_at<1>(tiled, st, in_tile(tile, footprint))[0]; };
    vec2<T> first = tile.st;
    if (layer.across_quad) {
      // The pixels of a block share the differences between its first pixel and the two next to that.
      const auto odd = [](T raster) {
        const T pixel = floor(raster);
        return pixel - T(value_t<T>(2)) * floor(constant<T>(0.5) * pixel);
      };
      first = tile.st - odd(fragment.raster.x) * dx - odd(fragment.raster.y) * dy;
    }
    const vec2<T> taps = derivative_from_heights(height(first), height(first + dx), height(first + dy));
    return smoothed(layer, tile.st, lod, taps, [&](vec2<T> dh) { // listing 8's chain rule
      return vec2<T>{dot(dh, dx), dot(dh, dy)};
    });
  });
}

/// Slopes of the heights along the texture coordinate, for any tile and any object: heights are measured
/// in widths of the map, whose texels count as square. As steep as a normal map's at most.
template <LaneScalar T>
[[nodiscard]] vec2<T> scale_free_slope(const HeightMap& layer, const raster::Fragment<T>& fragment) {
  const TiledMap& tiled = layer.texture.tiled;
  const raster::UvFragment<T>& uv = fragment.uvs[static_cast<std::size_t>(layer.texture.slot)];
  const T lod = level_of_detail(tiled, uv.footprint_dx, uv.footprint_dy);
  const image::Footprint<T> footprint = footprint_in_map(tiled, uv.footprint_dx, uv.footprint_dy);
  const vec2<T> st = map_coordinate(tiled, uv.st);
  const vec2<T> dh = height_derivative(tiled, st, [&](const MapTile<T>& tile) {
    const vec2<T> by_map = slope_of_heights(tiled, tile.st, in_tile(tile, footprint));
    return derivative_from_tile(tile, smoothed(layer, tile.st, lod, by_map, [](vec2<T> d) { return d; }));
  });
  const double height_by_width = static_cast<double>(tiled.map->height()) / tiled.map->width();
  const vec2<T> height{constant<T>(layer.height), constant<T>(layer.height / height_by_width)};
  const vec2<T> slope = saturated(height * dh);
  const T steepest = T(static_cast<value_t<T>>(max_slope));
  return along_coordinate(tiled, (steepest / max(steepest, max_abs(slope))) * slope);
}

/// Whether two changes along the screen span nothing: parallel to rounding, or one is zero.
template <Scalar T>
[[nodiscard]] mask_t<T> is_collapsed(vec2<T> d_dx, vec2<T> d_dy) {
  const T area = cross(reciprocal_or_zero(max_abs(d_dx)) * d_dx, reciprocal_or_zero(max_abs(d_dy)) * d_dy);
  return !(T(epsilon_v<T>) < abs(area)); // so that NaN collapses too
}
template <Scalar T>
[[nodiscard]] mask_t<T> is_collapsed(vec3<T> d_dx, vec3<T> d_dy) {
  const vec3<T> area =
      cross(reciprocal_or_zero(max_abs(d_dx)) * d_dx, reciprocal_or_zero(max_abs(d_dy)) * d_dy);
  return !(T(epsilon_v<T>) < max_abs(area));
}

/// Surface gradient of a displacement of the surface: listing 8. However the map is tiled, turned or
/// mirrored, the heights are those that the surface shows.
template <LaneScalar T>
[[nodiscard]] vec3<T> displacement_gradient(const HeightMap& layer, const Point<T>& point,
                                            mask_t<T>& degenerate) {
  const raster::UvFragment<T>& uv = point.fragment.uvs[static_cast<std::size_t>(layer.texture.slot)];
  const bool world = layer.kind == HeightMap::Kind::scene_units;
  const SpacePoint<T> space = in_space(point, world);
  const vec3<T> normal = normal_in_space(point, world);
  const mask_t<T> no_texture = is_collapsed(uv.dst_dx, uv.dst_dy);
  const mask_t<T> no_surface = is_collapsed(space.dp_dx, space.dp_dy);
  const mask_t<T> collapsed = no_texture | no_surface;
  degenerate = degenerate | collapsed;
  const vec2<T> dh = saturated(constant<T>(layer.height) * height_per_pixel(layer, point.fragment));
  vec3<T> g = from_parametric_derivative(normal, space.dp_dx, space.dp_dy, dh);
  const T zero = T(value_t<T>(0));
  const vec3<T> none{zero, zero, zero};
  if (!world) g = from_gradient_in_space(point, world, saturated(g));
  return select<T>(collapsed, none, g);
}

/// Surface gradient of a height map at a point.
///
/// degenerate   (out) set where the texture coordinate has collapsed, or what the layer needs with it:
///              the change of the position, or the vertex frame; the gradient is zero there
template <LaneScalar T>
[[nodiscard]] vec3<T> surface_gradient(const HeightMap& layer, const Point<T>& point, mask_t<T>& degenerate) {
  if (layer.kind != HeightMap::Kind::scale_free) return displacement_gradient(layer, point, degenerate);
  mask_t<T> collapsed;
  const TangentFrame<T> basis = frame_of(point, layer.texture.slot, layer.derived, collapsed);
  degenerate = degenerate | collapsed;
  return from_tbn(scale_free_slope(layer, point.fragment), basis.tangent, basis.bitangent);
}

} // namespace surfgrad::engine
