#pragma once

/// Parallax mapping: the mesh as a window onto a surface displaced along its normal.
///
/// In the tangent plane's own measure the virtual surface is p' = p + (h - level) * displacement * n
/// (section 2.6), h the height over the texture coordinate. Everything that layers read moves there.

#include "engine/layers/height_map.hpp"
#include "image/height_march.hpp"

#include <surfgrad/parallax.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::engine {

struct Parallax {
  Influence influence{}; ///< its scale is part of relief.height
  HeightMap relief{};    ///< heights within [0, 1], in units of the scene
  std::shared_ptr<const image::TwoSidedField> field{};
  double level = 0; ///< the height that lies on the mesh
  bool occlusion = true;
  bool limit_offset = false;
  bool displaced_footprint = false;
  bool height_normal = true;
  bool curvature = true;
  bool reflect = false;
  bool self_shadow = false;
};

/// What of a fragment the search on its relief depends on. All of it is the base surface's.
template <class T>
struct Window {
  raster::UvFragment<T> uv;
  T displacement; ///< of a height of 1 along frame.normal
  T side;         ///< 1 where frame.normal should face the viewer, -1 where it should not (mode same)
  T lod;
  mask_t<T> sound; ///< the plane and its texture coordinate span something
};

template <LaneScalar T>
[[nodiscard]] Window<T> window_of(const Parallax& layer, const Point<T>& point) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const raster::Fragment<T>& f = point.fragment;
  const TiledMap& tiled = layer.relief.texture.tiled;
  Window<T> w;
  w.uv = f.uvs[static_cast<std::size_t>(layer.relief.texture.slot)];
  // In mode flip the normal is turned over, and the relief stays where it was.
  w.displacement = point.frame.resolve_sign * (constant<T>(layer.relief.height) * weight(layer.influence, f));
  const mask_t<T> turned_over = dot(point.frame.normal, f.normal) < zero;
  w.side = select(mask_t<T>(f.front_facing | turned_over), one, -one);
  w.lod = tiled.filter == image::Filter::trilinear
              ? level_of_detail(tiled, w.uv.footprint_dx, w.uv.footprint_dy)
              : zero;
  const mask_t<T> no_coordinate = is_collapsed(w.uv.dst_dx, w.uv.dst_dy);
  const mask_t<T> no_plane = is_collapsed(point.frame.dp_dx, point.frame.dp_dy);
  w.sound = mask_t<T>(zero < max_abs(point.frame.normal)) & mask_t<T>(!(no_coordinate | no_plane));
  return w;
}

/// Change of st while a ray in a direction rises by a height of 1, no longer than a march bears.
template <LaneScalar T>
[[nodiscard]] vec2<T> way_of(const Parallax& layer, const Frame<T>& frame, const Window<T>& window,
                             vec3<T> direction, bool skip_projection, mask_t<T> active) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const vec2<T> dst = project_to_texture_space(frame, direction, window.uv.dst_dx, window.uv.dst_dy,
                                               window.displacement, skip_projection);
  const TiledMap& tiled = layer.relief.texture.tiled;
  const T shrink = exp2(-max(floor(window.lod + constant<T>(0.5)), zero));
  const vec2<T> size{max(shrink * T(static_cast<value_t<T>>(tiled.map->width())), one),
                     max(shrink * T(static_cast<value_t<T>>(tiled.map->height())), one)};
  const T most = T(static_cast<value_t<T>>(image::march_most_texels));
  const T length = max_abs(saturated(size * in_map(tiled, dst)));
  const T share = select(most < length, most / max(length, one), one);
  return select<T>(active, share * dst, {zero, zero});
}

/// Where a ray meets the relief: at st + way.
template <class T>
struct Met {
  vec2<T> way;
  T height;
};

/// Occlusion mapping: the first crossing. Who looks along the displacement meets the relief from below,
/// where its depths are heights and the way runs the other way round.
template <LaneScalar T>
[[nodiscard]] Met<T> first_met(const Parallax& layer, const Window<T>& window, vec2<T> dst,
                               mask_t<T> from_below) {
  const TiledMap& tiled = layer.relief.texture.tiled;
  const T one = T(value_t<T>(1));
  const T level = constant<T>(layer.level);
  const vec2<T> st = map_coordinate(tiled, window.uv.st);
  const vec2<T> way = in_map(tiled, dst);
  const mask_t<T> from_above = !from_below;
  T height = one;
  if (any(from_above))
    height = image::march(layer.field->from_above, tiled.wrap, st - level * way, way, window.lod, from_above)
                 .height;
  if (any(from_below)) {
    const T depth = image::march(layer.field->from_below, tiled.wrap, st + (one - level) * way, -way,
                                 window.lod, from_below)
                        .height;
    height = select(from_below, one - depth, height);
  }
  return {(height - level) * dst, height};
}

