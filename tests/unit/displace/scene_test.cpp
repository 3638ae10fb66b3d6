// A scene's displacement as jobs meet it.

#include "bake/bake.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "io/model_file.hpp"
#include "render/render.hpp"
#include "support/scenes.hpp"
#include "support/temporary_folder.hpp"
#include "support/worst.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace surfgrad::displace {
namespace {

using test::scene_of;
using testing::HasSubstr;

stack::Displace noise_of(double height) {
  stack::Displace displace;
  displace.noise.frequency = 2;
  displace.height = height;
  return displace;
}

/// A map that is white everywhere: every vertex moves by the height.
void inflate(scene::Scene& scene, double height) {
  image::Image white = image::make_image(2, 2, 1, image::Depth::unorm8);
  for (float& texel : white.texels.floats()) texel = 1;
  test::add_image(scene, "white", std::move(white));
  scene.displace = noise_of(height);
  scene.displace->map.emplace();
  scene.displace->map->file.path = "white";
}

TEST(DisplacedScene, HoldsTheDisplacedMeshesAndNothingMoreToDo) {
  scene::Scene scene = scene_of(test::torus(12, 8));
  EXPECT_FALSE(displaced(scene));
  scene.displace = noise_of(0.1);
  scene.displace->subdivide = 2;
  const std::optional<DisplacedScene> done = displaced(scene);
  ASSERT_TRUE(done);
  EXPECT_FALSE(done->scene.displace);
  EXPECT_EQ(done->triangles, 12u * 8 * 2 * 16);
  EXPECT_EQ(done->vertices, done->scene.meshes[0].positions.size());
  EXPECT_EQ(done->scene.meshes[0].rest_positions.size(), done->vertices);
  EXPECT_LT(done->lowest, -0.01);
  EXPECT_GT(done->highest, 0.01);
  EXPECT_EQ(done->scene.objects.size(), 1u);
}

TEST(DisplacedScene, FinerBumpsStayWhereTheyWereOnTheSurface) {
  scene::Scene scene = scene_of(test::sphere_band(64, 32));
  stack::NoiseLayer layer;
  layer.noise.frequency = 4;
  layer.common.scale = 0.06;
  scene.materials[0].layers = {layer};
  // Texels of at most a seventh of a cell, so that no noise fades, on the larger sphere either.
  const auto map = [&] { return bake::bake(scene, {256, 128, bake::Space::object}).map; };
  const image::Image before = map();
  scene.materials[0].layers.clear();
  const image::Image plain = map();
  scene.materials[0].layers = {layer};
  inflate(scene, 0.5);
  const image::Image after = map();
  double bumps = 0;
  {
    test::Worst worst("bumps on the inflated sphere");
    for (std::size_t i = 0; i < before.texels.size(); ++i) {
      // An inflated sphere has the sphere's normals; float normals and positions, seen through slopes of 0.3
      // at 4 cells a unit.
      worst.add(double(after.texels[i]), double(before.texels[i]), 2e-6, static_cast<long>(i));
      bumps = std::max(bumps, double(std::abs(before.texels[i] - plain.texels[i])));
    }
  }
  EXPECT_GT(bumps, 0.05);
}

TEST(DisplacedScene, RenderShowsAndFramesTheDisplacedMesh) {
  scene::Scene scene = scene_of(test::torus(48, 24));
  scene.camera.pitch_deg = 90; // onto the hole
  const render::Options look{64, 64, 1, render::Aov::base_normal};
  const std::int64_t before = render::render(scene, look).covered;
  inflate(scene, 0.5); // nearly closes it: a tube of radius 0.9 around a ring of radius 1
  const render::Picture picture = render::render(scene, look);
  EXPECT_GT(double(picture.covered), 1.1 * double(before));
  for (int i = 0; i < 64; ++i)
    for (const auto& [x, y] : {std::pair{i, 0}, {i, 63}, {0, i}, {63, i}})
      EXPECT_EQ(picture.image.at(x, y, 2), 0) << x << ", " << y << " is cut off";
}

TEST(DisplacedScene, BakeShowsTheDisplacedMesh) {
  scene::Scene scene = scene_of(test::torus(32, 16));
  const image::Image flat = bake::bake(scene, {16, 16, bake::Space::object}).map;
  scene.displace = noise_of(0.2);
  const image::Image baked = bake::bake(scene, {16, 16, bake::Space::object}).map;
  double most = 0;
  for (std::size_t i = 0; i < flat.texels.size(); ++i)
    most = std::max(most, double(std::abs(flat.texels[i] - baked.texels[i])));
  EXPECT_GT(most, 0.05);
}

TEST(DisplacedScene, ComesBackFromItsFile) {
  scene::Scene scene = scene_of(test::torus(24, 12));
  scene.displace = noise_of(0.1);
  const scene::Scene done = displaced(scene)->scene;
  const test::TemporaryFolder folder;
  for (const char* name : {"a.glb", "a.gltf"}) {
    io::write_model(folder.path() / name,
                    {done.meshes, {{"object", 0, done.objects[0].world_from_object}}, {{.name = "test"}}});
    const mesh::TriangleMesh read = io::read_model(folder.path() / name).meshes.at(0);
    ASSERT_EQ(read.positions.size(), done.meshes[0].positions.size());
    for (std::size_t i = 0; i < read.positions.size(); ++i) {
      EXPECT_EQ(max_abs(read.positions[i] - done.meshes[0].positions[i]), 0);
      EXPECT_EQ(max_abs(read.normals[i] - done.meshes[0].normals[i]), 0);
    }
    EXPECT_EQ(read.triangles, done.meshes[0].triangles);
  }
}

std::string error_of(const scene::Scene& scene) {
  try {
    (void)displaced(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(DisplacedScene, TooManyTrianglesAreRefusedBeforeTheyAreMade) {
  scene::Scene scene = scene_of(test::plane(64)); // 8192 triangles
  scene.source = "s.json";
  scene.displace = noise_of(1);
  scene.displace->subdivide = 6;
  scene.displace->subdivide_line = 4;
  EXPECT_EQ(error_of(scene), "s.json:4: displace.subdivide: is 6: the 8192 triangles would become 33554432; "
                             "expected 5 at most, for 16777216 triangles");
}

TEST(DisplacedScene, HeightsBeyondFloatAreRefused) {
  scene::Scene scene = scene_of(test::plane(4));
  scene.displace = noise_of(1e12);
  scene.displace->level = -1e12;
  EXPECT_EQ(error_of(scene), "no error"); // 1e24
  scene.displace->noise = {.function = stack::NoiseKind::turbulence,
                           .octaves = 16, // sums above 1, which their power makes huge
                           .lacunarity = 1.7,
                           .gain = 1,
                           .power = 1e12,
                           .offset = {0.3, 0.2, 0.1}};
  EXPECT_THAT(error_of(scene), HasSubstr("displace: moves vertices beyond what numbers can hold"));
}

TEST(DisplacedScene, ProgressRisesToOneAndCanStop) {
  scene::Scene scene = scene_of(test::torus(64, 64));
  scene.displace = noise_of(0.1);
  double last = 0;
  (void)displaced(scene, {.progress = [&](double fraction) {
                    EXPECT_GE(fraction, last);
                    last = fraction;
                    return true;
                  }});
  EXPECT_EQ(last, 1);
  EXPECT_THROW((void)displaced(scene, {.progress = [](double) { return false; }}), Cancelled);
}

} // namespace
} // namespace surfgrad::displace
