// Detail that texels and mip levels lose, as roughness.

#include "bake/roughness.hpp"

#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;

/// A square over the lower left part of the map under bumps: some of the map is covered, some is not.
scene::Scene bumped(int map_side = 64) {
  Random random(1761);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::plane(1));
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = 0.75f * st;
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, map_side, map_side));
  scene.materials[0].layers = {surfgrad::test::normal_layer("a")};
  return scene;
}

/// Moments of the slopes of a block of texels of a map.
SlopeMoments<double> moments_of(const image::Image& map, int left, int bottom, int side) {
  SlopeMoments<double> sum{{0, 0}, {0, 0}, 0};
  for (int y = bottom; y < bottom + side; ++y)
    for (int x = left; x < left + side; ++x) {
      const vec3<double> n{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1};
      const SlopeMoments<double> m = moments_from_derivative(vec2<double>{n.x / n.z, n.y / n.z});
      sum = {sum.mean + m.mean, sum.square + m.square, sum.product + m.product};
    }
  const double share = 1.0 / (side * side);
  return {share * sum.mean, share * sum.square, share * sum.product};
}

double difference(const SlopeMoments<double>& a, const SlopeMoments<double>& b) {
  return std::max({max_abs(a.mean - b.mean), max_abs(a.square - b.square), std::abs(a.product - b.product)});
}

TEST(SlopeStatistics, AreTheMomentsOfAFinerBakesSlopes) {
  const scene::Scene scene = bumped();
  double worst = 0;
  for (const int samples : {1, 2, 5}) {
    const Options options{.width = 32, .height = 32, .samples = samples};
    const SlopeStatistics slopes = slope_statistics(scene, options);
    const image::Image fine =
        bake(scene, {.width = 32 * samples, .height = 32 * samples}).map; // floats: not rounded to codes
    ASSERT_EQ(slopes.level_count(), 6);
    // The square ends with texel 24: it covers 3 of 4 along each axis of the first three levels.
    for (int level = 0; level < 4; ++level)
      for (int y = 0; y < 32 >> level; ++y)
        for (int x = 0; x < 32 >> level; ++x) {
          const bool inside = x < 24 >> level && y < 24 >> level;
          ASSERT_EQ(slopes.covered(level, x, y), inside);
          if (!inside) continue;
          const int side = samples << level;
          worst = std::max(
              worst, difference(slopes.moments(level, x, y), moments_of(fine, x * side, y * side, side)));
        }
  }
  std::printf("  worst difference of a moment: %.2g\n", worst);
  // As in samples_test.cpp, for slopes up to 1.5 and their squares.
  EXPECT_LT(worst, 6 * 0x1p-16);
}

TEST(SlopeStatistics, OfPartlyCoveredTexelsAreThoseOfWhatIsCovered) {
  const SlopeStatistics slopes = slope_statistics(bumped(), {.width = 32, .height = 32});
  const image::Image fine = bake(bumped(), {.width = 32, .height = 32}).map;
  // One texel of the 1x1 level holds the whole square, a texel of the 2x2 level at most three quarters of it.
  EXPECT_LT(difference(slopes.moments(5, 0, 0), moments_of(fine, 0, 0, 24)), 6 * 0x1p-16);
}

TEST(SlopeStatistics, AreTheSameForAnyNumberOfThreads) {
  const Options options{.width = 70, .height = 45, .samples = 3, .padding = 4};
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return roughness_map(slope_statistics(bumped(), options), 0, BaseRoughness(0.3), options, false);
  };
  const image::Image one = run(1);
  EXPECT_EQ(one.texels, run(2).texels);
  EXPECT_EQ(one.texels, run(7).texels);
}

