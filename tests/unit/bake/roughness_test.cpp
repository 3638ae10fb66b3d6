// Detail that texels and mip levels lose, as roughness.

#include "bake/roughness.hpp"

#include "support/images.hpp"
#include "support/scenes.hpp"

#include <surfgrad/derivative.hpp>
#include <surfgrad/moments.hpp>

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

/// Moments of the normals of a block of texels of a map.
NormalMoments moments_of(const image::Image& map, int left, int bottom, int side) {
  NormalMoments sum{{0, 0, 0}, {0, 0}, 0};
  const double share = 1.0 / (side * side);
  for (int y = bottom; y < bottom + side; ++y)
    for (int x = left; x < left + side; ++x) {
      const vec3<double> n{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1};
      sum.mean = sum.mean + share * n;
      sum.square = sum.square + share * vec2<double>{n.x * n.x, n.y * n.y};
      sum.product += share * n.x * n.y;
    }
  return sum;
}

double difference(const NormalMoments& a, const NormalMoments& b) {
  return std::max({max_abs(a.mean - b.mean), max_abs(a.square - b.square), std::abs(a.product - b.product)});
}

TEST(NormalStatistics, AreTheMomentsOfAFinerBakesNormals) {
  const scene::Scene scene = bumped();
  double worst = 0;
  for (const int samples : {1, 2, 5}) {
    const Options options{.width = 32, .height = 32, .samples = samples};
    const NormalStatistics normals = normal_statistics(scene, options);
    const image::Image fine =
        bake(scene, {.width = 32 * samples, .height = 32 * samples}).map; // floats: not rounded to codes
    ASSERT_EQ(normals.level_count(), 6);
    // The square ends with texel 24: it covers 3 of 4 along each axis of the first three levels.
    for (int level = 0; level < 4; ++level)
      for (int y = 0; y < 32 >> level; ++y)
        for (int x = 0; x < 32 >> level; ++x) {
          const bool inside = x < 24 >> level && y < 24 >> level;
          ASSERT_EQ(normals.covered(level, x, y), inside);
          if (!inside) continue;
          const int side = samples << level;
          worst = std::max(
              worst, difference(normals.moments(level, x, y), moments_of(fine, x * side, y * side, side)));
        }
  }
  std::printf("  worst difference of a moment: %.2g\n", worst);
  EXPECT_LT(worst, 3 * 0x1p-16); // as in samples_test.cpp
}

TEST(NormalStatistics, OfPartlyCoveredTexelsAreThoseOfWhatIsCovered) {
  const NormalStatistics normals = normal_statistics(bumped(), {.width = 32, .height = 32});
  const image::Image fine = bake(bumped(), {.width = 32, .height = 32}).map;
  // One texel of the 1x1 level holds the whole square, a texel of the 2x2 level at most three quarters of it.
  EXPECT_LT(difference(normals.moments(5, 0, 0), moments_of(fine, 0, 0, 24)), 3 * 0x1p-16);
}

TEST(NormalStatistics, AreTheSameForAnyNumberOfThreads) {
  const Options options{.width = 70, .height = 45, .samples = 3, .padding = 4};
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return roughness_map(normal_statistics(bumped(), options), 0, BaseRoughness(0.3), options, true);
  };
  const image::Image one = run(1);
  EXPECT_EQ(one.texels, run(2).texels);
  EXPECT_EQ(one.texels, run(7).texels);
}

NormalMoments of_both(vec3<double> a, vec3<double> b) {
  return {0.5 * (a + b), 0.5 * vec2<double>{a.x * a.x + b.x * b.x, a.y * a.y + b.y * b.y},
          0.5 * (a.x * a.y + b.x * b.y)};
}

