// Whole conversions: what stays exact, and what is counted.

#include "maps/convert.hpp"

#include "diagnostic/error.hpp"
#include "support/images.hpp"

#include <surfgrad/derivative.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace surfgrad::maps {
namespace {

using stack::Green;
using surfgrad::test::Random;
using surfgrad::test::stored;
using testing::HasSubstr;

constexpr image::Depth integers[] = {image::Depth::unorm8, image::Depth::unorm16};

/// As it is once it has been written and read again.
image::Image through_file(image::Image map, image::Depth depth) {
  map.depth = depth;
  if (!image::is_integer(depth)) return map;
  for (float& v : map.texels.floats()) v = stored(v, depth);
  return map;
}

image::Image converted(const image::Image& map, const Conversion& conversion) {
  return through_file(convert(map, conversion, "map.png").map, conversion.depth);
}

/// Normals that are not quite unit vectors, some of them inward, as files have them.
image::Image uneven_normals(Random& random, int width, int height, image::Depth depth) {
  image::Image map = surfgrad::test::random_normal_map(random, width, height, 3, depth);
  for (float& v : map.texels.floats()) v = stored(v + random.uniform(-0.06, 0.06), depth);
  for (int x = 0; x < width; ++x) map.at(x, height / 2, 2) = 0;
  return map;
}

TEST(Convert, GreenAndRedFlipsAreTheirOwnInversesToTheLastCode) {
  Random random(1811);
  for (const image::Depth depth : integers) {
    const image::Image map = uneven_normals(random, 40, 30, depth);
    for (const bool red : {false, true}) {
      Conversion flip{.depth = depth};
      flip.to.flips_x = red;
      flip.to.green = red ? Green::up : Green::down;
      const image::Image once = converted(map, flip);
      EXPECT_NE(once.texels, map.texels);
      EXPECT_EQ(converted(once, flip).texels, map.texels);
      const double most = surfgrad::test::most_code(depth);
      for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
          EXPECT_EQ(std::lround(once.at(x, y, red ? 0 : 1) * most),
                    static_cast<long>(most) - std::lround(map.at(x, y, red ? 0 : 1) * most));
    }
  }
}

TEST(Convert, DerivativesFlipToTheLastCodeToo) {
  Random random(1812);
  for (const image::Depth depth : integers)
    for (const stack::NeutralCode neutral : {stack::NeutralCode::between, stack::NeutralCode::whole}) {
      image::Image map = surfgrad::test::random_image(random, 40, 30, 2, depth);
      const Form form{.kind = Kind::derivative, .range = 3, .neutral = neutral};
      if (neutral == stack::NeutralCode::whole) // code 0 is read as code 1
        for (float& v : map.texels.floats())
          v = std::max(v, static_cast<float>(1 / surfgrad::test::most_code(depth)));
      EXPECT_EQ(converted(map, {.from = form, .to = form, .depth = depth}).texels, map.texels);
      Conversion flip{.from = form, .to = form, .depth = depth};
      flip.to.green = Green::down;
      EXPECT_EQ(converted(converted(map, flip), flip).texels, map.texels);
    }
}

TEST(Convert, CodesOf8BitsAreTheSameIn16AndBack) {
  Random random(1813);
  for (const int channels : {1, 3}) {
    const image::Image map = channels == 1
                                 ? surfgrad::test::random_image(random, 20, 20, 1, image::Depth::unorm8)
                                 : uneven_normals(random, 20, 20, image::Depth::unorm8);
    Conversion wide;
    wide.from.kind = wide.to.kind = channels == 1 ? Kind::height : Kind::normal;
    const image::Image wider = converted(map, wide);
    for (std::size_t i = 0; i < map.texels.size(); ++i)
      EXPECT_EQ(std::lround(wider.texels[i] * 65535), 257 * std::lround(map.texels[i] * 255));
    wide.depth = image::Depth::unorm8;
    EXPECT_EQ(converted(wider, wide).texels, map.texels);
  }
}

TEST(Convert, DepthsAreHeightsTurnedOver) {
  Random random(1814);
  const image::Image map = surfgrad::test::random_image(random, 9, 9, 1, image::Depth::unorm16);
  const Conversion conversion{.from = {.kind = Kind::height, .is_depth = true}, .to = {.kind = Kind::height}};
  EXPECT_EQ(std::lround(converted(map, conversion).at(3, 4, 0) * 65535),
            65535 - std::lround(map.at(3, 4, 0) * 65535));
  EXPECT_EQ(converted(converted(map, conversion), conversion).texels, map.texels);
}

TEST(Convert, ChannelsGoWhereTheyAreAskedFor) {
  Random random(1815);
  const image::Image map = surfgrad::test::random_normal_map(random, 16, 16, 0.8);
  // As DXT5 files keep them: y in green, x in opacity; z is left out.
  Conversion swizzle;
  swizzle.to.channels = channels_of("ag");
  image::Image packed = converted(map, swizzle);
  EXPECT_EQ(packed.channels, 4);
  packed.has_alpha = true;
  EXPECT_EQ(packed.at(2, 3, 0), 1);
  EXPECT_NEAR(packed.at(2, 3, 3), map.at(2, 3, 0), 2e-5); // unit length again: a code of 16 bits
  Conversion back;
  back.from.channels = channels_of("ag");
  const image::Image again = converted(packed, back);
  double worst = 0;
  for (std::size_t i = 0; i < map.texels.size(); ++i)
    worst = std::max(worst, std::abs(double{again.texels[i]} - map.texels[i]));
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst,
            4 * 1.5 / 65535); // z = sqrt(1 - x^2 - y^2) turns half a code of x and y into slope / z of it
  // Only moved: to the bit.
  Conversion turn;
  turn.to.channels = channels_of("bgr");
  Conversion turn_back;
  turn_back.from.channels = channels_of("bgr");
  EXPECT_EQ(converted(converted(map, turn), turn_back).texels, map.texels);
}

