// Conversions that only change codes.

#include "maps/recode.hpp"

#include "support/images.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace surfgrad::maps {
namespace {

using stack::Green;
using surfgrad::test::Random;

/// As a reader keeps a file's values.
image::Image codes_of(Random& random, int width, int height, int channels, image::Depth depth) {
  image::Image map{width, height, channels, depth, channels == 2 || channels == 4, {}};
  const auto fill = [&](auto codes) {
    codes.resize(map.index(0, height));
    for (auto& code : codes) code = static_cast<typename decltype(codes)::value_type>(random.bits());
    map.texels = image::Texels(std::move(codes));
  };
  if (depth == image::Depth::unorm8)
    fill(image::Texels::Codes8{});
  else
    fill(image::Texels::Codes16{});
  return map;
}

/// Vectors near (0, 0, 1): a map of normals.
image::Image normals_of(Random& random, int width, int height, int channels, image::Depth depth) {
  image::Image map = codes_of(random, width, height, channels, depth);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      map.at(x, y, 0) = surfgrad::test::stored(random.uniform(0.3, 0.7), depth);
      map.at(x, y, 1) = surfgrad::test::stored(random.uniform(0.3, 0.7), depth);
      map.at(x, y, 2) = surfgrad::test::stored(random.uniform(0.9, 1.0), depth);
    }
  // Back to codes, as a reader keeps them.
  const std::vector<float> values = surfgrad::test::values_of(map);
  const auto fill = [&](auto codes, double most) {
    for (const float v : values)
      codes.push_back(static_cast<typename decltype(codes)::value_type>(v * most + 0.5));
    map.texels = image::Texels(std::move(codes));
  };
  if (depth == image::Depth::unorm8)
    fill(image::Texels::Codes8{}, 255);
  else
    fill(image::Texels::Codes16{}, 65535);
  return map;
}

long code(const image::Image& map, int x, int y, int channel) {
  return std::lround(map.at(x, y, channel) * surfgrad::test::most_code(map.depth));
}

image::Image recoded(const image::Image& map, const Conversion& conversion) {
  const auto recoding = Recoding::of(map, conversion, "map.png");
  EXPECT_TRUE(recoding);
  return recoding ? recoding->rows(0, map.height) : image::Image{};
}

constexpr image::Depth depths[] = {image::Depth::unorm8, image::Depth::unorm16};

TEST(Recode, FlipsTurnTheirChannelOverAndTwiceDoNothing) {
  Random random(1901);
  for (const image::Depth depth : depths)
    for (const int channels : {3, 4}) {
      const image::Image map = normals_of(random, 23, 11, channels, depth);
      for (const bool red : {false, true}) {
        Conversion flip{.depth = depth};
        flip.to.flips_x = red;
        flip.to.green = red ? Green::up : Green::down;
        const image::Image once = recoded(map, flip);
        ASSERT_EQ(once.channels, channels); // an opacity stays
        EXPECT_EQ(once.has_alpha, map.has_alpha);
        const long most = std::lround(surfgrad::test::most_code(depth));
        for (int y = 0; y < map.height; ++y)
          for (int x = 0; x < map.width; ++x)
            for (int c = 0; c < channels; ++c)
              ASSERT_EQ(code(once, x, y, c),
                        c == (red ? 0 : 1) ? most - code(map, x, y, c) : code(map, x, y, c));
        EXPECT_EQ(recoded(once, flip).texels, map.texels);
      }
    }
}

TEST(Recode, DerivativesTurnAroundTheirNeutralCode) {
  Random random(1902);
  for (const image::Depth depth : depths)
    for (const stack::NeutralCode neutral : {stack::NeutralCode::between, stack::NeutralCode::whole}) {
      const image::Image map = codes_of(random, 40, 20, 2, depth);
      const Form form{.kind = Kind::derivative, .range = 3, .neutral = neutral};
      Conversion flip{.from = form, .to = form, .depth = depth};
      flip.to.green = Green::down;
      const image::Image once = recoded(map, flip);
      const Slopes before = read_slopes(map, form, "map.png");
      const Slopes after = read_slopes(once, form, "map.png");
      for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
          ASSERT_EQ(after.map.at(x, y, 0), before.map.at(x, y, 0));
          // Codes are read as floats below 1, rounded by 2^-25 each; a slope is 6 times that.
          ASSERT_NEAR(after.map.at(x, y, 1), -before.map.at(x, y, 1), 2 * 6 * 0x1p-25 + 0x1p-23);
        }
    }
}

TEST(Recode, EightBitsWidenToTheSameValues) {
  Random random(1903);
  const image::Image normals = normals_of(random, 19, 7, 3, image::Depth::unorm8);
  const image::Image heights = codes_of(random, 19, 7, 1, image::Depth::unorm8);
  const Conversion of_normals{};
  const Conversion of_heights{.from = {.kind = Kind::height}, .to = {.kind = Kind::height}};
  const image::Image wide = recoded(normals, of_normals);
  const image::Image wide_heights = recoded(heights, of_heights);
  EXPECT_EQ(wide.depth, image::Depth::unorm16);
  for (int x = 0; x < 19; ++x) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(code(wide, x, 5, c), 257 * code(normals, x, 5, c));
    EXPECT_EQ(code(wide_heights, x, 5, 0), 257 * code(heights, x, 5, 0));
  }
}

TEST(Recode, BandsAreRowsOfTheWhole) {
  Random random(1904);
  const image::Image map = normals_of(random, 9, 30, 3, image::Depth::unorm16);
  Conversion turn;
  turn.to.channels = channels_of("bgr");
  const auto recoding = Recoding::of(map, turn, "map.png");
  ASSERT_TRUE(recoding);
  const image::Image whole = recoding->rows(0, 30);
  const image::Image band = recoding->rows(12, 5);
  ASSERT_EQ(band.height, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 9; ++x) {
      for (int c = 0; c < 3; ++c) EXPECT_EQ(band.at(x, y, c), whole.at(x, 12 + y, c));
      EXPECT_EQ(whole.at(x, y, 2), map.at(x, y, 0)); // red has gone to blue
    }
}

TEST(Recode, StepsAsideWhereTexelsChange) {
  Random random(1905);
  const image::Image map = normals_of(random, 8, 8, 3, image::Depth::unorm16);
  EXPECT_TRUE(Recoding::of(map, {}, "map.png"));
  EXPECT_FALSE(Recoding::of(map, {.depth = image::Depth::unorm8}, "map.png"));  // rounds
  EXPECT_FALSE(Recoding::of(map, {.depth = image::Depth::float32}, "map.png")); // no codes
  EXPECT_FALSE(Recoding::of(map, {.retile = true}, "map.png"));
  EXPECT_FALSE(Recoding::of(map, {.width = 4, .height = 4}, "map.png"));
  EXPECT_FALSE(Recoding::of(map, {.mips = true}, "map.png"));
  EXPECT_FALSE(Recoding::of(map, {.to = {.kind = Kind::derivative}}, "map.png"));
  EXPECT_FALSE(Recoding::of(map, {.to = {.channels = channels_of("rg")}}, "map.png")); // z is left out
  const Form narrow{.kind = Kind::derivative, .range = 1}, wide{.kind = Kind::derivative, .range = 2};
  EXPECT_FALSE(Recoding::of(map, {.from = narrow, .to = wide}, "map.png"));
  image::Image floats = map;
  floats.texels.floats()[0] += 1e-4f; // whatever its depth says, there are no codes
  EXPECT_FALSE(Recoding::of(floats, {}, "map.png"));
}

} // namespace
} // namespace surfgrad::maps