TEST(Widened, HasTheDirectionAndVarianceOfTwoNormals) {
  Random random(1762);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const double turn = random.uniform(0, std::numbers::pi);
    const double angle = random.uniform(0.05, 0.4); // of each to their mean
    const double alpha = random.uniform(0, 0.5);
    const vec3<double> mean =
        normalize_or_zero(vec3<double>{random.uniform(-1, 1), random.uniform(-1, 1), 1});
    // A tangent of the mean that lies along `turn` in the map.
    const vec3<double> leaning{std::cos(turn), std::sin(turn), 0};
    const vec3<double> along =
        normalize_or_zero(leaning - dot(leaning, mean) / mean.z * vec3<double>{0, 0, 1});
    const NormalMoments m = of_both(std::cos(angle) * mean + std::sin(angle) * along,
                                    std::cos(angle) * mean - std::sin(angle) * along);
    const Lobe lobe = widened(alpha, m);
    // The direction is told in the plane across the mean; seen in the map the mean's tilt shortens it.
    const vec2<double> tilt{mean.x, mean.y};
    const vec2<double> seen = vec2<double>{along.x, along.y} +
                              dot(tilt, vec2<double>{along.x, along.y}) / (mean.z * (1 + mean.z)) * tilt;
    const double variance = std::sin(angle) * std::sin(angle);
    worst = std::max(
        {worst, std::abs(lobe.alpha_along - std::min(1.0, std::sqrt(alpha * alpha + 2 * variance))),
         std::abs(lobe.alpha_across - alpha) * alpha, // its error is that of a variance of 0
         std::abs(lobe.direction.x * seen.y - lobe.direction.y * seen.x),
         std::abs(widened_alpha(alpha, m.mean) - std::min(1.0, std::sqrt(alpha * alpha + variance)))});
  }
  std::printf("  worst: %.2g\n", worst);
  EXPECT_LT(worst, 1e-12); // doubles, variances of 0.0025 and more
}

TEST(Widened, OfSmallSlopesIsThatOfTheirMoments) {
  Random random(1763);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const vec2<double> a{random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05)};
    const vec2<double> b{random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05)};
    const SlopeMoments<double> of_a = moments_from_derivative(a);
    const SlopeMoments<double> of_b = moments_from_derivative(b);
    const SlopeMoments<double> slopes{0.5 * (a + b), 0.5 * (of_a.square + of_b.square),
                                      0.5 * (of_a.product + of_b.product)};
    const vec3<double> mean = 0.5 * (normal_from_derivative(a) + normal_from_derivative(b));
    worst = std::max(worst, std::abs(widened_alpha(0.1, mean) - roughness_from_moments(0.1, slopes)));
  }
  std::printf("  worst: %.2g\n", worst);
  // A variance of at most 2 * 0.05^2 = 0.005 to a relative slope^2, over twice the alpha.
  EXPECT_LT(worst, 0.005 * 0.005 / (2 * 0.1));
}

TEST(RoughnessMap, IsTheBaseWhereNothingVariesAndIsPadded) {
  scene::Scene scene = bumped();
  surfgrad::test::add_image(scene, "a", surfgrad::test::constant_image(1, 1, {0.75, 0.5, 1}));
  const Options options{.width = 32, .height = 32, .samples = 3, .padding = 2};
  const NormalStatistics normals = normal_statistics(scene, options);
  const image::Image map = roughness_map(normals, 0, BaseRoughness(0.4), options, false);
  const image::Image across = roughness_map(normals, 0, BaseRoughness(0.4), options, true);
  const image::Image anisotropy = anisotropy_map(normals, 0, BaseRoughness(0.4), options);
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

TEST(NormalLevel, IsTheMeanDirectionOfAFinerBakesNormals) {
  const scene::Scene scene = bumped();
  const Options options{.width = 32, .height = 32, .samples = 2};
  const image::Image level = normal_level(normal_statistics(scene, options), 2, options);
  const image::Image fine = bake(scene, {.width = 64, .height = 64}).map;
  double worst = 0;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 6; ++x) {
      const vec3<double> direct = normalize_or_zero(moments_of(fine, 8 * x, 8 * y, 8).mean);
      const vec3<double> n{2.0 * level.at(x, y, 0) - 1, 2.0 * level.at(x, y, 1) - 1,
                           2.0 * level.at(x, y, 2) - 1};
      worst = std::max(worst, max_abs(n - direct));
    }
  std::printf("  worst difference of a component: %.2g\n", worst);
  EXPECT_LT(worst, 3 * 0x1p-16); // as in samples_test.cpp
}

TEST(NormalLevel, IsPaddedAsTheMapIs) {
  const Options options{.width = 32, .height = 32, .padding = 3};
  const image::Image level = normal_level(normal_statistics(bumped(), options), 1, options);
  for (int x = 12; x < 16; ++x)
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(level.at(x, 5, c), x < 15 ? level.at(11, 5, c) : c == 2 ? 1 : 0.5f) << x;
}

} // namespace
} // namespace surfgrad::bake
