// The job around the bake: threads, progress, cancelling, what it refuses and what it counts.

#include "bake/bake.hpp"

#include "diagnostic/error.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tbb/global_control.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;

scene::Scene two_layers() {
  Random random(211);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(24, 12));
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, 32, 32));
  stack::NormalMapLayer derived = surfgrad::test::normal_layer("a");
  derived.basis = stack::Basis::derived;
  derived.map.tile = {3, -2};
  scene.materials[0].layers = {surfgrad::test::normal_layer("a"), derived};
  return scene;
}

TEST(BakeJob, GivesTheSameBytesForAnyNumberOfThreads) {
  const scene::Scene scene = two_layers();
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return bake(scene, {100, 150, Space::tangent});
  };
  const Baked one = run(1);
  for (const std::size_t threads : {2, 5}) {
    const Baked many = run(threads);
    EXPECT_EQ(one.map.texels, many.map.texels);
    EXPECT_EQ(one.covered, many.covered);
    EXPECT_EQ(one.clamped, many.clamped);
  }
}

TEST(BakeJob, ReportsProgressUpToOneAndStopsWhenAsked) {
  const scene::Scene scene = two_layers();
  std::vector<double> parts;
  Report report;
  report.progress = [&](double part) {
    parts.push_back(part);
    return true;
  };
  (void)bake(scene, {16, 40, Space::tangent}, report);
  ASSERT_FALSE(parts.empty());
  EXPECT_EQ(parts.back(), 1);
  report.progress = [](double) { return false; };
  EXPECT_THROW((void)bake(scene, {16, 40, Space::tangent}, report), Cancelled);
}

TEST(BakeJob, StopsBetweenTilesOfABand) {
  const scene::Scene scene = two_layers();
  int asked = 0;
  int bands = 0;
  Report report;
  report.progress = [&](double) { return ++asked < 3; };
  EXPECT_THROW((void)bake_bands(
                   scene, {2048, 32, Space::tangent}, [&](const image::Image&) { ++bands; }, report),
               Cancelled);
  EXPECT_EQ(asked, 3); // of 64 tiles
  EXPECT_EQ(bands, 0);
}

TEST(BakeJob, RefusesAMeshWithoutTextureCoordinatesOrWithNoneInTheUnitSquare) {
  scene::Scene scene = two_layers();
  scene.materials[0].layers.clear();
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = st + vec2<float>{5, 5};
  EXPECT_THROW((void)bake(scene, {16, 16, Space::tangent}), InputError);
  scene.meshes[0].uv_sets.clear();
  try {
    (void)bake(scene, {16, 16, Space::object});
    FAIL() << "a mesh without texture coordinates";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("mesh \"object\""), std::string::npos) << error.what();
  }
}

TEST(BakeJob, TellsWhereAMeshIsLaidOutThatTheMapDoesNotReach) {
  scene::Scene scene = two_layers();
  const auto problem_of = [&](vec2<float> move, float scale) -> std::string {
    scene::Scene moved = scene;
    for (vec2<float>& st : moved.meshes[0].uv_sets[0]) st = scale * st + move;
    try {
      (void)bake(moved, {16, 16, Space::tangent});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem_of({0, 0}, 1), "");
  const std::string other = problem_of({1, -2}, 1);
  EXPECT_NE(other.find("UV set 0 lies in the unit square from (1, -2) to (2, -1)"), std::string::npos)
      << other;
  EXPECT_NE(other.find("move its coordinates by (-1, 2)"), std::string::npos) << other;
  const std::string many = problem_of({3.5f, 0}, 2);
  EXPECT_NE(many.find("UV set 0 lies between (3.5, 0) and (5.5, 2)"), std::string::npos) << many;
  const std::string point = problem_of({0.5f, 0.5f}, 0);
  EXPECT_NE(point.find("no triangle has an area in the unit square of UV set 0"), std::string::npos) << point;
}

TEST(BakeJob, LaysTheMapOutInTheUvSetAskedFor) {
  scene::Scene scene = two_layers();
  auto& sets = scene.meshes[0].uv_sets;
  sets.push_back(sets[0]);
  for (vec2<float>& st : sets[1]) st = {0.9f - 0.7f * st.y, 0.1f + 0.8f * st.x}; // turned, part of the map
  const auto swapped = [&] {
    scene::Scene other = scene;
    std::swap(other.meshes[0].uv_sets[0], other.meshes[0].uv_sets[1]);
    for (stack::Layer& layer : other.materials[0].layers) std::get<stack::NormalMapLayer>(layer).map.uv = 1;
    return other;
  }();
  for (const Space space : {Space::tangent, Space::world}) {
    const Baked second = bake(scene, {.width = 60, .height = 60, .space = space, .uv_set = 1});
    EXPECT_EQ(second.map.texels, bake(swapped, {.width = 60, .height = 60, .space = space}).map.texels);
    EXPECT_LT(second.covered, 0.6 * 60 * 60);
  }
  try {
    (void)bake(scene, {.width = 8, .height = 8, .uv_set = 2});
    FAIL() << "a mesh without the UV set";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no texture coordinates (UV set 2)"), std::string::npos)
        << error.what();
  }
}

TEST(BakeJob, RefusesParallaxAndNamesTheLayer) {
  scene::Scene scene = two_layers();
  stack::ParallaxLayer parallax;
  parallax.common.key = "layers[2]";
  parallax.common.line = 7;
  parallax.map.file.path = "a";
  scene.materials[0].layers.push_back(parallax);
  scene.source = "stack.json";
  try {
    (void)bake(scene, {8, 8, Space::tangent});
    FAIL() << "a bake that looks from nowhere";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("stack.json:7: layers[2]: parallax depends on the viewer"),
              std::string::npos)
        << error.what();
  }
}

