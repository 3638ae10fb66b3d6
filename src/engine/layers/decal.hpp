#pragma once

#include "engine/bump_map.hpp"
#include "engine/decal_grid.hpp"
#include "engine/layers/influence.hpp"
#include "image/cube_map.hpp"
#include "simd/lane.hpp"
#include "stack/words.hpp"

#include <surfgrad/decal.hpp>
#include <surfgrad/resolve.hpp>

#include <limits>
#include <span>

namespace surfgrad::engine {

/// One decal among those that share a map. Sizes as the core takes them; those of other shapes are unused.
struct Decal {
  DecalFrame<double> frame{}; ///< axis_z the way a cone or wedge projects, for other shapes against it
  vec3<double> outward{};     ///< against the way it projects: the normal of a flat decal
  vec3<double> half_size{};
  double tan_half_angle = 0;
  double depth = 0;
  double radius = 0;
  double half_length = 0;
  double scale = 1;
  double opacity = 1;
  stack::DecalBlend blend = stack::DecalBlend::add;
};

/// The decals of a layer, in order, and where in space they are.
struct Decals {
  std::optional<Texture> mask{};
  stack::DecalShape shape = stack::DecalShape::box;
  BumpMap bumps{};                              ///< box, cone, wedge
  std::shared_ptr<const image::CubeMap> cube{}; ///< sphere, capsule
  bool world = true;                            ///< else in the object's space
  double fade = 0;
  ConeGradient gradient = ConeGradient::exact;
  std::vector<Decal> decals{};
  DecalGrid grid{};
};

/// Box around the part of space that a decal acts on, with room for the rounding of its tests.
[[nodiscard]] Bounds bounds_of(const Decal& decal, stack::DecalShape shape);

/// Where the surface is, in object space, or in world space relative to the placement's origin; and the
/// pixel's footprint there. Unlike in_space this follows parallax and displacement: a decal meets the
/// surface where it lies.
template <Scalar T>
[[nodiscard]] SpacePoint<T> surface_in_space(const Point<T>& point, bool world) {
  const raster::Fragment<T>& f = point.fragment;
  if (world) return {f.position, f.dp_dx, f.dp_dy, point.placement.origin};
  const mat3<T> inverse = in_lanes<T>(point.placement.inverse_linear);
  const mat4<double>& m = point.placement.world_from_object;
  const vec3<T> origin = in_lanes<T>(vec3<double>{m.x.w, m.y.w, m.z.w} - point.placement.origin);
  return {inverse * (f.position - origin), inverse * f.dp_dx, inverse * f.dp_dy};
}

namespace detail {

/// What a decal adds at a point, in the space of the decals. Zero outside; nothing but `inside` is set where
/// no lane is inside.
template <class T>
struct DecalBump {
  vec3<T> gradient; ///< volume gradient of its bumps
  vec3<T> outward;  ///< the normal that a flat decal has there
  T falloff;
  mask_t<T> inside;
  mask_t<T> degenerate; ///< inside, but there is no direction
};

template <LaneScalar T>
[[nodiscard]] DecalBump<T> nowhere(mask_t<T> inside) {
  const T zero = T(value_t<T>(0));
  return {{zero, zero, zero}, {zero, zero, zero}, zero, inside, inside};
}

template <LaneScalar T>
[[nodiscard]] DecalBump<T> image_bump(const Decals& layer, const Decal& decal,
                                      const DecalProjection<T>& projection, const SpacePoint<T>& at) {
  if (!any(projection.inside)) return nowhere<T>(projection.inside);
  const auto footprint = projected_derivatives(projection.grad_s, projection.grad_t, at.dp_dx, at.dp_dy);
  const vec2<T> d =
      saturated(derivative(layer.bumps, projection.texture_coordinate, footprint.dst_dx, footprint.dst_dy));
  const bool heights = layer.bumps.heights;
  const mask_t<T> never = T(value_t<T>(1)) < T(value_t<T>(0));
  return {decal_gradient(d, heights ? projection.grad_s : projection.axis_s,
                         heights ? projection.grad_t : projection.axis_t),
          in_lanes<T>(decal.outward), projection.falloff, projection.inside, never};
}

template <LaneScalar T>
[[nodiscard]] DecalBump<T> cube_bump(const Decals& layer, const DecalFrame<T>& frame,
                                     const DecalDirection<T>& direction, vec3<T> from_centre,
                                     const SpacePoint<T>& at) {
  if (!any(direction.inside)) return nowhere<T>(direction.inside);
  const auto in_decal = [&](vec3<T> v) {
    const vec3<T> across = v - dot(v, direction.unchanging) * direction.unchanging;
    return vec3<T>{dot(across, frame.axis_x), dot(across, frame.axis_y), dot(across, frame.axis_z)};
  };
  const vec3<T> q = in_decal(from_centre);
  const T lod = image::cube_lod(*layer.cube, q, in_decal(at.dp_dx), in_decal(at.dp_dy));
  const vec3<T> n = image::sample_cube(*layer.cube, direction.lookup, lod, direction.inside);
  const vec3<T> v = n.x * frame.axis_x + n.y * frame.axis_y + n.z * frame.axis_z;
  const T zero = T(value_t<T>(0));
  const mask_t<T> no_texel = max_abs(n) == zero;
  const mask_t<T> no_direction = max_abs(direction.direction) == zero;
  const mask_t<T> none = no_texel | no_direction;
  const vec3<T> g = decal_gradient_from_normal(direction, v);
  return {select<T>(none, vec3<T>{zero, zero, zero}, g), direction.direction, direction.falloff,
          direction.inside, mask_t<T>(direction.inside & none)};
}

template <LaneScalar T>
[[nodiscard]] DecalBump<T> bump_of(const Decals& layer, const Decal& decal, const SpacePoint<T>& at) {
  const DecalFrame<T> frame{in_lanes<T>(decal.frame.origin - at.origin), in_lanes<T>(decal.frame.axis_x),
                            in_lanes<T>(decal.frame.axis_y), in_lanes<T>(decal.frame.axis_z)};
  const T fade = constant<T>(layer.fade);
  const T tangent = constant<T>(decal.tan_half_angle);
  const T depth = constant<T>(decal.depth);
  const T radius = constant<T>(decal.radius);
  const T half_length = constant<T>(decal.half_length);
  switch (layer.shape) {
  case stack::DecalShape::cone:
    return image_bump(layer, decal, cone_decal(frame, at.position, tangent, depth, fade, layer.gradient), at);
  case stack::DecalShape::wedge:
    return image_bump(layer, decal,
                      wedge_decal(frame, at.position, half_length, tangent, depth, fade, layer.gradient), at);
  case stack::DecalShape::sphere:
    return cube_bump(layer, frame, sphere_decal(frame, at.position, radius, fade), at.position - frame.origin,
                     at);
  case stack::DecalShape::capsule: {
    const DecalDirection<T> direction = capsule_decal(frame, at.position, half_length, radius, fade);
    const vec3<T> d = at.position - frame.origin;
    const T along = max(-half_length, min(dot(d, frame.axis_x), half_length));
    return cube_bump(layer, frame, direction, d - along * frame.axis_x, at);
  }
  case stack::DecalShape::box:
    break;
  }
  return image_bump(layer, decal, box_decal(frame, at.position, in_lanes<T>(decal.half_size), fade), at);
}

/// What decals make of the sum so far, before the normal is used (section 2.9): the sum counts by a
/// factor, and one volume gradient waits to be projected. A lane without decals stays as it is.
template <class T>
struct DecalSum {
  T factor;
  vec3<T> gradient;
  mask_t<T> any;
};

template <LaneScalar T>
[[nodiscard]] DecalSum<T> no_decals() {
  const T zero = T(value_t<T>(0));
  return {T(value_t<T>(1)), {zero, zero, zero}, zero < zero};
}

template <LaneScalar T>
[[nodiscard]] vec3<T> projected(const Point<T>& point, bool world, const DecalSum<T>& decals, vec3<T> sum) {
  const vec3<T> g = from_gradient_in_space(point, world, decals.gradient);
  return select<T>(decals.any, saturated(decals.factor * sum + g), sum);
}

} // namespace detail

/// Applies some of a layer's decals.
///
/// which       their numbers, ascending: at least all that reach the point
/// at          surface_in_space
/// degenerate  (out) set where object space is wanted of an object whose transform has no inverse: no decal
///             is there. Set within a sphere or capsule where there is no direction from its centre, or
///             none in its map; the decal is flat there
template <LaneScalar T>
void apply(const Decals& layer, std::span<const std::uint32_t> which, const Point<T>& point,
           const SpacePoint<T>& at, vec3<T>& sum, mask_t<T>& degenerate) {
  const mask_t<T> lacking = lacks_space(point, layer.world); // no place to look from
  degenerate = degenerate | lacking;
  const T one = T(value_t<T>(1));
  T mask = one;
  bool met = false; // uniform: a decal has a lane inside
  detail::DecalSum<T> waiting = detail::no_decals<T>();
  for (const std::uint32_t i : which) {
    const Decal& decal = layer.decals[i];
    detail::DecalBump<T> bump = detail::bump_of(layer, decal, at);
    bump.inside = bump.inside & !lacking;
    if (!any(bump.inside)) continue;
    if (!met && layer.mask) mask = sample<1>(*layer.mask, point.fragment)[0];
    met = true;
    degenerate = degenerate | bump.degenerate;
    const T w = bump.falloff * mask * constant<T>(decal.opacity);
    if (decal.blend == stack::DecalBlend::replace) {
      // Of the direction only its part along the surface of the decal bends: no perspective term.
      const vec3<T> bent =
          saturated(constant<T>(decal.scale) * from_volume_gradient(bump.outward, bump.gradient));
      vec3<T> v = bump.outward - bent;
      if (!layer.world) v = transform_normal(in_lanes<T>(point.placement.linear), v);
      const vec3<T> g = from_perturbed_normal(point.frame.normal, v);
      const vec3<T> so_far = detail::projected(point, layer.world, waiting, sum);
      sum = select<T>(bump.inside, saturated((one - w) * so_far + w * g), sum);
      const detail::DecalSum<T> none = detail::no_decals<T>();
      waiting = {select(bump.inside, none.factor, waiting.factor),
                 select<T>(bump.inside, none.gradient, waiting.gradient),
                 mask_t<T>(waiting.any & !bump.inside)};
      continue;
    }
    const T keep = decal.blend == stack::DecalBlend::mix ? one - w : one;
    const vec3<T> gradient =
        saturated(keep * waiting.gradient + (w * constant<T>(decal.scale)) * bump.gradient);
    waiting = {select(bump.inside, keep * waiting.factor, waiting.factor),
               select<T>(bump.inside, gradient, waiting.gradient), mask_t<T>(waiting.any | bump.inside)};
  }
  if (met) sum = detail::projected(point, layer.world, waiting, sum);
}

/// Where the lanes of a point are, in the space of the decals.
struct LanePlaces {
  double x[most_lanes], y[most_lanes], z[most_lanes];
  int count;
};

/// The decals that may reach any of the lanes. Lanes that are nowhere (Inf, NaN) count for none.
///
/// origin   that the places are relative to
/// epsilon  of the scalar that the decals are met in
[[nodiscard]] std::span<const std::uint32_t> decals_at(const DecalGrid& grid, const LanePlaces& places,
                                                       vec3<double> origin, double epsilon);

/// The decals that may reach a cube about a place, by DecalGrid::near.
///
/// half_edge, pixel  of the cube, and about what a pixel measures there
/// origin, epsilon   as above
[[nodiscard]] std::span<const std::uint32_t> decals_about(const DecalGrid& grid, vec3<double> place,
                                                          double half_edge, double pixel, vec3<double> origin,
                                                          double epsilon);

/// Pixels that a tile of them extends. Lanes farther apart lie on unrelated parts of a surface.
inline constexpr int decal_reach = 64;

/// The decals that may reach a point, of any of its lanes.
///
/// at  surface_in_space
template <LaneScalar T>
[[nodiscard]] std::span<const std::uint32_t> decals_near(const Decals& layer, const SpacePoint<T>& at) {
  using V = value_t<T>;
  constexpr int lanes = lane_count<T>;
  const double epsilon = static_cast<double>(epsilon_v<T>);
  const vec3<V> first{lane(at.position.x, 0), lane(at.position.y, 0), lane(at.position.z, 0)};
  const vec3<T> away = at.position - vec3<T>{T(first.x), T(first.y), T(first.z)};
  // Inf and NaN stay in a sum.
  const T sum = abs(away.x) + abs(away.y) + abs(away.z);
  if (all(sum < T(std::numeric_limits<V>::infinity()))) {
    V distances[lanes];
    store(max_abs(away), distances);
    V half_edge = 0;
    for (int i = 0; i < lanes; ++i) half_edge = half_edge < distances[i] ? distances[i] : half_edge;
    const V pixel = lane(max(max_abs(at.dp_dx), max_abs(at.dp_dy)), 0);
    if (half_edge <= V(decal_reach) * pixel)
      return decals_about(
          layer.grid,
          {static_cast<double>(first.x), static_cast<double>(first.y), static_cast<double>(first.z)},
          static_cast<double>(half_edge), static_cast<double>(pixel), at.origin, epsilon);
  }
  LanePlaces places;
  places.count = lanes;
  const auto put = [](T a, double* to) {
    V values[lanes];
    store(a, values);
    for (int i = 0; i < lanes; ++i) to[i] = static_cast<double>(values[i]);
  };
  put(at.position.x, places.x);
  put(at.position.y, places.y);
  put(at.position.z, places.z);
  return decals_at(layer.grid, places, at.origin, epsilon);
}

/// Decals join the sum of the pass: their volume gradients are accumulated first and projected once.
template <LaneScalar T>
void apply(const Decals& layer, Point<T>& point, vec3<T>& sum, mask_t<T>& degenerate) {
  const SpacePoint<T> at = surface_in_space(point, layer.world);
  apply(layer, decals_near(layer, at), point, at, sum, degenerate);
}

} // namespace surfgrad::engine
