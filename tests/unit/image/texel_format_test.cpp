// Texels in words: which format a source gets, and what each keeps of it.

#include "filter_definition.hpp"
#include "image/height_map.hpp"
#include "simd/lane.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::image {
namespace {

using test::texel_value;

TEST(TexelFormat, OfSlopesIs16BitsForGentle8BitFilesOnly) {
  test::Random random(71);
  const auto format_of = [](const Image& image) {
    return make_slope_map(image, NormalChannels::xyz, true).map.format;
  };
  Image gentle = test::random_normal_map(random, 16, 8, 1, Depth::unorm8);
  EXPECT_EQ(format_of(gentle), TexelFormat::slope16);
  EXPECT_EQ(format_of(test::random_normal_map(random, 16, 8, 1, Depth::unorm16)), TexelFormat::floats);
  EXPECT_EQ(format_of(test::random_normal_map(random, 16, 8, 1, Depth::float32)), TexelFormat::floats);
  Image codes = test::random_image(random, 8, 8, 2, Depth::unorm8);
  EXPECT_EQ(make_derivative_map(codes, 3.9, true).format, TexelFormat::slope16);
  EXPECT_EQ(make_derivative_map(codes, 8, true).format, TexelFormat::floats);
  gentle.at(3, 3, 0) = 1; // one wild texel: (1, 0, 0)
  gentle.at(3, 3, 1) = gentle.at(3, 3, 2) = test::stored(0.5, Depth::unorm8);
  EXPECT_EQ(format_of(gentle), TexelFormat::floats);
}

TEST(TexelFormat, OfSlopesRoundsEachTexelOnceByAtMostHalfACode) {
  constexpr std::uint64_t seed = 72;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("slope of 16 bits against float");
  for (const auto& [width, height] : {std::pair{1, 1}, {16, 16}, {13, 7}, {64, 3}})
    for (const double steepest : {0.001, 0.3, 1.0, 1.999, 3.9}) {
      std::vector<float> slopes(static_cast<std::size_t>(2 * width * height));
      for (float& d : slopes) d = static_cast<float>(random.uniform(-steepest, steepest));
      const TexelRows rows = rows_of(slopes, width, 2);
      const TexelCode code = code_for_slopes(rows, width, height);
      ASSERT_EQ(code.format, TexelFormat::slope16);
      EXPECT_LE(code.scale, 0x1p-13);
      const Map rounded = with_pyramid(rows, width, height, 2, code);
      const Map exact = with_pyramid(rows, width, height, 2);
      for (int level = 0; level < exact.level_count; ++level)
        for (int y = 0; y < exact.height(level); ++y)
          for (int x = 0; x < exact.width(level); ++x)
            for (const int c : {0, 1}) // of the same float averages: rounding does not add up over levels
              worst.add(texel_value(rounded, level, x, y, c), texel_value(exact, level, x, y, c),
                        0.5 * code.scale, level);
    }
}

TexelCode code_of(const std::vector<float>& one_texel) {
  return code_for_slopes(rows_of(one_texel, 1, 2), 1, 1);
}

TEST(TexelFormat, OfSlopesTakesTheFinestPowerOfTwoThatReaches) {
  for (const float steepest : {1e-30f, 0.3f, 0.9999f, 1.0f, 3.99f}) {
    const double scale = code_of({0.0f, -steepest}).scale;
    EXPECT_EQ(std::exp2(std::round(std::log2(scale))), scale);
    EXPECT_LE(steepest, 32767 * scale);
    EXPECT_TRUE(scale == 0x1p-40 || steepest > 32767 * scale / 2);
  }
  EXPECT_EQ(code_of({4.0f, 0.0f}).format, TexelFormat::floats);
  EXPECT_EQ(code_of({0.0f, 0.0f}).format, TexelFormat::slope16);
}

TEST(TexelFormat, OfSlopesHoldsEveryCodeOfEitherSign) {
  std::vector<float> slopes;
  for (int code = -32767; code <= 32767; ++code) slopes.push_back(static_cast<float>(code) / 32768);
  slopes.push_back(0);
  const TexelRows rows = rows_of(slopes, 32768, 2);
  const Map map = with_pyramid(rows, 32768, 1, 2, code_for_slopes(rows, 32768, 1));
  ASSERT_EQ(map.scale, 1.0 / 32768);
  for (int x = 0; x < 32768; ++x)
    for (int c = 0; c < 2; ++c) {
      const vec2<float> centre{(static_cast<float>(x) + 0.5f) / 32768, 0.5f};
      const auto got = sample<2, float>(map, centre, 0.0f, {}, Filter::bilinear, true);
      ASSERT_EQ(got[static_cast<std::size_t>(c)], slopes[static_cast<std::size_t>(2 * x + c)]) << x;
    }
}

TEST(TexelFormat, OfScalarsIs16BitsForFilesOfIntegersAndKeepsTheirCodes) {
  constexpr std::uint64_t seed = 73;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (const Depth depth : {Depth::unorm8, Depth::unorm16}) {
    const Image image = test::random_image(random, 9, 5, 1, depth);
    for (const Map& map : {make_channel_map(image, 0), make_height_map(image, 0)}) {
      ASSERT_EQ(map.format, TexelFormat::unorm16);
      for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 9; ++x) {
          const double code = std::round(image.at(x, y, 0) * test::most_code(depth));
          // In double a quotient and a product with the inverse differ by an ulp.
          EXPECT_NEAR(texel_value(map, 0, x, y), code / test::most_code(depth), 0x1p-52);
        }
    }
  }
  const Image floats = test::random_image(random, 9, 5, 1, Depth::float32);
  EXPECT_EQ(make_channel_map(floats, 0).format, TexelFormat::floats);
  EXPECT_EQ(make_height_map(floats, 0).format, TexelFormat::floats);
  Image between = make_image(2, 1, 1, Depth::unorm16); // what no reader returns is kept all the same
  between.texels = {0.25f, 1};
  EXPECT_EQ(make_channel_map(between, 0).format, TexelFormat::floats);
}