TEST(Convert, NormalsAndDerivativesAreTheSameSlopes) {
  Random random(1816);
  const image::Image map = surfgrad::test::random_normal_map(random, 30, 30, 1.5);
  Conversion to_slopes{.to = {.kind = Kind::derivative, .range = 2}};
  const image::Image slopes = converted(map, to_slopes);
  EXPECT_EQ(slopes.channels, 2);
  Conversion back{.from = to_slopes.to};
  const image::Image again = converted(slopes, back);
  double worst = 0;
  for (std::size_t i = 0; i < map.texels.size(); ++i)
    worst = std::max(worst, std::abs(double{again.texels[i]} - map.texels[i]) * 65535);
  std::printf("  worst %.2g codes\n", worst);
  EXPECT_LE(worst,
            2.01); // a code of a derivative is 4 / 65535, up to one of the normal; and half a code each way
  // Steeper than the range: flattened along their direction, and counted.
  to_slopes.to.range = 0.5;
  const Converted clamped = convert(map, to_slopes, "map.png");
  EXPECT_GT(clamped.clamped, 100);
  EXPECT_GT(clamped.steepest, 1);
}

TEST(Convert, HeightsMadeOfNormalsGiveThemBackWithTheScaleThatIsTold) {
  Random random(1817);
  image::Image heights = image::make_image(64, 32, 1, image::Depth::float32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      heights.at(x, y, 0) =
          static_cast<float>(0.5 + 0.3 * std::sin(x * 0.0981747704) * std::cos(y * 0.392699082));
  const Form height{.kind = Kind::height};
  const Converted normals = convert(heights, {.from = height, .slope_scale = 6.5}, "h.exr");
  EXPECT_EQ(normals.slope_scale, 6.5);
  const Converted made = convert(through_file(normals.map, image::Depth::unorm16), {.to = height}, "n.png");
  const auto [low, high] =
      std::minmax_element(heights.texels.floats().begin(), heights.texels.floats().end());
  EXPECT_NEAR(made.slope_scale, 6.5 * (*high - *low), 0.01); // the heights now fill 0 to 1
  const Converted again = convert(through_file(made.map, image::Depth::unorm16),
                                  {.from = height, .slope_scale = made.slope_scale}, "h.png");
  double worst = 0;
  for (std::size_t i = 0; i < again.map.texels.size(); ++i)
    worst = std::max(worst, std::abs(double{again.map.texels[i]} - normals.map.texels[i]));
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst, 2e-4); // half a code of height, 2^-17, times the scale, twice over, and of the normals
  // With a scale heights are what they are, around 1/2.
  const Converted scaled = convert(normals.map, {.to = height, .slope_scale = 6.5}, "n.png");
  EXPECT_NEAR(scaled.map.at(10, 4, 0) - scaled.map.at(30, 9, 0), heights.at(10, 4, 0) - heights.at(30, 9, 0),
              1e-4);
}

