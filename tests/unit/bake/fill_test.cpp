// Push-pull fill against what it promises mip levels, and in a bake.

#include "bake/fill.hpp"

#include "bake/bake.hpp"
#include "bake/padding.hpp"
#include "stage/bands.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;

const std::vector<float> nothing{-1, -2, -3};

image::Image random_coverage(Random& random, int width, int height, double share) {
  image::Image map = image::make_image(width, height, 3, image::Depth::float32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) map.at(x, y, c) = static_cast<float>(random.uniform(0, 1));
      if (!(random.uniform(0, 1) < share)) map.at(x, y, 0) = uncovered;
    }
  return map;
}

/// In bands of random heights.
image::Image filled(Random& random, const image::Image& map, std::int64_t& count) {
  image::Image result = image::make_image(map.width, map.height, 3, image::Depth::float32);
  Fill fill(map.width, map.height, nothing, stage::into(result));
  for (int top = map.height; top > 0;) {
    image::Image band;
    stage::reshape(band, map.width, 1 + random.integer(top), 3);
    top -= band.height;
    stage::copy_values(map, top, band.height, band.texels.floats().data());
    fill.add(band);
  }
  count = fill.filled();
  return result;
}

/// The mean of a block of a map: of its quarters' means, each of what is covered in it; `any` tells whether
/// something is.
double mean_of_covered(const image::Image& map, int x, int y, int side, int channel, bool& any) {
  if (x >= map.width || y >= map.height) return any = false, 0;
  if (side == 1) return any = !std::isnan(map.at(x, y, 0)), map.at(x, y, channel);
  double sum = 0;
  int count = 0;
  const int half = side / 2;
  for (const auto& [u, v] : {std::pair{x, y}, {x + half, y}, {x, y + half}, {x + half, y + half}}) {
    bool quarter = false;
    const double mean = mean_of_covered(map, u, v, half, channel, quarter);
    if (!quarter) continue;
    sum += mean;
    ++count;
  }
  any = count > 0;
  return any ? sum / count : 0;
}

TEST(Fill, GivesEveryMipLevelTheMeanOfWhatIsCoveredAlone) {
  constexpr std::uint64_t seed = 1751;
  SCOPED_TRACE(seed);
  Random random(seed);
  double worst = 0;
  int blocks = 0;
  for (const int side : {1, 2, 16, 64}) {
    const image::Image map = random_coverage(random, side, side, side < 3 ? 1 : 0.02);
    std::int64_t count = 0;
    image::Image got = filled(random, map, count);
    for (int block = 1; block <= side; block *= 2)
      for (int y = 0; y < side; y += block)
        for (int x = 0; x < side; x += block)
          for (int c = 0; c < 3; ++c) {
            bool any = false;
            const double expected = mean_of_covered(map, x, y, block, c, any);
            if (!any) continue;
            bool all = false;
            worst = std::max(worst, std::abs(mean_of_covered(got, x, y, block, c, all) - expected));
            ++blocks;
          }
  }
  std::printf("  worst difference %.2g in %d blocks\n", worst, blocks);
  EXPECT_LT(worst, 6 * 0x1p-25); // a level rounds its values below 1 once
  EXPECT_GT(blocks, 300);
}

TEST(Fill, KeepsWhatIsCoveredAndLeavesNothingOutWhateverTheSizeAndTheBands) {
  constexpr std::uint64_t seed = 1752;
  SCOPED_TRACE(seed);
  Random random(seed);
  for (int k = 0; k < 300; ++k) {
    const image::Image map = random_coverage(random, 1 + random.integer(40), 1 + random.integer(40),
                                             std::pow(random.uniform(0, 1), 4));
    std::int64_t count = 0;
    image::Image got = filled(random, map, count);
    std::int64_t expected_count = 0;
    bool any = false;
    for (std::size_t i = 0; i < map.texels.size(); i += 3) any = any || !std::isnan(map.texels[i]);
    for (std::size_t i = 0; i < map.texels.size(); i += 3) {
      if (!std::isnan(map.texels[i])) {
        ASSERT_TRUE(test::same_texel(map, got, i));
        continue;
      }
      ++expected_count;
      if (!any) {
        ASSERT_TRUE(std::equal(nothing.begin(), nothing.end(),
                               got.texels.floats().begin() + static_cast<std::ptrdiff_t>(i)));
      } else {
        for (std::size_t c = 0; c < 3; ++c) ASSERT_TRUE(got.texels[i + c] >= 0 && got.texels[i + c] <= 1);
      }
    }
    // A single uncovered texel of a 1x1 map has no level to take from.
    ASSERT_EQ(count, map.texels.size() == 3 ? 0 : expected_count);
  }
}

TEST(Fill, OfABakeGivesTheSameBytesForAnyNumberOfThreads) {
  Random random(1753); // turned so that none of its normals looks flat
  scene::Scene scene =
      surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(24, 12), random.rotation());
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = 0.4f * st + vec2<float>{0.25f, 0.35f};
  Options options{90, 110, Space::world};
  const Baked bare = bake(scene, options);
  options.fill = true;
  const Baked one = [&] {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    return bake(scene, options);
  }();
  const Baked many = [&] {
    const tbb::global_control more(tbb::global_control::max_allowed_parallelism, 4);
    return bake(scene, options);
  }();
  EXPECT_EQ(one.map.texels, many.map.texels);
  EXPECT_EQ(many.covered, bare.covered);
  EXPECT_EQ(many.padded, 90 * 110 - bare.covered);
  std::int64_t changed = 0;
  for (std::size_t i = 0; i < bare.map.texels.size(); i += 3) {
    if (test::same_texel(bare.map, many.map, i)) continue;
    EXPECT_EQ(bare.map.texels[i + 2], 1.0f);
    ++changed;
  }
  EXPECT_EQ(changed, many.padded);
}

} // namespace
} // namespace surfgrad::bake