TEST(TexelFormat, OfScalarsRoundsCoarserLevelsByHalfACode) {
  constexpr std::uint64_t seed = 74;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("weight of 16 bits against float");
  Image image = test::random_image(random, 21, 16, 1);
  const Map rounded = make_channel_map(image, 0);
  image.depth = Depth::float32;
  const Map exact = make_channel_map(image, 0);
  for (int level = 0; level < exact.level_count; ++level)
    for (int y = 0; y < exact.height(level); ++y)
      for (int x = 0; x < exact.width(level); ++x) // of floats, which are off by eps / 4 themselves
        worst.add(texel_value(rounded, level, x, y), texel_value(exact, level, x, y), 0.5 / 65535 + 0x1p-25,
                  level);
}

TEST(TexelFormat, RowsAndLevelsEndWithCopiesOfTheirFirst) {
  test::Random random(75);
  for (const Map& map : test::maps_of_all_formats(random, 6, 5)) {
    const auto words = static_cast<std::size_t>(map.texel_words());
    const auto same = [&](int level, int x0, int y0, int x1, int y1) {
      for (std::size_t k = 0; k < words; ++k)
        EXPECT_EQ(map.words[map.word(level, x0, y0) + k], map.words[map.word(level, x1, y1) + k]);
    };
    for (int level = 0; level < map.level_count; ++level) {
      const int w = map.width(level);
      const int h = map.height(level);
      for (int y = 0; y <= h; ++y) same(level, w, y, 0, y % h);
      for (int x = 0; x <= w; ++x) same(level, x, h, x % w, 0);
    }
    EXPECT_EQ(static_cast<std::int64_t>(map.words.size()),
              words_of_map(6, 5, map.texel_words()) + words_read_ahead);
  }
}

} // namespace
} // namespace surfgrad::image