/// Offset mapping: one step, by the height under the fragment.
template <LaneScalar T>
[[nodiscard]] Met<T> one_step(const Parallax& layer, const Window<T>& window, vec2<T> dst) {
  const TiledMap& tiled = layer.relief.texture.tiled;
  const auto height = [&](vec2<T> st) {
    return sample<1>(tiled, st, window.uv.footprint_dx, window.uv.footprint_dy)[0];
  };
  const vec2<T> way = (height(window.uv.st) - constant<T>(layer.level)) * dst;
  return {way, height(window.uv.st + way)};
}

/// The base normal where the point has moved to, v pixels away (section 2.6).
template <LaneScalar T>
[[nodiscard]] vec3<T> normal_after(const Parallax& layer, const Point<T>& point, vec2<T> v) {
  if (!layer.curvature) return point.frame.normal;
  const raster::Fragment<T>& f = point.fragment;
  const vec3<T> n = point.frame.normal;
  const T zero = T(value_t<T>(0));
  const T size = reciprocal_or_zero(length(f.normal));
  // A triangle that stands in for normals which cancel is flat.
  const T rate = select(f.normal_is_absent, zero, select(dot(n, f.normal) < zero, -size, size));
  const auto of_unit = [&](vec3<T> dn) { return from_volume_gradient(n, saturated(rate * dn)); };
  return offset_normal(point.frame, of_unit(f.dn_dx), of_unit(f.dn_dy), v);
}

/// Share of the sun that reaches the point over the relief: 0 or 1.
///
/// base    frame of the base surface, its normal that at the point
/// height  of the point
/// A sun below the horizon of the base surface is behind that; where there is none, or nothing sound to
/// search, nothing is in its way.
template <LaneScalar T>
[[nodiscard]] T sun_over_relief(const Parallax& layer, const Point<T>& point, const Frame<T>& base,
                                const Window<T>& window, vec2<T> st, T height) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const TiledMap& tiled = layer.relief.texture.tiled;
  const vec3<T> to_sun = in_lanes<T>(point.placement.to_sun);
  const T along = dot(base.normal, to_sun);
  const mask_t<T> searched = window.sound & (zero < max_abs(to_sun));
  const mask_t<T> lit = searched & (zero < along);
  const vec2<T> way = in_map(tiled, way_of(layer, base, window, to_sun, false, lit));
  // Seen from below, the way to the sun leads down the relief.
  const mask_t<T> down = lit & (window.displacement * along < zero);
  const mask_t<T> up = lit & !down;
  const vec2<T> here = map_coordinate(tiled, st);
  // An offset's height is blended from two mip levels; shadows fall within one.
  if (!layer.occlusion)
    height =
        image::march(layer.field->from_above, tiled.wrap, here, vec2<T>{zero, zero}, window.lod, lit).height;
  T sun = select(searched, zero, one);
  if (any(up))
    sun = select(up, image::visible(layer.field->from_above, tiled.wrap, here, height, way, window.lod, up),
                 sun);
  if (any(down))
    sun = select(
        down, image::visible(layer.field->from_below, tiled.wrap, here, one - height, -way, window.lod, down),
        sun);
  return sun;
}

/// The footprint of the raster on the plane through the point that lies in the relief.
///
/// base      frame of the base surface at the point
/// surfgrad  that leads from its normal to `normal`, resolve_sign included
template <LaneScalar T>
[[nodiscard]] ScreenDerivatives<T> footprint_on_relief(const Parallax& layer, const Point<T>& point,
                                                       const Window<T>& window, const Frame<T>& base,
                                                       vec3<T> surfgrad, vec3<T> normal) {
  const raster::Fragment<T>& f = point.fragment;
  if (!point.placement.relative_from_screen) {
    // A raster over the surface: its pixels stay over their own points, so that the point rises as the
    // height does.
    return {base.sigma_x + dot(base.sigma_x, surfgrad) * base.normal,
            base.sigma_y + dot(base.sigma_y, surfgrad) * base.normal};
  }
  vec3<T> plane = normal;
  if (layer.reflect) {
    const T along = dot(f.to_viewer, normal);
    const vec3<T> reflected = normal - (along + along) * f.to_viewer; // section 2.11
    plane = select<T>(window.side * along < T(value_t<T>(0)), reflected, normal);
  }
  return screen_derivatives(f.position, plane, in_lanes<T>(*point.placement.relative_from_screen), f.raster.x,
                            f.raster.y);
}

