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
  /// Lowest and highest slopes of those and of their neighbours.
  struct Range {
    vec2<double> low, high;
  };
  [[nodiscard]] Range range(int x, int y) const {
    Range r{at(2 * x, 2 * y), at(2 * x, 2 * y)};
    for (int j = -3; j < 5; ++j)
      for (int i = -3; i < 5; ++i) {
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

/// The definition of a filter's error: whatever means of texels around a place, with weights that sum to one,
/// lies between the lowest and the highest of them. The kernels of both bakes reach no further than the
/// neighbours of the four texels that the box averages.
void expect_within_the_filters_error(const char* name, const scene::Scene& scene, int side) {
  const Slopes full(bake(scene, {side, side, Space::tangent}).map);
  const Slopes half(bake(scene, {side / 2, side / 2, Space::tangent}).map);
  int outside = 0;
  double beyond = 0;
  double squares = 0;
  double spreads = 0;
  vec2<double> mean{0, 0};
  for (int y = 0; y < side / 2; ++y)
    for (int x = 0; x < side / 2; ++x) {
      const vec2<double> s = half.at(x, y);
      const Slopes::Range r = full.range(x, y);
      const double excess = std::max({r.low.x - s.x, s.x - r.high.x, r.low.y - s.y, s.y - r.high.y, 0.0});
      outside += excess > 1e-3;
      beyond = std::max(beyond, excess);
      const vec2<double> d = s - full.box(x, y);
      squares += dot(d, d);
      spreads += dot(r.high - r.low, r.high - r.low);
      mean = mean + d;
    }
  const double count = 0.25 * side * side;
  mean = (1 / count) * mean;
  std::printf("  %s: rms difference from the box %.2g, rms range of the texels around %.2g, %d of %.0f "
              "texels outside "
              "it by up to %.2g, mean difference %.2g, %.2g\n",
              name, std::sqrt(squares / count), std::sqrt(spreads / count), outside, count, beyond, mean.x,
              mean.y);
}

TEST(HalfResolution, OfTheDemoIsTheFullBakeWithinTheFiltersError) {
  expect_within_the_filters_error("demo", scene::demo_scene(), 512);
  scene::Scene demo = scene::demo_scene();
  auto& layers = demo.materials[0].layers;
  layers.resize(2);
  expect_within_the_filters_error("demo 2 layers", demo, 512);
  layers.resize(1);
  expect_within_the_filters_error("demo 1 layer", demo, 512);
  demo = scene::demo_scene();
  demo.materials[0].layers = {demo.materials[0].layers[1]};
  expect_within_the_filters_error("demo weave", demo, 512);
  demo = scene::demo_scene();
  demo.materials[0].layers = {demo.materials[0].layers[3]};
  expect_within_the_filters_error("demo grain", demo, 512);
  demo = scene::demo_scene();
  demo.materials[0].layers = {demo.materials[0].layers[4]};
  expect_within_the_filters_error("demo noise", demo, 512);
}

} // namespace
} // namespace surfgrad::bake
