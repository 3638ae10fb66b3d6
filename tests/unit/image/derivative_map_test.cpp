// Derivative map files to slopes: codes, ranges, and where flat lies.

#include "image/map.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace surfgrad::image {
namespace {

using test::texel;

vec2<double> slope_at(const Map& map, int x, int y) {
  return {texel(map, 0, x, y, 0), texel(map, 0, x, y, 1)};
}

/// One texel of the given codes.
Image of_codes(Depth depth, int red, int green) {
  Image image = make_image(1, 1, 2, depth);
  image.texels = {static_cast<float>(red / test::most_code(depth)),
                  static_cast<float>(green / test::most_code(depth))};
  return image;
}

/// A code as loaded is right to half an ulp of 1; twice the range over the codes' middle enlarges that.
constexpr double decoded_eps = 2 * std::numeric_limits<float>::epsilon();

TEST(DerivativeMap, SpansTheRangeFromTheFirstToTheLastCode) {
  for (const Depth depth : {Depth::unorm8, Depth::unorm16}) {
    const int most = static_cast<int>(test::most_code(depth));
    const vec2<double> ends = slope_at(make_derivative_map(of_codes(depth, 0, most), 3.5, true), 0, 0);
    EXPECT_EQ(ends.x, -3.5);
    EXPECT_EQ(ends.y, 3.5);
    const vec2<double> middle =
        slope_at(make_derivative_map(of_codes(depth, most / 2, most / 2 + 1), 3.5, true), 0, 0);
    EXPECT_NEAR(middle.x, -3.5 / most, 3.5 * decoded_eps); // half a code below and above flat
    EXPECT_NEAR(middle.y, 3.5 / most, 3.5 * decoded_eps);
  }
}

TEST(DerivativeMap, WithAWholeNeutralCodeIsFlatThereAndStillSpansTheRange) {
  for (const Depth depth : {Depth::unorm8, Depth::unorm16}) {
    const int most = static_cast<int>(test::most_code(depth));
    const auto decoded = [&](int red, int green) {
      return slope_at(make_derivative_map(of_codes(depth, red, green), 2, true, NeutralCode::whole), 0, 0);
    };
    EXPECT_NEAR(decoded(most / 2 + 1, most).x, 0, 2 * decoded_eps);
    EXPECT_NEAR(decoded(most / 2 + 1, most).y, 2, 2 * decoded_eps);
    EXPECT_NEAR(decoded(0, 1).x, -2, 2 * decoded_eps);
    EXPECT_NEAR(decoded(0, 1).y, -2, 2 * decoded_eps);
    EXPECT_NEAR(decoded(most / 2 + 2, most / 2).x, 2.0 / (most / 2), 2 * decoded_eps);
    EXPECT_NEAR(decoded(most / 2 + 2, most / 2).y, -2.0 / (most / 2), 2 * decoded_eps);
  }
}

TEST(DerivativeMap, OfAFloatFileHoldsSlopesTimesTheRange) {
  for (const Depth depth : {Depth::half, Depth::float32}) {
    Image image = make_image(2, 1, 3, depth);
    image.texels = {-1.5f, 0.25f, 9, 0, 3, 9};
    for (const NeutralCode neutral : {NeutralCode::between, NeutralCode::whole}) {
      const Map map = make_derivative_map(image, 2, true, neutral);
      EXPECT_EQ(slope_at(map, 0, 0).x, -3);
      EXPECT_EQ(slope_at(map, 0, 0).y, 0.5);
      EXPECT_EQ(slope_at(map, 1, 0).x, 0);
      EXPECT_EQ(slope_at(map, 1, 0).y, 6);
    }
  }
}

TEST(DerivativeMap, WithGreenDownNegatesTheSecondSlopeOnly) {
  test::Random random(31);
  const Image image = test::random_image(random, 8, 4, 2);
  const Map up = make_derivative_map(image, 4, true);
  const Map down = make_derivative_map(image, 4, false);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(slope_at(down, x, y).x, slope_at(up, x, y).x);
      EXPECT_EQ(slope_at(down, x, y).y, -slope_at(up, x, y).y);
    }
}

TEST(DerivativeMap, ShortensSteepSlopesAlongTheirDirectionAndFlattensWhatIsNotFinite) {
  Image image = make_image(4, 1, 2, Depth::float32);
  image.texels = {-1024, 512, std::numeric_limits<float>::quiet_NaN(),
                  1,     2,   std::numeric_limits<float>::infinity(),
                  128,   -127};
  const Map map = make_derivative_map(image, 1, true);
  EXPECT_EQ(slope_at(map, 0, 0).x, -128);
  EXPECT_EQ(slope_at(map, 0, 0).y, 64);
  for (const int x : {1, 2}) EXPECT_EQ(max_abs(slope_at(map, x, 0)), 0);
  EXPECT_EQ(slope_at(map, 3, 0).x, 128);
  EXPECT_EQ(slope_at(map, 3, 0).y, -127);
}

TEST(DerivativeMap, AgreesWithTheNormalMapOfTheSameSlopes) {
  constexpr std::uint64_t seed = 32;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  Image slopes = make_image(16, 16, 2, Depth::float32);
  Image normals = make_image(16, 16, 3, Depth::float32);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const vec2<double> d = random.vector2(-2, 2);
      slopes.at(x, y, 0) = static_cast<float>(d.x);
      slopes.at(x, y, 1) = static_cast<float>(d.y);
      const vec3<double> n = normalize_or_zero(vec3<double>{-d.x, -d.y, 1});
      normals.at(x, y, 0) = static_cast<float>(0.5 * n.x + 0.5);
      normals.at(x, y, 1) = static_cast<float>(0.5 * n.y + 0.5);
      normals.at(x, y, 2) = static_cast<float>(0.5 * n.z + 0.5);
    }
  const Map derivative = make_derivative_map(slopes, 1, false);
  const SlopeMap normal = make_slope_map(normals, NormalChannels::xyz, false);
  test::Worst worst("derivative map against normal map");
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) // A component rounded by eps / 2, over z >= 1/3, for slopes up to 2: 9 eps.
      worst.add(slope_at(derivative, x, y), {texel(normal.map, 0, x, y, 0), texel(normal.map, 0, x, y, 1)},
                9 * std::numeric_limits<float>::epsilon(), 16 * y + x);
}

} // namespace
} // namespace surfgrad::image