TEST(BakeJob, LeavesTexelsWithoutASurfaceFlatAndUncounted) {
  scene::Scene scene = two_layers();
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = 0.5f * st;
  const Baked baked = bake(scene, {20, 20, Space::tangent});
  EXPECT_EQ(baked.covered, 100);
  EXPECT_EQ(baked.map.at(15, 15, 0), 0.5f);
  EXPECT_EQ(baked.map.at(15, 15, 1), 0.5f);
  EXPECT_EQ(baked.map.at(15, 15, 2), 1);
}

TEST(BakeJob, PutsTexelsOfCutTilesWhereTheyBelong) {
  scene::Scene scene = two_layers();
  scene.materials[0].layers.clear(); // nothing is filtered: a texel shows its centre
  // The last tiles of 48 texels, and of three times as many, are cut in half.
  for (const auto& [width, height] : {std::pair{48, 48}, {32, 48}, {48, 32}}) {
    const Baked coarse = bake(scene, {width, height, Space::object});
    const Baked fine = bake(scene, {3 * width, 3 * height, Space::object});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c) // interpolated from other pixels of the triangles: a few roundings apart
          ASSERT_NEAR(coarse.map.at(x, y, c), fine.map.at(3 * x + 1, 3 * y + 1, c), 1e-6) << x << " " << y;
  }
}

TEST(BakeJob, CountsVanishedNormalsAndTangents) {
  scene::Scene scene = two_layers();
  for (vec3<float>& n : scene.meshes[0].normals) n = {0, 0, 0};
  const Baked bare = bake(scene, {20, 20, Space::tangent});
  EXPECT_EQ(bare.singular, 400); // nothing can decode a map without normals
  EXPECT_EQ(bare.degenerate, 400);
  for (std::size_t i = 0; i < bare.map.texels.size(); i += 3) {
    EXPECT_EQ(bare.map.texels[i], 0.5f);
    EXPECT_EQ(bare.map.texels[i + 2], 1.0f);
  }
  scene = two_layers();
  scene.meshes[0].tangent_spaces.resize(1);
  scene.meshes[0].tangent_spaces[0].corners.assign(3 * scene.meshes[0].triangles.size(), {0, 0, 0, 1});
  const Baked untwisted = bake(scene, {20, 20, Space::tangent});
  EXPECT_EQ(untwisted.singular, 400);
  EXPECT_EQ(untwisted.degenerate, 400);
}

TEST(BakeJob, CountsTrianglesThatTheMapDoesNotReach) {
  scene::Scene scene = two_layers();
  EXPECT_EQ(bake(scene, {8, 8, Space::tangent}).outside, 0);
  const std::uint32_t vertex = scene.meshes[0].triangles[0][0];
  scene.meshes[0].uv_sets[0][vertex].x += 3;
  std::int64_t sharing = 0;
  for (const auto& t : scene.meshes[0].triangles) sharing += std::count(t.begin(), t.end(), vertex);
  EXPECT_EQ(bake(scene, {8, 8, Space::tangent}).outside, sharing);
}

TEST(BakeJob, CountsNormalsBelowTheSurface) {
  // A world-space map that points down under half of a torus.
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::torus(24, 12));
  Random random(212);
  surfgrad::test::add_image(scene, "steep", surfgrad::test::random_normal_map(random, 64, 64, 20));
  stack::NormalMapLayer layer = surfgrad::test::normal_layer("steep");
  scene.materials[0].layers = {layer, stack::ResolveLayer{}, layer, stack::ResolveLayer{}, layer};
  const Baked baked = bake(scene, {64, 64, Space::tangent});
  EXPECT_GT(baked.clamped, 100);
  for (std::size_t i = 2; i < baked.map.texels.size(); i += 3) EXPECT_GT(baked.map.texels[i], 0.5f);
}

TEST(BakeJob, ShowsTheFrontOfMirroredTextureCoordinatesAndOneSidedMaterials) {
  scene::Scene scene = two_layers();
  const Baked flip = bake(scene, {20, 20, Space::world});
  for (const stack::BackFaces mode :
       {stack::BackFaces::same, stack::BackFaces::mirror, stack::BackFaces::cull}) {
    scene.materials[0].back_faces = mode;
    EXPECT_EQ(bake(scene, {20, 20, Space::world}).map.texels, flip.map.texels);
  }
}

TEST(BakeJob, WarnsAboutMapsThatPointIntoTheSurface) {
  scene::Scene scene = two_layers();
  surfgrad::test::add_image(scene, "a", surfgrad::test::constant_image(4, 4, {0.5, 0.6, 0.1}));
  std::vector<std::string> warnings;
  Report report;
  report.warning = [&](std::string_view text) { warnings.emplace_back(text); };
  (void)bake(scene, {8, 8, Space::tangent}, report);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].substr(0, 46), "a: 16 of 16 texels point into the surface (z <");
}

} // namespace
} // namespace surfgrad::bake