/// Moves the point to the virtual surface and opens a pass on it. The sum is zero, as nothing comes
/// before it in its pass.
///
/// Where nobody looks, and where the base normal faces away from the viewer though the surface does not,
/// the point moves along the normal only, or not at all.
///
/// degenerate  (out) set where the texture coordinate or the change of the position has collapsed, or
///             there is no normal: nothing changes there
template <LaneScalar T>
void apply(const Parallax& layer, Point<T>& point, vec3<T>&, mask_t<T>& degenerate) {
  const T zero = T(value_t<T>(0));
  const vec3<T> none{zero, zero, zero};
  raster::Fragment<T>& f = point.fragment;
  const Window<T> window = window_of(layer, point);
  const Frame<T> frame = point.frame;
  degenerate = degenerate | !window.sound;

  // The search, from the base surface.
  const T along = window.side * dot(frame.normal, f.to_viewer);
  const mask_t<T> unseen = max_abs(f.to_viewer) == zero;
  const mask_t<T> seen = window.sound & (zero < along);
  vec2<T> dst = way_of(layer, frame, window, f.to_viewer, layer.limit_offset, seen);
  if (layer.limit_offset) dst = window.side * dst;
  const mask_t<T> from_below = seen & (window.displacement * window.side < zero);
  const Met<T> met =
      layer.occlusion ? first_met(layer, window, dst, from_below) : one_step(layer, window, dst);

  // There: position, texture coordinates, base normal.
  const vec2<T> v = screen_offset(window.uv.dst_dx, window.uv.dst_dy, met.way);
  const T rise = (met.height - constant<T>(layer.level)) * window.displacement;
  const vec3<T> displaced =
      surface_offset(frame, window.uv.dst_dx, window.uv.dst_dy, met.way) + rise * frame.normal;
  const vec3<T> move = select<T>(mask_t<T>(seen | (window.sound & unseen)), displaced, none);
  f.position = f.position + move;
  f.object_position = f.object_position + in_lanes<T>(point.placement.inverse_linear) * move;
  for (raster::UvFragment<T>& uv : coordinates_of(f))
    uv.st = select<T>(seen, uv.st + saturated(v.x * uv.dst_dx) + saturated(v.y * uv.dst_dy), uv.st);
  raster::UvFragment<T>& own = f.uvs[static_cast<std::size_t>(layer.relief.texture.slot)];
  own.st = window.uv.st + met.way;
  const Frame<T> base = rebase_frame(frame, select<T>(seen, normal_after(layer, point, v), frame.normal));
  if (layer.self_shadow)
    point.sunlight = point.sunlight * sun_over_relief(layer, point, base, window, own.st, met.height);

  // The new frame. The relief is steep by the base surface's derivatives (section 2.5).
  vec3<T> surfgrad = none;
  if (layer.height_normal) {
    const vec2<T> dh = height_per_pixel(layer.relief, f);
    surfgrad = select<T>(window.sound,
                         saturated(from_height_derivative(base, saturated(window.displacement * dh))), none);
  }
  const vec3<T> normal = normalize_or_zero(base.normal - surfgrad);
  const ScreenDerivatives<T> dp = footprint_on_relief(layer, point, window, base, surfgrad, normal);
  for (raster::UvFragment<T>& uv : coordinates_of(f)) {
    // Texture coordinates are those of the base point below.
    const vec3<T> grad_s = from_height_derivative(base, vec2<T>{uv.dst_dx.x, uv.dst_dy.x});
    const vec3<T> grad_t = from_height_derivative(base, vec2<T>{uv.dst_dx.y, uv.dst_dy.y});
    const TextureDerivatives<T> d = projected_derivatives(grad_s, grad_t, dp.dp_dx, dp.dp_dy);
    uv.dst_dx = select<T>(window.sound, saturated(d.dst_dx), uv.dst_dx);
    uv.dst_dy = select<T>(window.sound, saturated(d.dst_dy), uv.dst_dy);
    if (layer.displaced_footprint) {
      uv.footprint_dx = select<T>(window.sound, uv.dst_dx, uv.footprint_dx);
      uv.footprint_dy = select<T>(window.sound, uv.dst_dy, uv.footprint_dy);
    }
  }
  f.dp_dx = select<T>(window.sound, dp.dp_dx, f.dp_dx);
  f.dp_dy = select<T>(window.sound, dp.dp_dy, f.dp_dy);
  point.frame = rebase_frame(frame, normal, f.dp_dx, f.dp_dy);
  if (layer.height_normal) {
    point.first_pass = false;
  } else if (point.first_pass) {
    // Still the smooth surface: vertex frames follow its normal as MikkTSpace defines them.
    const T sign = select(dot(normal, f.normal) < zero, -T(value_t<T>(1)), T(value_t<T>(1)));
    f.normal = (sign * length(f.normal)) * normal;
  }
}

} // namespace surfgrad::engine
