// The built-in scene: the same every time, and sound under the jobs.

#include "scene/scene.hpp"

#include "bake/bake.hpp"
#include "stack/uses.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::scene {
namespace {

TEST(DemoScene, IsTheSameEveryTime) {
  const Scene a = demo_scene();
  const Scene b = demo_scene();
  ASSERT_EQ(a.images.size(), b.images.size());
  for (const auto& [name, image] : a.images) EXPECT_EQ(image->texels, b.images.at(name)->texels) << name;
  ASSERT_EQ(a.meshes[0].positions.size(), b.meshes[0].positions.size());
  for (std::size_t i = 0; i < a.meshes[0].positions.size(); ++i)
    EXPECT_EQ(max_abs(a.meshes[0].positions[i] - b.meshes[0].positions[i]), 0);
}

TEST(DemoScene, HasNormalMapsThatPointOutwardsAndTile) {
  const Scene scene = demo_scene();
  for (const auto& [name, image] : scene.images) {
    if (image->channels != 3) continue;
    double sum[] = {0, 0};
    for (std::size_t i = 0; i < image->texels.size(); i += 3) {
      const double m[] = {2.0 * image->texels[i] - 1, 2.0 * image->texels[i + 1] - 1,
                          2.0 * image->texels[i + 2] - 1};
      ASSERT_GT(m[2], 0.05) << name;
      for (const int c : {0, 1}) sum[c] += m[c] / m[2];
    }
    // A periodic height has no mean slope.
    for (const double s : sum)
      EXPECT_NEAR(s * 3 / static_cast<double>(image->texels.size()), 0, 1e-3) << name;
  }
}

TEST(DemoScene, ReadsOnlyWhatItHas) {
  const Scene scene = demo_scene();
  ASSERT_EQ(scene.objects.size(), 1u);
  for (const Material& material : scene.materials)
    for (const stack::Layer& layer : material.layers)
      for (const stack::TextureUse& use : stack::textures_of(layer)) {
        EXPECT_TRUE(scene.images.contains(use.texture->file.path));
        EXPECT_LT(static_cast<std::size_t>(use.texture->uv), scene.meshes[0].uv_sets.size());
      }
}

TEST(DemoScene, BakesEveryTexelOfItsUnwrapWithoutATrouble) {
  const bake::Baked baked = bake::bake(demo_scene(), {128, 128, bake::Space::tangent});
  EXPECT_EQ(baked.covered, 128 * 128);
  EXPECT_EQ(baked.overlapping, 0);
  EXPECT_EQ(baked.singular, 0);
  EXPECT_EQ(baked.degenerate, 0);
  EXPECT_EQ(baked.clamped, 0);
}

} // namespace
} // namespace surfgrad::scene
