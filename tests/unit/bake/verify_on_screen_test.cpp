// The filtered comparison: a map read by the wrong words, on the wrong set or at the wrong place would show.

#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>

namespace surfgrad::bake {
namespace {

/// A mesh under one slope everywhere, laid out once more, turned and smaller, in UV set 1.
scene::Scene tilted(double slope,
                    const mesh::TriangleMesh& mesh = surfgrad::test::half_mirrored_torus(24, 12)) {
  scene::Scene scene = surfgrad::test::scene_of(mesh);
  auto& sets = scene.meshes[0].uv_sets;
  sets.push_back(sets[0]);
  for (vec2<float>& st : sets[1]) st = {0.9f - 0.7f * st.y, 0.1f + 0.8f * st.x};
  const double length = std::hypot(slope, 0.5 * slope, 1);
  surfgrad::test::add_image(
      scene, "a",
      surfgrad::test::constant_image(
          4, 4, {0.5 + 0.5 * slope / length, 0.5 + 0.25 * slope / length, 0.5 + 0.5 / length}));
  scene.materials[0].layers = {surfgrad::test::normal_layer("a")};
  return scene;
}

TEST(VerifyOnScreen, FindsNothingWhereFilteringChangesNothing) {
  for (const Encoding encoding : {Encoding::rgb, Encoding::rg, Encoding::derivative})
    for (const stack::Green green : {stack::Green::up, stack::Green::down})
      for (const image::Depth depth : {image::Depth::unorm16, image::Depth::float32}) {
        const Options options{.width = 128,
                              .height = 128,
                              .green = green,
                              .encoding = encoding,
                              .range = encoding == Encoding::derivative ? 2.0 : 1.0,
                              .depth = depth};
        const scene::Scene scene = tilted(0.6);
        const Verification got = verify(scene, options, bake(scene, options).map);
        std::printf("  encoding %d, green %d, depth %d: mean %.5f, most %.5f degrees\n",
                    static_cast<int>(encoding), static_cast<int>(green), static_cast<int>(depth),
                    got.on_screen.mean_deg, got.on_screen.most_deg);
        EXPECT_GT(got.on_screen.compared, 200000);
        EXPECT_EQ(got.on_screen.left_out, 0);
        // All texels hold the same normal; what is filtered is rounding alone, of floats.
        EXPECT_LT(got.on_screen.most_deg, 0.002);
      }
}

TEST(VerifyOnScreen, MirroredIslandsThatShareTexelsShowTheSameBumps) {
  scene::Scene scene = tilted(0.6);
  std::vector<vec2<float>>& st = scene.meshes[0].uv_sets[0];
  // The second half of the torus is mirrored: it moves over the first one. Maps repeat: the fill keeps both
  // borders what the island is.
  for (std::size_t i = st.size() / 2; i < st.size(); ++i) st[i].x -= 0.5f;
  const Options options{.width = 128, .height = 128, .fill = true};
  const Baked baked = bake(scene, options);
  EXPECT_EQ(baked.overlapping, baked.covered);
  const Verification got = verify(scene, options, baked.map);
  EXPECT_LT(got.texels.most_deg, 0.002);
  EXPECT_LT(got.on_screen.most_deg, 0.002);
  EXPECT_GT(got.on_screen.compared, 200000);
}

TEST(VerifyOnScreen, FollowsTheUvSetAndTheSpace) {
  // Nothing in its map ends but the island of the second set: what is filtered changes little.
  const scene::Scene scene = tilted(0.6, surfgrad::test::torus(24, 12));
  for (const Space space : {Space::tangent, Space::object, Space::world})
    for (const int set : {0, 1}) {
      const Options options{.width = 1024,
                            .height = 1024,
                            .space = space,
                            .uv_set = set,
                            .padding = 16,
                            .depth = image::Depth::float32};
      const Deviation got = verify(scene, options, bake(scene, options).map).on_screen;
      std::printf("  space %d, set %d: mean %.5f, 99.9 %% %.5f, most %.5f degrees\n", static_cast<int>(space),
                  set, got.mean_deg, got.high_deg, got.most_deg);
      // The torus turns by 360 degrees in 1024 texels, or in 717 of the second set: linear filters follow it
      // to a thousandth of that. Only silhouettes, where a footprint is long, are off by more; another set or
      // space by tens of degrees.
      EXPECT_LT(got.mean_deg, 0.05);
    }
}

TEST(VerifyOnScreen, TellsHowFarAMapIsOff) {
  const scene::Scene scene = tilted(0.6);
  const Options options{.width = 64, .height = 64, .depth = image::Depth::float32};
  scene::Scene flat = scene;
  flat.materials[0].layers.clear();
  const Verification got = verify(scene, options, bake(flat, options).map);
  // The slope is (0.6, 0.3) in a frame whose vectors are within 4 % of unit.
  const double expected = std::atan(std::hypot(0.6, 0.3)) * 180 / 3.14159265358979324;
  EXPECT_NEAR(got.on_screen.mean_deg, expected, 0.04 * expected);
  EXPECT_NEAR(got.texels.mean_deg, expected, 0.04 * expected);
  // No direction at all is as wrong as can be.
  image::Image grey = image::make_image(64, 64, 3, image::Depth::float32);
  std::fill(grey.texels.floats().begin(), grey.texels.floats().end(), 0.5f);
  EXPECT_EQ(verify(scene, options, grey).texels.mean_deg, 180);
}

TEST(VerifyOnScreen, LeavesOutWhatTheMapDoesNotReach) {
  scene::Scene scene = tilted(0.6);
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st.x += 0.5f;
  const Options options{.width = 64, .height = 64, .depth = image::Depth::float32};
  const Deviation got = verify(scene, options, bake(scene, options).map).on_screen;
  EXPECT_GT(got.left_out, got.compared / 10);
  EXPECT_GT(got.compared, got.left_out / 10);
}

TEST(VerifyOnScreen, IsTheSameForAnyNumberOfThreadsAndGoesOnToOne) {
  surfgrad::test::Random random(1771);
  scene::Scene scene = tilted(0.6);
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, 32, 32));
  const Options options{.width = 64, .height = 64};
  const image::Image map = bake(scene, options).map;
  const Deviation many = verify(scene, options, map).on_screen;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  double part = 0;
  Report report;
  report.progress = [&](double done) {
    EXPECT_GE(done, part);
    part = done;
    return true;
  };
  const Deviation one = verify(scene, options, map, report).on_screen;
  EXPECT_EQ(part, 1);
  EXPECT_GT(one.mean_deg, 0.1);
  EXPECT_EQ(one.mean_deg, many.mean_deg);
  EXPECT_EQ(one.high_deg, many.high_deg);
  EXPECT_EQ(one.most_deg, many.most_deg);
  EXPECT_EQ(one.x, many.x);
  EXPECT_EQ(one.y, many.y);
}

} // namespace
} // namespace surfgrad::bake
