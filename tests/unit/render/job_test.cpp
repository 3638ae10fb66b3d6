// The job around the picture: threads, progress, cancelling, counts.

#include "render/render.hpp"

#include "diagnostic/error.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <vector>

namespace surfgrad::render {
namespace {

scene::Scene bumpy() {
  surfgrad::test::Random random(271);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(24, 12));
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, 32, 32));
  stack::NormalMapLayer derived = surfgrad::test::normal_layer("a");
  derived.basis = stack::Basis::derived;
  derived.map.tile = {3, 2};
  scene.materials[0].layers = {surfgrad::test::normal_layer("a"), stack::ResolveLayer{}, derived};
  return scene;
}

TEST(RenderJob, GivesTheSameBytesForAnyNumberOfThreads) {
  const scene::Scene scene = bumpy();
  for (const Aov aov : {Aov::beauty, Aov::surfgrad}) {
    const auto run = [&](std::size_t threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      return render(scene, {60, 90, 2, aov});
    };
    const Picture one = run(1);
    EXPECT_GT(one.covered, 500);
    for (const std::size_t threads : {2, 5}) {
      const Picture many = run(threads);
      EXPECT_EQ(one.image.texels, many.image.texels);
      EXPECT_EQ(one.covered, many.covered);
    }
  }
}

TEST(RenderJob, ReportsProgressUpToOneAndStopsWhenAsked) {
  const scene::Scene scene = bumpy();
  std::vector<double> parts;
  Report report;
  report.progress = [&](double part) {
    parts.push_back(part);
    return true;
  };
  (void)render(scene, {16, 40, 1, Aov::normal}, report);
  ASSERT_FALSE(parts.empty());
  EXPECT_EQ(parts.back(), 1);
  report.progress = [](double) { return false; };
  EXPECT_THROW((void)render(scene, {16, 40, 1, Aov::normal}, report), Cancelled);
}

TEST(RenderJob, StopsBetweenTilesOfABand) {
  const scene::Scene scene = bumpy();
  int asked = 0;
  int bands = 0;
  Report report;
  report.progress = [&](double) { return ++asked < 3; };
  EXPECT_THROW((void)render_bands(
                   scene, {2048, 32, 1, Aov::normal}, [&](const image::Image&) { ++bands; }, report),
               Cancelled);
  EXPECT_EQ(asked, 3); // of 64 tiles
  EXPECT_EQ(bands, 0);
}

TEST(RenderJob, OfTheDemoHasNoDegenerateSample) {
  const Picture picture = render(scene::demo_scene(), {64, 64, 2, Aov::beauty});
  EXPECT_GT(picture.covered, 4000);
  EXPECT_EQ(picture.degenerate, 0);
  for (const float v : test::values_of(picture.image)) EXPECT_TRUE(v > 0 && v <= 1);
}

TEST(RenderJob, CountsSamplesWithoutAFrame) {
  scene::Scene scene = bumpy();
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = {0.25f, 0.25f};
  const Picture picture = render(scene, {32, 32, 1, Aov::normal});
  EXPECT_EQ(picture.degenerate, picture.covered);
  EXPECT_GT(picture.covered, 100);
}

TEST(RenderJob, AveragesItsSamples) {
  // One flat colour of surface over the whole picture: more samples change nothing.
  scene::Scene scene =
      surfgrad::test::scene_of(surfgrad::test::plane(1), surfgrad::test::scaling({1e4, 1e4, 1}));
  scene.camera.position = vec3<double>{0, 0, 1e4};
  scene.camera.target = vec3<double>{0, 0, 0};
  scene.camera.fov_deg = 1;
  surfgrad::test::add_image(scene, "sky", surfgrad::test::constant_image(1, 1, {0.5, 0.5, 0.5}));
  scene.environment = scene.images.at("sky");
  const Picture one = render(scene, {8, 8, 1, Aov::beauty});
  const Picture nine = render(scene, {8, 8, 3, Aov::beauty});
  EXPECT_EQ(one.covered, 64);
  EXPECT_EQ(nine.covered, 64 * 9);
  for (std::size_t i = 0; i < one.image.texels.size(); ++i)
    EXPECT_NEAR(one.image.texels[i], nine.image.texels[i], 1e-4);
}

} // namespace
} // namespace surfgrad::render
