#include "exported/sample.hpp"

#include "engine/program.hpp"
#include "exported/magnified.hpp"
#include "raster/tile_scan.hpp"
#include "render/camera.hpp"

#include <algorithm>

namespace surfgrad::shadergen::test {
namespace {

using Role = SurfaceMember::Role;
using raster::Fragment;
using surfgrad::test::Random;

/// A number as the device has it, too.
double rounded(double v) { return static_cast<float>(v); }
vec2<double> rounded(vec2<double> v) { return {rounded(v.x), rounded(v.y)}; }
vec3<double> rounded(vec3<double> v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }
vec4<double> rounded(vec4<double> v) { return {rounded(v.x), rounded(v.y), rounded(v.z), rounded(v.w)}; }
mat3<double> rounded(const mat3<double>& m) { return {rounded(m.x), rounded(m.y), rounded(m.z)}; }
mat4<double> rounded(const mat4<double>& m) {
  return {rounded(m.x), rounded(m.y), rounded(m.z), rounded(m.w)};
}

vec3<double> random_vector(Random& random, double size) { return rounded(random.vector3(-size, size)); }

engine::Placement rounded(engine::Placement p) {
  p.world_from_object = rounded(p.world_from_object);
  p.origin = rounded(p.origin);
  p.to_sun = rounded(p.to_sun);
  p.linear = rounded(p.linear);
  p.inverse_linear = rounded(p.inverse_linear);
  if (p.relative_from_screen) p.relative_from_screen = rounded(*p.relative_from_screen);
  return p;
}

Fragment<double> rounded(Fragment<double> f) {
  f.raster = rounded(f.raster);
  for (vec3<double>* v :
       {&f.position, &f.object_position, &f.to_viewer, &f.normal, &f.dp_dx, &f.dp_dy, &f.dn_dx, &f.dn_dy})
    *v = rounded(*v);
  for (raster::UvFragment<double>& uv : coordinates_of(f)) {
    for (vec2<double>* v : {&uv.st, &uv.dst_dx, &uv.dst_dy}) *v = rounded(*v);
    uv.footprint_dx = uv.dst_dx;
    uv.footprint_dy = uv.dst_dy;
    uv.tangent = rounded(uv.tangent);
  }
  return f;
}

Fragment<double> random_fragment(Random& random) {
  Fragment<double> f{};
  f.normal =
      rounded(random.uniform(0.5, 2) * normalize_or_zero(random_vector(random, 1) + vec3<double>{0, 0, 1.8}));
  const vec3<double> n = normalize_or_zero(f.normal);
  const vec3<double> u = normalize_or_zero(cross(n, random_vector(random, 1) + vec3<double>{1.5, 0, 0}));
  f.dp_dx = 0.01 * (u + 0.3 * random.uniform(-1, 1) * cross(n, u));
  f.dp_dy = 0.01 * (cross(n, u) + 0.3 * random.uniform(-1, 1) * u);
  f.position = random_vector(random, 1);
  f.object_position = random_vector(random, 1);
  f.front_facing = random.uniform(0, 1) < 0.5;
  f.slots = 2;
  for (raster::UvFragment<double>& uv : f.uvs) {
    uv.st = random.vector2(-2, 2);
    uv.dst_dx = 0.002 * vec2<double>{1, random.uniform(-0.4, 0.4)};
    uv.dst_dy = 0.002 * vec2<double>{random.uniform(-0.4, 0.4), -1};
    uv.tangent = u + 0.2 * random_vector(random, 1);
    uv.sign = random.sign();
  }
  return rounded(f);
}

/// Scales, shears and moves.
engine::Placement uneven_placement() {
  return engine::place({{1.25, 0.25, 0, 0.5}, {-0.125, 0.75, 0.5, -2}, {0.25, 0, 1.125, 1}, {0, 0, 0, 1}},
                       {0, 0, 0});
}

std::vector<double> columns_of(const mat3<double>& m) {
  return {m.x.x, m.y.x, m.z.x, m.x.y, m.y.y, m.z.y, m.x.z, m.y.z, m.z.z};
}
std::vector<double> columns_of(const mat4<double>& m) {
  const mat4<double> c = transpose(m);
  std::vector<double> all;
  for (const vec4<double>& v : {c.x, c.y, c.z, c.w}) all.insert(all.end(), {v.x, v.y, v.z, v.w});
  return all;
}

} // namespace

Samples random_samples(Random& random, int count) {
  Samples samples;
  samples.slots = {{0, true}, {1, true}};
  const engine::Placement placement = rounded(uneven_placement());
  for (int i = 0; i < count; ++i) samples.all.push_back({random_fragment(random), placement});
  return samples;
}

Sample with_finer_pixels(const Sample& sample, double times) {
  Sample finer = sample;
  const double share = 1 / times;
  Fragment<double>& f = finer.fragment;
  f.raster = times * f.raster;
  for (vec3<double>* v : {&f.dp_dx, &f.dp_dy, &f.dn_dx, &f.dn_dy}) *v = share * *v;
  for (raster::UvFragment<double>& uv : coordinates_of(f))
    for (vec2<double>* v : {&uv.dst_dx, &uv.dst_dy, &uv.footprint_dx, &uv.footprint_dy}) *v = share * *v;
  if (mat4<double>* m =
          finer.placement.relative_from_screen ? &*finer.placement.relative_from_screen : nullptr)
    for (vec4<double>* row : {&m->x, &m->y, &m->z, &m->w})
      *row = {share * row->x, share * row->y, row->z, row->w};
  return finer;
}

Samples samples_of(const scene::Scene& scene, int side, int picture) {
  Samples samples;
  const std::vector<stack::Layer>& layers = scene.materials[0].layers;
  engine::collect_uv_slots(layers, samples.slots);
  const render::Pinhole camera = render::place_camera(scene, side, side);
  std::vector<raster::Surface> surfaces;
  for (const scene::Object& object : scene.objects)
    surfaces.push_back(
        raster::place_mesh(scene.meshes[object.mesh], object.world_from_object, camera.eye, samples.slots));
  const auto projection = raster::Projection::camera(camera.screen_from_relative(side, side), camera.near);
  const raster::TileGrid grid(surfaces, projection, side, side, side, side);
  raster::TileScan scan;
  scan.scan(surfaces, projection, grid.tile(0, 0), grid.candidates(0, 0), {});
  const Fineness fineness(layers, scene);
  for (int i = 0; i < side * side; ++i) {
    const int owner = scan.owners()[static_cast<std::size_t>(i)];
    if (owner == raster::TileScan::nothing) continue;
    const raster::TileScan::Shown& shown = scan.shown()[static_cast<std::size_t>(owner)];
    Sample sample;
    sample.fragment = raster::make_fragment(surfaces[shown.id.surface], shown.id.triangle, shown.planes,
                                            i % side + 0.5, i / side + 0.5);
    sample.fragment.to_viewer = normalize_or_zero(-sample.fragment.position);
    sample.placement = engine::place(scene.objects[shown.id.surface].world_from_object, camera.eye);
    sample.placement.relative_from_screen = camera.relative_from_screen(side, side);
    if (scene.lights.sun) sample.placement.to_sun = normalize_or_zero(scene.lights.sun->direction);
    const double times = picture > 0 ? static_cast<double>(picture) / side : fineness.times(sample);
    const Sample finer = with_finer_pixels(sample, times);
    samples.all.push_back({rounded(finer.fragment), rounded(finer.placement)});
  }
  return samples;
}

std::vector<double> values_of(const SurfaceMember& member, const Sample& sample,
                              const std::vector<raster::UvSlot>& slots) {
  const auto three = [](vec3<double> v) { return std::vector<double>{v.x, v.y, v.z}; };
  const Fragment<double>& f = sample.fragment;
  const engine::Placement& p = sample.placement;
  const mat4<double>& m = p.world_from_object;
  const vec3<double> origin{m.x.w, m.y.w, m.z.w};
  const auto slot = std::find_if(slots.begin(), slots.end(),
                                 [&](const raster::UvSlot& s) { return s.uv_set == member.uv; });
  const raster::UvFragment<double>& uv =
      f.uvs[slot == slots.end() ? 0 : static_cast<std::size_t>(slot - slots.begin())];
  switch (member.role) {
  case Role::position:
    return three(f.position);
  case Role::normal:
    return three(f.normal);
  case Role::dp_dx:
    return three(f.dp_dx);
  case Role::dp_dy:
    return three(f.dp_dy);
  case Role::front_facing:
    return {f.front_facing ? 1.0 : 0.0};
  case Role::normal_is_absent:
    return {f.normal_is_absent ? 1.0 : 0.0};
  case Role::st:
    return {uv.st.x, uv.st.y};
  case Role::dst_dx:
    return {uv.dst_dx.x, uv.dst_dx.y};
  case Role::dst_dy:
    return {uv.dst_dy.x, uv.dst_dy.y};
  case Role::tangent:
    return {uv.tangent.x, uv.tangent.y, uv.tangent.z, uv.sign};
  case Role::object_position:
    return three(f.object_position);
  case Role::world_position:
    return three(p.linear * f.object_position + origin);
  case Role::world_from_object:
    return columns_of(p.linear);
  case Role::object_from_world:
    return columns_of(p.inverse_linear);
  case Role::object_origin:
    return three(origin - p.origin);
  case Role::world_origin:
    return three(p.origin);
  case Role::to_viewer:
    return three(f.to_viewer);
  case Role::to_sun:
    return three(p.to_sun);
  case Role::raster:
    return {f.raster.x, f.raster.y};
  case Role::dn_dx:
    return three(f.dn_dx);
  case Role::dn_dy:
    return three(f.dn_dy);
  case Role::relative_from_screen:
    return columns_of(p.relative_from_screen.value_or(mat4<double>{}));
  case Role::roughness:
    break; // the engine has none, and no comparison with it asks for any
  }
  return {};
}

std::vector<float> inputs_of(const Shader& shader, const Samples& samples) {
  std::vector<float> inputs;
  for (const Sample& sample : samples.all)
    for (const SurfaceMember& member : shader.surface)
      for (const double v : values_of(member, sample, samples.slots)) inputs.push_back(static_cast<float>(v));
  return inputs;
}

} // namespace surfgrad::shadergen::test
