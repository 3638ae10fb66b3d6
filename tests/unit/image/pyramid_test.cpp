// What filtering keeps: the mean of a map, hence the tilt of a tilted one.

#include "image/height_map.hpp"
#include "simd/lane.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <utility>
#include <vector>

namespace surfgrad::image {
namespace {

using test::texel;

// The last is made in several bands of rows, of which neighbours share one.
const std::vector<std::pair<int, int>> sizes{{1, 1},  {1, 9},   {17, 1},  {13, 7},   {16, 16},
                                             {64, 8}, {31, 63}, {129, 5}, {301, 513}};

TEST(Pyramid, HalvesDownToOneTexelOfOneWord) {
  test::Random random(21);
  for (const auto& [width, height] : sizes) {
    const Map map =
        make_slope_map(test::random_normal_map(random, width, height), NormalChannels::xyz, true).map;
    int w = width;
    int h = height;
    std::size_t words = 0;
    for (int level = 0; level < map.level_count; ++level) {
      EXPECT_EQ(map.width(level), w);
      EXPECT_EQ(map.height(level), h);
      EXPECT_EQ(map.level_table[3 * static_cast<std::size_t>(level) + 2], words);
      words += 2 * static_cast<std::size_t>(w + 1) * static_cast<std::size_t>(h + 1); // and the copies
      w = std::max(1, w / 2);
      h = std::max(1, h / 2);
    }
    EXPECT_EQ(map.width(map.level_count - 1), 1);
    EXPECT_EQ(map.height(map.level_count - 1), 1);
    EXPECT_EQ(map.words.size(), words + words_read_ahead);
  }
}

TEST(Pyramid, KeepsTheMeanSlopeOfEverySize) {
  constexpr std::uint64_t seed = 22;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("mean slope of a level");
  for (const auto& [width, height] : sizes) {
    const Map map =
        make_slope_map(test::random_normal_map(random, width, height, 3), NormalChannels::xyz, true).map;
    vec2<double> mean{};
    for (int level = 0; level < map.level_count; ++level) {
      vec2<double> sum{0, 0};
      for (int y = 0; y < map.height(level); ++y)
        for (int x = 0; x < map.width(level); ++x)
          sum = sum + vec2<double>{texel(map, level, x, y, 0), texel(map, level, x, y, 1)};
      sum = (1.0 / (map.width(level) * map.height(level))) * sum;
      if (level == 0) mean = sum;
      // Each level rounds each texel, at most 3 in size, once to float.
      worst.add(sum, mean, 3 * 0.5 * std::numeric_limits<float>::epsilon() * level, width * 1000 + level);
    }
  }
}

TEST(Pyramid, OfATiltedMapIsTiltedEverywhereExactly) {
  for (const auto& [width, height] : sizes) {
    const Map map =
        make_slope_map(test::constant_image(width, height, {0.3, 0.61, 0.9}), NormalChannels::xyz, true).map;
    for (int level = 0; level < map.level_count; ++level)
      for (int y = 0; y < map.height(level); ++y)
        for (int x = 0; x < map.width(level); ++x)
          for (const int c : {0, 1})
            EXPECT_EQ(texel(map, level, x, y, c), texel(map, 0, 0, 0, c))
                << width << "x" << height << " " << level;
  }
}

TEST(Pyramid, OddTexelsShareTheirPartByArea) {
  Image map = make_image(3, 1, 1, Depth::float32);
  map.texels = {0.0f, 0.9f, 0.3f};
  const Map three = make_channel_map(map, 0);
  EXPECT_FLOAT_EQ(texel(three, 1, 0, 0, 0), 0.4f);
  Image five = make_image(5, 1, 1, Depth::float32);
  five.texels = {1, 0, 1, 0, 0};
  const Map two = make_channel_map(five, 0); // each half covers two texels and half of the middle one
  EXPECT_FLOAT_EQ(texel(two, 1, 0, 0, 0), 1.5f / 2.5f);
  EXPECT_FLOAT_EQ(texel(two, 1, 1, 0, 0), 0.5f / 2.5f);
}

TEST(Pyramid, OfMomentsHoldsTheVarianceThatTheSlopesLose) {
  constexpr std::uint64_t seed = 24;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("moments of the last level");
  for (const Depth depth : {Depth::unorm8, Depth::float32})
    for (const auto& [width, height] : sizes) {
      const Map slopes =
          make_slope_map(test::random_normal_map(random, width, height, 1, depth), NormalChannels::xyz, true)
              .map;
      const Map moments = make_slope_moments(slopes);
      ASSERT_EQ(moments.components, 3);
      ASSERT_EQ(moments.level_count, slopes.level_count);
      double sum[3] = {0, 0, 0};
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double s = slopes.value(0, x, y, 0), t = slopes.value(0, x, y, 1);
          const double powers[] = {s * s, t * t, s * t};
          for (std::size_t c = 0; c < 3; ++c) sum[c] += powers[c] / (width * height);
        }
      const int last = moments.level_count - 1;
      for (int c = 0; c < 3; ++c) // each level rounds numbers of about 1 once to float
        worst.add(moments.value(last, 0, 0, c), sum[c],
                  0.5 * std::numeric_limits<float>::epsilon() * moments.level_count, width);
    }
}

TEST(Pyramid, IsTheSameForAnyNumberOfThreads) {
  test::Random random(23);
  // Odd sides meet the weighted averages, and all are large enough to be cut into blocks.
  for (const auto& [width, height] : {std::pair{640, 512}, {513, 301}}) {
    const Image normals = test::random_normal_map(random, width, height, 1, Depth::unorm8);
    const Image heights = test::random_image(random, width, height, 1);
    const auto made = [&](std::size_t threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const SlopeMap slopes = make_slope_map(normals, NormalChannels::xyz, true);
      std::vector<UninitialisedVector<std::uint32_t>> words{slopes.map.words};
      words.push_back(make_encoded_map(normals, NormalChannels::xyz, true).map.words);
      words.push_back(make_direction_map(normals, true).words);
      words.push_back(make_derivative_map(normals, 2, true).words);
      words.push_back(make_channel_map(heights, 0).words);
      words.push_back(make_height_slopes(heights, 0, {}).words);
      words.push_back(make_slope_moments(slopes.map).words);
      words.push_back({static_cast<std::uint32_t>(slopes.inward_texels)});
      return words;
    };
    const auto alone = made(1);
    EXPECT_EQ(made(2), alone);
    EXPECT_EQ(made(7), alone);
  }
}

} // namespace
} // namespace surfgrad::image