TEST(Widened, HasTheDirectionAndVarianceOfTwoOppositeSlopes) {
  Random random(1762);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const double angle = random.uniform(0, std::numbers::pi);
    const double slope = random.uniform(0.05, 0.4);
    const double alpha = random.uniform(0, 0.5);
    const vec2<double> d{slope * std::cos(angle), slope * std::sin(angle)};
    const vec2<double> mean{random.uniform(-1, 1), random.uniform(-1, 1)};
    // Half of the surface leans by mean + d, half by mean - d.
    const auto a = moments_from_derivative(mean + d);
    const auto b = moments_from_derivative(mean - d);
    const SlopeMoments<double> m{mean, 0.5 * (a.square + b.square), 0.5 * (a.product + b.product)};
    const Lobe lobe = widened(alpha, m);
    worst = std::max({worst,
                      std::abs(lobe.alpha_along - std::min(1.0, std::hypot(alpha, std::sqrt(2.0) * slope))),
                      std::abs(lobe.alpha_across - alpha) * alpha, // its error is that of a variance of 0
                      std::abs(lobe.direction.x * d.y - lobe.direction.y * d.x) / slope});
    // The isotropic roughness has the mean of both.
    const double both = 0.5 * (lobe.alpha_along * lobe.alpha_along + lobe.alpha_across * lobe.alpha_across);
    if (lobe.alpha_along < 1)
      worst = std::max(worst, std::abs(std::sqrt(both) - roughness_from_moments(alpha, m)));
  }
  std::printf("  worst: %.2g\n", worst);
  EXPECT_LT(worst, 1e-12); // doubles, variances of 0.0025 and more out of squares up to 2
}

TEST(RoughnessMap, IsTheBaseWhereNothingVariesAndIsPadded) {
  scene::Scene scene = bumped();
  surfgrad::test::add_image(scene, "a", surfgrad::test::constant_image(1, 1, {0.75, 0.5, 1}));
  const Options options{.width = 32, .height = 32, .samples = 3, .padding = 2};
  const SlopeStatistics slopes = slope_statistics(scene, options);
  const image::Image map = roughness_map(slopes, 0, BaseRoughness(0.4), options, false);
  const image::Image across = roughness_map(slopes, 0, BaseRoughness(0.4), options, true);
  const image::Image anisotropy = anisotropy_map(slopes, 0, BaseRoughness(0.4), options);
  for (int x = 0; x < 32; ++x) {
    const bool reached = x < 26;
    EXPECT_NEAR(map.at(x, 5, 0), reached ? 0.4 : 1.0, 1e-4) << x; // the root of a variance's rounding
    EXPECT_NEAR(across.at(x, 5, 0), reached ? 0.4 : 1.0, 1e-4) << x;
    EXPECT_NEAR(anisotropy.at(x, 5, 2), 0, 3e-3) << x;
  }
}

TEST(RoughnessMap, TakesTheMeanVarianceOfABaseMap) {
  image::Image base = image::make_image(4, 4, 3);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      base.at(x, y, 0) = 1; // occlusion: not read
      base.at(x, y, 1) = x % 2 == 0 ? 0.2f : 0.6f;
    }
  const BaseRoughness roughness(base);
  EXPECT_NEAR(roughness.alpha(0, 0, 4, 4), 0.04, 1e-6);
  EXPECT_NEAR(roughness.alpha(1, 2, 4, 4), 0.36, 1e-6);
  // Alpha squared is twice a variance of slopes, and those average: of 0.04 and 0.36.
  EXPECT_NEAR(roughness.alpha(0, 0, 2, 2), std::sqrt(0.5 * (0.04 * 0.04 + 0.36 * 0.36)), 1e-6);
}

TEST(NormalLevel, IsTheBakeOfHalfTheSizeWithTwiceTheSamples) {
  const scene::Scene scene = bumped();
  const Options options{.width = 32, .height = 32, .samples = 2, .padding = 3};
  const image::Image level = normal_level(slope_statistics(scene, options), 1, options);
  const image::Image direct = bake(scene, {.width = 16, .height = 16, .samples = 4, .padding = 3}).map;
  ASSERT_EQ(level.texels.size(), direct.texels.size());
  double worst = 0;
  for (std::size_t i = 0; i < level.texels.size(); ++i)
    worst = std::max(worst, std::abs(double{level.texels[i]} - direct.texels[i]));
  std::printf("  worst difference of a component: %.2g\n", worst);
  EXPECT_LT(worst, 3 * 0x1p-16); // as in samples_test.cpp
}

} // namespace
} // namespace surfgrad::bake
