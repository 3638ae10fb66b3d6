#pragma once

/// Images, layers and fragments to try a program on, without files, meshes or rasters.

#include "engine/compose.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/images.hpp"

#include <filesystem>
#include <map>
#include <utility>
#include <vector>

namespace surfgrad::engine {

// Compiled once, in compositions.cpp: each is all layer kernels.
extern template Composition<double> compose(const Program&, const raster::Fragment<double>&, BackFaces,
                                            const Placement&);
extern template Composition<float> compose(const Program&, const raster::Fragment<float>&, BackFaces,
                                           const Placement&);
extern template Composition<simd::EmulatedFloat>
compose(const Program&, const raster::Fragment<simd::EmulatedFloat>&, BackFaces, const Placement&);

} // namespace surfgrad::engine

namespace surfgrad::engine::test {

using surfgrad::test::Random;

/// Compiles layers whose files are images in memory.
class Lab {
 public:
  void add(const std::filesystem::path& name, image::Image image) { images_[name] = std::move(image); }
  [[nodiscard]] const std::map<std::filesystem::path, image::Image>& images() const { return images_; }

  [[nodiscard]] Program compile(const std::vector<stack::Layer>& layers) const {
    std::vector<raster::UvSlot> slots{{0, true}, {1, true}};
    collect_uv_slots(layers, slots);
    MapLibrary maps(
        [this](const std::filesystem::path& file) -> const image::Image& { return images_.at(file); });
    return engine::compile(layers, slots, maps);
  }

