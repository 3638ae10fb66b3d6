// Padding against its definition, and in a bake.

#include "bake/padding.hpp"

#include "bake/bake.hpp"
#include "stage/bands.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <cstring>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;

const std::vector<float> nothing{-1, -2, -3};

/// Texels covered with a probability, every covered one of another value.
image::Image random_coverage(Random& random, int width, int height, double share) {
  image::Image map = image::make_image(width, height, 3, image::Depth::float32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool covered = random.uniform(0, 1) < share;
      for (int c = 0; c < 3; ++c) map.at(x, y, c) = static_cast<float>(map.index(x, y, c));
      if (!covered) map.at(x, y, 0) = uncovered;
    }
  return map;
}

/// Every texel against every other one.
image::Image padded_by_definition(const image::Image& map, int reach, std::int64_t& count) {
  image::Image result = map;
  count = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      if (!std::isnan(map.at(x, y, 0))) continue;
      // Nearest; then in the nearest column, to the left, above.
      std::tuple<int, int, int, int> best{reach * reach + 1, 0, 0, 0};
      for (int v = 0; v < map.height; ++v)
        for (int u = 0; u < map.width; ++u) {
          if (std::isnan(map.at(u, v, 0))) continue;
          const int dx = u - x;
          const int dy = v - y;
          best = std::min(best, std::tuple(dx * dx + dy * dy, std::abs(dx), dx, -dy));
        }
      const auto [squared, across, dx, up] = best;
      const bool found = squared <= reach * reach;
      count += found ? 1 : 0;
      for (int c = 0; c < 3; ++c)
        result.at(x, y, c) = found ? map.at(x + dx, y - up, c) : nothing[static_cast<std::size_t>(c)];
    }
  return result;
}

/// In bands of random heights.
image::Image padded(Random& random, const image::Image& map, int reach, std::int64_t& count) {
  image::Image result = image::make_image(map.width, map.height, 3, image::Depth::float32);
  Padding padding(map.width, map.height, reach, nothing, stage::into(result));
  for (int top = map.height; top > 0;) {
    image::Image band;
    stage::reshape(band, map.width, 1 + random.integer(top), 3);
    top -= band.height;
    stage::copy_values(map, top, band.height, band.texels.floats().data());
    padding.add(band);
  }
  count = padding.padded();
  return result;
}

TEST(Padding, IsTheNearestCoveredTexelWhateverTheBands) {
  constexpr std::uint64_t seed = 1701;
  SCOPED_TRACE(seed);
  Random random(seed);
  std::int64_t texels = 0;
  for (int k = 0; k < 600; ++k) {
    const int reach = 1 + random.integer(9);
    const double share = std::pow(random.uniform(0, 1), 4);
    const image::Image map = random_coverage(random, 1 + random.integer(30), 1 + random.integer(30), share);
    std::int64_t expected_count = 0;
    std::int64_t count = 0;
    const image::Image expected = padded_by_definition(map, reach, expected_count);
    const image::Image got = padded(random, map, reach, count);
    ASSERT_EQ(got.texels, expected.texels) << k << ": " << map.width << "x" << map.height << ", " << reach;
    ASSERT_EQ(count, expected_count);
    texels += count;
  }
  std::printf("  %lld padded texels compared\n", static_cast<long long>(texels));
  EXPECT_GT(texels, 10000);
}

/// A torus in a corner of the map, turned so that none of its normals looks flat.
scene::Scene island() {
  Random random(1702);
  scene::Scene scene =
      surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(24, 12), random.rotation());
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = 0.4f * st + vec2<float>{0.25f, 0.35f};
  return scene;
}

TEST(Padding, OfABakeTouchesNoCoveredTexelAndGivesTheSameBytesForAnyNumberOfThreads) {
  const scene::Scene scene = island();
  Options options{90, 110, Space::world};
  const Baked bare = bake(scene, options);
  options.padding = 7;
  const Baked one = [&] {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    return bake(scene, options);
  }();
  const Baked many = bake(scene, options);
  EXPECT_EQ(one.map.texels, many.map.texels);
  EXPECT_EQ(bare.covered, many.covered);
  EXPECT_EQ(bare.padded, 0);
  EXPECT_EQ(many.covered, 37 * 45);          // it ends in the middle of texels
  EXPECT_GT(many.padded, 7 * 2 * (37 + 45)); // a frame of seven texels, its corners rounded
  EXPECT_LT(many.padded, 51 * 59 - many.covered);
  std::int64_t changed = 0;
  for (std::size_t i = 0; i < bare.map.texels.size(); i += 3) {
    if (test::same_texel(bare.map, many.map, i)) continue;
    EXPECT_EQ(bare.map.texels[i], 0.5f);
    EXPECT_EQ(bare.map.texels[i + 2], 1.0f);
    ++changed;
  }
  EXPECT_EQ(changed, many.padded);
  EXPECT_EQ(many.map.at(0, 0, 2), 1.0f); // out of reach
}

} // namespace
} // namespace surfgrad::bake
