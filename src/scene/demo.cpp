#include "scene/demo_maps.hpp"
#include "scene/scene.hpp"

#include <surfgrad/trigonometry.hpp>

namespace surfgrad::scene {
namespace {

/// A torus about the y axis. UV set 0 unwraps it once over [0, 1]^2, right for baking; set 1 is the
/// same turned into a helix, sheared and repeated, as a second unwrap for tiling detail would be.
mesh::TriangleMesh torus() {
  constexpr int around = 128; // segments of the ring
  constexpr int across = 64;  // segments of the tube
  constexpr double ring_radius = 1.0;
  constexpr double tube_radius = 0.45;
  mesh::TriangleMesh mesh;
  mesh.uv_sets.resize(2);
  for (int j = 0; j <= across; ++j)
    for (int i = 0; i <= around; ++i) {
      const double s = static_cast<double>(i) / around;
      const double t = static_cast<double>(j) / across;
      // A whole turn is none: the last column and row repeat the first exactly, no crack.
      const SinCos<double> u = sin_cos_turns(s);
      const SinCos<double> v = sin_cos_turns(t);
      const vec3<double> n{v.cos * u.sin, v.sin, v.cos * u.cos};
      const vec3<double> ring{u.sin, 0, u.cos};
      const vec3<double> p = ring_radius * ring + tube_radius * n;
      const auto narrow = [](vec3<double> w) {
        return vec3<float>{static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
      };
      mesh.positions.push_back(narrow(p));
      mesh.normals.push_back(narrow(n));
      mesh.uv_sets[0].push_back({static_cast<float>(s), static_cast<float>(t)});
      mesh.uv_sets[1].push_back({static_cast<float>(12 * s + 2 * t), static_cast<float>(5 * t - s)});
    }
  const auto vertex = [](int i, int j) { return static_cast<std::uint32_t>(j * (around + 1) + i); };
  for (int j = 0; j < across; ++j)
    for (int i = 0; i < around; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return mesh;
}

} // namespace

Scene demo_scene() {
  Scene scene;
  scene.meshes.push_back(torus());
  scene.objects.push_back({"torus", 0, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
  scene.images["demo/plates"] = std::make_shared<image::Image>(plates_normal_map(1024));
  scene.images["demo/weave"] = std::make_shared<image::Image>(weave_normal_map(512));
  scene.images["demo/stripes"] = std::make_shared<image::Image>(stripes_mask(512));

  stack::NormalMapLayer plates;
  plates.common.key = "demo plates";
  plates.map.file.path = "demo/plates";
  plates.map.tile = {4, 2};

  stack::NormalMapLayer weave;
  weave.common.key = "demo weave";
  weave.common.blend = stack::Blend::mix;
  weave.common.mask.emplace();
  weave.common.mask->file.path = "demo/stripes";
  weave.common.mask->tile = {3, 1};
  weave.map.file.path = "demo/weave";
  weave.map.uv = 1;
  weave.basis = stack::Basis::derived;

  stack::NormalMapLayer grain = weave; // fine detail on what the first pass made
  grain.common.key = "demo grain";
  grain.common.blend = stack::Blend::add;
  grain.common.mask.reset();
  grain.common.scale = 0.12;
  grain.map.tile = {3, 3};
  grain.map.rotate_deg = 30;

  stack::NoiseLayer dents; // a function of space: no texture coordinate
  dents.common.key = "demo dents";
  dents.common.scale = -0.03;
  dents.noise.function = stack::NoiseKind::turbulence;
  dents.noise.frequency = 4;
  dents.noise.power = 3;

  scene.materials.push_back(
      {"demo", stack::BackFaces::flip, {plates, weave, stack::ResolveLayer{}, grain, dents}});
  scene.camera.pitch_deg = 35;
  return scene;
}

} // namespace surfgrad::scene