 private:
  std::map<std::filesystem::path, image::Image> images_{};
};

inline stack::NormalMapLayer normal_layer(const char* map, int uv = 0,
                                          stack::Basis basis = stack::Basis::mikktspace) {
  stack::NormalMapLayer layer;
  layer.map.file.path = map;
  layer.map.uv = uv;
  layer.basis = basis;
  return layer;
}

inline stack::DerivativeMapLayer derivative_layer(const char* map, int uv = 0,
                                                  stack::Basis basis = stack::Basis::mikktspace) {
  stack::DerivativeMapLayer layer;
  layer.map.file.path = map;
  layer.map.uv = uv;
  layer.basis = basis;
  return layer;
}

inline stack::HeightMapLayer height_layer(const char* map, double height = 1,
                                          stack::HeightMode mode = stack::HeightMode::physical) {
  stack::HeightMapLayer layer;
  layer.map.file.path = map;
  layer.height = height;
  layer.mode = mode;
  return layer;
}

inline stack::ObjectNormalMapLayer object_layer(const char* map, stack::Space space = stack::Space::object) {
  stack::ObjectNormalMapLayer layer;
  layer.map.file.path = map;
  layer.space = space;
  return layer;
}

inline stack::PlanarLayer planar_layer(const char* map, PlaneAxis axis,
                                       stack::Content content = stack::Content::normal) {
  stack::PlanarLayer layer;
  layer.file.path = map;
  layer.axis = axis;
  layer.map.content = content;
  return layer;
}

/// maps  one for every plane, or one for each
inline stack::TriplanarLayer
triplanar_layer(const std::vector<const char*>& maps,
                stack::TriplanarContent content = stack::TriplanarContent::normal) {
  stack::TriplanarLayer layer;
  for (const char* map : maps) layer.files.push_back({map});
  layer.map.content = content;
  return layer;
}

inline stack::DecalLayer decal_layer(const char* map, stack::DecalShape shape = stack::DecalShape::box) {
  stack::DecalLayer layer;
  layer.files = {{.path = map}};
  layer.shape = shape;
  return layer;
}

inline stack::ParallaxLayer parallax_layer(const char* map, double height) {
  stack::ParallaxLayer layer;
  layer.map.file.path = map;
  layer.height = height;
  return layer;
}

inline stack::Mask mask_of(const char* map, stack::MaskChannel channel = stack::MaskChannel::r) {
  stack::Mask mask;
  mask.file.path = map;
  mask.channel = channel;
  return mask;
}

/// A fragment as a rasteriser would make it, at any place, turn and scale, with two UV sets. Tangents
/// are perpendicular to the normal, as at a vertex.
inline raster::Fragment<double> random_fragment(Random& random) {
  raster::Fragment<double> f{};
  f.raster = 100.0 * random.vector2(0, 1);
  f.position = random.vector3();
  f.object_position = random.vector3();
  const mat3<double> r = random.rotation(); // rows: two directions in the surface, its normal
  f.normal = random.uniform(0.5, 1) * normalize_or_zero(r.z + 0.2 * random.vector3());
  const double pixel = random.magnitude(1e-3, 1e-1);
  f.dp_dx = pixel * (r.x + 0.3 * random.uniform() * r.y);
  f.dp_dy = pixel * (random.uniform(0.4, 1) * r.y + 0.3 * random.uniform() * r.x);
  f.dn_dx = 0.05 * random.vector3();
  f.dn_dy = 0.05 * random.vector3();
  f.to_viewer = normalize_or_zero(f.normal + 0.4 * random.vector3());
  f.front_facing = true;
  for (std::size_t s = 0; s < 2; ++s) {
    raster::UvFragment<double>& uv = f.uvs[s];
    uv.st = random.vector2(-1, 2);
    uv.dst_dx = {0.02 * random.uniform(0.3, 1), 0.02 * random.uniform(-0.2, 0.2)};
    uv.dst_dy = {0.02 * random.uniform(-0.2, 0.2), 0.02 * random.sign() * random.uniform(0.3, 1)};
    uv.footprint_dx = uv.dst_dx;
    uv.footprint_dy = uv.dst_dy;
    uv.tangent = random.uniform(0.5, 1) * normalize_or_zero(cross(f.normal, random.vector3()));
    uv.sign = random.sign();
  }
  return f;
}

/// The same as between vertices, where interpolated tangents lean towards the normal.
inline raster::Fragment<double> leaning_fragment(Random& random) {
  raster::Fragment<double> f = random_fragment(random);
  for (raster::UvFragment<double>& uv : f.uvs) uv.tangent = uv.tangent + random.uniform(-0.1, 0.1) * f.normal;
  return f;
}

inline constexpr mat3<double> identity{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// An object with this linear transform, at the world's origin.
inline Placement placed(const mat3<double>& m) {
  return place({{m.x.x, m.x.y, m.x.z, 0}, {m.y.x, m.y.y, m.y.z, 0}, {m.z.x, m.z.y, m.z.z, 0}, {0, 0, 0, 1}},
               {0, 0, 0});
}

inline Composition<double> composed(const Program& program, const raster::Fragment<double>& fragment,
                                    BackFaces back_faces = BackFaces::same,
                                    const mat3<double>& world_from_object = identity) {
  return compose(program, fragment, back_faces, placed(world_from_object));
}

/// One layer of every kind, each with a map of its own; "mask" weighs the second.
inline std::vector<stack::Layer> one_of_each(Lab& lab, Random& random) {
  using surfgrad::test::random_normal_map;
  lab.add("a", random_normal_map(random, 16, 16, 0.5));
  lab.add("b", random_normal_map(random, 8, 16, 0.5));
  lab.add("c", surfgrad::test::random_image(random, 16, 8, 3));
  lab.add("d", random_normal_map(random, 16, 16, 0.5));
  lab.add("mask", surfgrad::test::random_image(random, 8, 8, 4));
  stack::NormalMapLayer b = normal_layer("b", 1, stack::Basis::derived);
  b.common.scale = -0.7;
  b.common.mask = mask_of("mask", stack::MaskChannel::g);
  b.map.rotate_deg = 20;
  stack::ObjectNormalMapLayer c = object_layer("c");
  c.common.opacity = 0.2;
  stack::ObjectNormalMapLayer d = object_layer("d", stack::Space::world);
  d.common.scale = 0.1;
  stack::NoiseLayer e;
  e.noise.function = stack::NoiseKind::turbulence;
  e.noise.frequency = 3;
  e.noise.power = 2;
  e.common.scale = 0.2;
  lab.add("slopes", surfgrad::test::random_image(random, 8, 8, 2));
  lab.add("heights", surfgrad::test::random_image(random, 16, 8, 1));
  stack::HeightMapLayer smooth = height_layer("heights", 0.02);
  smooth.taps = stack::Taps::bicubic;
  smooth.map.wrap = stack::Wrap::mirror;
  stack::HeightMapLayer of_object = height_layer("heights", -0.02);
  of_object.units = stack::Units::object;
  of_object.taps = stack::Taps::one;
  of_object.map.uv = 1;
  stack::HeightMapLayer scale_free = height_layer("heights", 0.02, stack::HeightMode::scale_free);
  scale_free.taps = stack::Taps::bicubic;
  scale_free.map.wrap = stack::Wrap::mirror;
  stack::PlanarLayer planar = planar_layer("a", PlaneAxis::y, stack::Content::height);
  planar.space = stack::Space::world;
  planar.map.height = 0.05;
  planar.map.tile = {2, -1};
  stack::TriplanarLayer triplanar = triplanar_layer({"a", "b", "d"});
  triplanar.common.mask = mask_of("mask");
  triplanar.map.rotate_deg = -50;
  stack::TriplanarLayer of_normals = triplanar_layer({"c"}, stack::TriplanarContent::object_normal);
  of_normals.common.opacity = 0.1;
  // Most fragments lie within.
  stack::DecalLayer box = decal_layer("a");
  box.instances[0].size = {3, 4, 2.5};
  box.instances[0].direction = {1, -2, 0.5};
  box.common.mask = mask_of("mask");
  lab.add("cube", surfgrad::test::random_image(random, 24, 4, 3));
  stack::DecalLayer sphere = decal_layer("cube", stack::DecalShape::sphere);
  sphere.space = stack::Space::object;
  sphere.instances[0].radius = 2;
  sphere.instances.push_back(sphere.instances[0]);
  sphere.instances[1].position = {1, 0.5, 0};
  sphere.common.scale = 0.1;
  return {normal_layer("a"),
          b,
          c,
          d,
          derivative_layer("slopes"),
          smooth,
          of_object,
          scale_free,
          e,
          planar,
          triplanar,
          of_normals,
          box,
          sphere};
}

} // namespace surfgrad::engine::test
