// A bake at half the size is the full one, filtered.

#include "bake/bake.hpp"

#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace surfgrad::bake {
namespace {

/// Slopes of a baked tangent-space map.
struct Slopes {
  int side;
  std::vector<vec2<double>> texels;

  explicit Slopes(const image::Image& map) : side(map.width) {
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const double z = 2.0 * map.at(x, y, 2) - 1;
        texels.push_back({-(2.0 * map.at(x, y, 0) - 1) / z, -(2.0 * map.at(x, y, 1) - 1) / z});
      }
  }
  /// Beyond a border it goes on at the other side, as the torus does.
  [[nodiscard]] vec2<double> at(int x, int y) const {
    const auto wrapped = [this](int i) { return static_cast<std::size_t>((i + side) % side); };
    return texels[wrapped(y) * static_cast<std::size_t>(side) + wrapped(x)];
  }
  /// Mean of the four texels under one of half the size.
  [[nodiscard]] vec2<double> box(int x, int y) const {
    return 0.25 * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1));
  }
  /// Lowest and highest slopes of those and of so many neighbours to every side.
  struct Range {
    vec2<double> low, high;
  };
  [[nodiscard]] Range range(int x, int y, int reach) const {
    Range r{at(2 * x, 2 * y), at(2 * x, 2 * y)};
    for (int j = -reach; j < 2 + reach; ++j)
      for (int i = -reach; i < 2 + reach; ++i) {
        const vec2<double> s = at(2 * x + i, 2 * y + j);
        r = {{std::min(r.low.x, s.x), std::min(r.low.y, s.y)},
             {std::max(r.high.x, s.x), std::max(r.high.y, s.y)}};
      }
    return r;
  }
};

TEST(HalfResolution, OfAMapOfTheSameSizeIsItsBoxFilteredSlopes) {
  constexpr int side = 128;
  surfgrad::test::Random random(1601);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::torus(24, 12));
  surfgrad::test::add_image(scene, "own", surfgrad::test::random_normal_map(random, side, side));
  scene.materials[0].layers = {surfgrad::test::normal_layer("own")};
  const Slopes full(bake(scene, {side, side, Space::tangent}).map);
  const Slopes half(bake(scene, {side / 2, side / 2, Space::tangent}).map);
  // The half bake reads mip level 1 at its texels' centres: the very means. What is left is float: texture
  // coordinates of a last place of 2^-24 are off by 2^-18 of the level's 64 texels, and so is the level
  // itself, of slopes up to 1 that differ by up to 2 from texel to texel: 2^-16, with twice that for tangent
  // frames.
  constexpr double bound = 3 * 0x1p-16;
  double worst = 0;
  double largest = 0;
  for (int y = 0; y < side / 2; ++y)
    for (int x = 0; x < side / 2; ++x) {
      worst = std::max(worst, max_abs(half.at(x, y) - full.box(x, y)));
      largest = std::max(largest, max_abs(half.at(x, y)));
    }
  std::printf("  worst difference of slopes %.2g, bound %.2g, largest slope %.2g\n", worst, bound, largest);
  EXPECT_LT(worst, bound);
  EXPECT_GT(largest, 0.5);
}

/// What a filter may make of the texels around a place: a mean of them. Two means differ, but
/// - neither lies outside the texels' range. The coarser of two levels at half resolution has texels up to
/// two
///   of the half map's long, up to three times that along the shorter side of an uneven footprint, and a
///   linear filter reaches over one and a half of them to either side: eighteen texels of the full map;
/// - they are nearer to each other than a value picked at random is to the mean of its range: over the range
/// of
///   the sixteen texels around the box, 1 / sqrt(12) of it for values spread evenly.
/// What is no mean of texels (a second pass, which turns with the normal of the first; a function of space,
/// which is not filtered at all) is faint in the demo.
void expect_within_the_filters_error(const char* name, const scene::Scene& scene) {
  constexpr int side = 512;
  const Slopes full(bake(scene, {side, side, Space::tangent}).map);
  const Slopes half(bake(scene, {side / 2, side / 2, Space::tangent}).map);
  double beyond = 0;
  double squares = 0;
  double ranges = 0;
  for (int y = 0; y < side / 2; ++y)
    for (int x = 0; x < side / 2; ++x) {
      const vec2<double> s = half.at(x, y);
      const Slopes::Range wide = full.range(x, y, 18);
      beyond = std::max({beyond, wide.low.x - s.x, s.x - wide.high.x, wide.low.y - s.y, s.y - wide.high.y});
      const Slopes::Range near = full.range(x, y, 1);
      const vec2<double> d = s - full.box(x, y);
      squares += dot(d, d);
      ranges += dot(near.high - near.low, near.high - near.low);
    }
  const double rms = std::sqrt(squares / ranges);
  std::printf("  %s: difference from the box %.2g of the texels' range, at most %.2g outside it\n", name, rms,
              beyond);
  EXPECT_LT(rms, 1 / std::sqrt(12.0)) << name;
  EXPECT_LE(beyond, 16 * 0x1p-24) << name; // rounding of float slopes up to 4
  EXPECT_GT(ranges, 0) << name;
}

TEST(HalfResolution, OfMinifiedMapsIsTheFullBakeWithinTheFiltersError) {
  for (const std::size_t layer : {0u, 1u}) { // a map on either UV set
    scene::Scene scene = scene::demo_scene();
    scene.materials[0].layers = {scene.materials[0].layers[layer]};
    expect_within_the_filters_error(layer == 0 ? "plates" : "weave", scene);
  }
}

TEST(HalfResolution, OfTheDemoIsTheFullBakeWithinTheFiltersError) {
  expect_within_the_filters_error("demo", scene::demo_scene());
}

} // namespace
} // namespace surfgrad::bake
