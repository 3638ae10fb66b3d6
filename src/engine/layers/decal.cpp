#include "engine/layers/decal.hpp"

#include "engine/compiler.hpp"

#include <surfgrad/trigonometry.hpp>

#include <algorithm>
#include <cmath>

namespace surfgrad::engine {
namespace {

/// Axes of an image and what its sizes are multiplied by.
struct Upright {
  vec3<double> origin{};
  vec3<double> s, t, outward;
  vec3<double> scale{1, 1, 1};
};

/// The image upright: its t as near to +y as the direction lets it; where that is vertical, its s along +x.
Upright upright(vec3<double> direction) {
  const vec3<double> outward = -normalize_or_zero(direction);
  // Nearer than this to the vertical, rounding would turn the image.
  constexpr double vertical = 1e-9;
  vec3<double> s = cross(vec3<double>{0, 1, 0}, outward);
  s = max_abs(s) < vertical ? vec3<double>{1, 0, 0} : s;
  s = normalize_or_zero(s - dot(s, outward) * outward);
  return {.s = s, .t = cross(outward, s), .outward = outward};
}

Upright from_transform(const std::array<double, 16>& m) {
  const vec3<double> x{m[0], m[1], m[2]};
  const vec3<double> y{m[4], m[5], m[6]};
  const vec3<double> z{m[8], m[9], m[10]};
  const vec3<double> outward = normalize_or_zero(z);
  // The columns are perpendicular to rounding only.
  const vec3<double> s = normalize_or_zero(x - dot(x, outward) * outward);
  const vec3<double> t = cross(outward, s);
  return {.origin = {m[12], m[13], m[14]},
          .s = s,
          .t = dot(t, y) < 0 ? -t : t,
          .outward = outward,
          .scale = {length(x), length(y), length(z)}};
}

Upright upright_of(const stack::DecalPlacement& placement) {
  if (placement.transform) return from_transform(*placement.transform);
  Upright axes = upright(placement.direction);
  axes.origin = placement.position;
  const vec2<double> turn = Compiler::rotation(placement.roll_deg);
  const vec3<double> s = axes.s;
  axes.s = turn.x * s + turn.y * axes.t;
  axes.t = turn.x * axes.t - turn.y * s;
  return axes;
}

bool is_projected_along_z(stack::DecalShape shape) {
  return shape == stack::DecalShape::cone || shape == stack::DecalShape::wedge;
}

Decal decal_of(const stack::DecalLayer& layer, const stack::DecalInstance& instance) {
  const Upright axes = upright_of(instance);
  const double scale = axes.scale.x; // of all axes, but for a box
  Decal decal;
  decal.frame = {axes.origin, axes.s, axes.t,
                 is_projected_along_z(layer.shape) ? -axes.outward : axes.outward};
  decal.outward = axes.outward;
  decal.half_size = 0.5 * vec3<double>{axes.scale.x * instance.size.x, axes.scale.y * instance.size.y,
                                       axes.scale.z * instance.size.z};
  const SinCos<double> half_angle = sin_cos_turns(instance.angle_deg / 720);
  decal.tan_half_angle = half_angle.sin / half_angle.cos;
  decal.depth = scale * instance.depth;
  decal.radius = scale * instance.radius;
  decal.half_length = 0.5 * scale * instance.length;
  decal.scale = instance.scale.value_or(layer.common.scale);
  decal.opacity = instance.opacity.value_or(layer.common.opacity);
  decal.blend = instance.blend.value_or(layer.blend);
  return decal;
}

vec3<double> magnitudes(vec3<double> v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

} // namespace

Bounds bounds_of(const Decal& decal, stack::DecalShape shape) {
  // The box of the decal's own frame: its centre and half its edges.
  vec3<double> centre = decal.frame.origin;
  vec3<double> half = decal.half_size;
  switch (shape) {
  case stack::DecalShape::box:
    break;
  case stack::DecalShape::sphere:
    half = {decal.radius, decal.radius, decal.radius};
    break;
  case stack::DecalShape::capsule:
    half = {decal.half_length + decal.radius, decal.radius, decal.radius};
    break;
  case stack::DecalShape::cone:
  case stack::DecalShape::wedge: {
    const double radius = decal.tan_half_angle * decal.depth;
    half = {radius + (shape == stack::DecalShape::wedge ? decal.half_length : 0.0), radius,
            0.5 * decal.depth};
    centre = centre + half.z * decal.frame.axis_z;
    break;
  }
  }
  const vec3<double> reach = half.x * magnitudes(decal.frame.axis_x) +
                             half.y * magnitudes(decal.frame.axis_y) +
                             half.z * magnitudes(decal.frame.axis_z);
  // Whether a point lies inside is decided in float, by products of axes and distances.
  const double rounding =
      32 * epsilon_v<float> * (half.x + half.y + half.z) + 8 * epsilon_v<double> * max_abs(centre);
  const vec3<double> room = reach + vec3<double>{rounding, rounding, rounding};
  return {centre - room, centre + room};
}

Decals compiled(const stack::DecalLayer& layer, const Compiler& compiler) {
  Decals decals;
  decals.mask = compiler.mask(layer.common);
  decals.shape = layer.shape;
  if (layer.shape == stack::DecalShape::sphere || layer.shape == stack::DecalShape::capsule)
    decals.cube = compiler.maps().cube(layer.files);
  else
    decals.bumps = compiler.bump_map(layer.map, layer.files.at(0));
  decals.world = layer.space == stack::Space::world;
  decals.fade = layer.falloff;
  decals.gradient =
      layer.gradient == stack::ConeGradient::exact ? ConeGradient::exact : ConeGradient::scale_free;
  std::vector<Bounds> bounds;
  for (const stack::DecalInstance& instance : layer.instances) {
    decals.decals.push_back(decal_of(layer, instance));
    bounds.push_back(bounds_of(decals.decals.back(), layer.shape));
  }
  decals.grid = DecalGrid(std::move(bounds));
  return decals;
}

namespace {

/// A decal's origin relative to the places' is rounded in their scalar, and before that in double.
///
/// far  how far places are from the origin, at most
double rounding(double far, vec3<double> origin, double epsilon) {
  return 16 * epsilon * far + 8 * epsilon_v<double> * max_abs(origin);
}

} // namespace

std::span<const std::uint32_t> decals_at(const DecalGrid& grid, const LanePlaces& places, vec3<double> origin,
                                         double epsilon) {
  std::array<Bounds, most_lanes> where;
  std::size_t count = 0;
  for (int i = 0; i < places.count; ++i) {
    const vec3<double> p{places.x[i], places.y[i], places.z[i]};
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
    const double side = rounding(max_abs(p), origin, epsilon);
    const vec3<double> room{side, side, side};
    where[count++] = {p + origin - room, p + origin + room};
  }
  return grid.search({where.data(), count});
}

std::span<const std::uint32_t> decals_about(const DecalGrid& grid, vec3<double> place, double half_edge,
                                            double pixel, vec3<double> origin, double epsilon) {
  // The distances of lanes have rounded too, by less than places do.
  const double side = half_edge + rounding(max_abs(place) + half_edge, origin, epsilon);
  const vec3<double> room{side, side, side};
  return grid.near({place + origin - room, place + origin + room}, decal_reach * pixel);
}

} // namespace surfgrad::engine