TEST(Convert, MeanSlopeGoesWhereAsked) {
  Random random(1818);
  image::Image map = surfgrad::test::random_normal_map(random, 32, 32, 0.3);
  for (std::size_t i = 0; i < map.texels.size(); i += 3) map.texels.floats()[i] -= 0.1f;
  const Converted level = convert(map, {.retile = true, .depth = image::Depth::float32}, "n.png");
  EXPECT_NEAR(level.tilt->x, 0.2, 0.1);
  const Slopes slopes = read_slopes(level.map, {}, "n.exr");
  double sum = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) sum += slopes.map.at(x, y, 0);
  EXPECT_NEAR(sum / 1024, 0, 1e-6);
}

TEST(Convert, EightBitsAreDitheredWhereAsked) {
  image::Image map = image::make_image(64, 64, 3, image::Depth::unorm16);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      map.at(x, y, 0) = 0.6f + 0.2f / 255;
      map.at(x, y, 1) = 0.5f;
      map.at(x, y, 2) = 0.99f;
    }
  const auto mean_red = [&](bool dither) {
    const image::Image result = converted(map, {.depth = image::Depth::unorm8, .dither = dither});
    double sum = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) sum += result.at(x, y, 0);
    return sum / 4096 - (0.6 + 0.2 / 255);
  };
  EXPECT_GT(std::abs(mean_red(false)) * 255, 0.15);
  EXPECT_LT(std::abs(mean_red(true)) * 255, 0.02);
}

std::string refusal(const std::function<void()>& job) {
  try {
    job();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Convert, MapsThatCannotBeWhatTheyAreSaidToBeAreRefused) {
  image::Image grey = image::make_image(4, 4, 1);
  EXPECT_THAT(refusal([&] { (void)convert(grey, {}, "g.png"); }), HasSubstr("g.png: has one channel"));
  image::Image two = image::make_image(4, 4, 2);
  Conversion blue;
  blue.from.channels = channels_of("rgb");
  EXPECT_THAT(refusal([&] { (void)convert(two, blue, "g.png"); }),
              HasSubstr("g.png: has no channel b; it has r, g"));
  image::Image broken = image::make_image(4, 4, 3, image::Depth::float32);
  broken.at(1, 3, 2) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(refusal([&] { (void)convert(broken, {}, "n.exr"); }),
              HasSubstr("n.exr: column 1, row 0 from the top: is not a number"));
  broken.at(1, 3, 2) = std::numeric_limits<float>::infinity();
  EXPECT_THAT(refusal([&] {
                (void)convert(broken, {.from = {.kind = Kind::height, .channels = channels_of("b")}},
                              "n.exr");
              }),
              HasSubstr("is infinite"));
}

} // namespace
} // namespace surfgrad::maps
