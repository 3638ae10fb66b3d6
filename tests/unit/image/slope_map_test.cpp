// Normal map files to slopes: which channels are believed, and what a slope is.

#include "image/map.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"
#include "support/worst.hpp"

#include <surfgrad/derivative.hpp>

#include <gtest/gtest.h>

namespace surfgrad::image {
namespace {

using test::texel;

constexpr double float_eps = std::numeric_limits<float>::epsilon();

vec2<double> slope_at(const SlopeMap& slopes, int x, int y) {
  return {texel(slopes.map, 0, x, y, 0), texel(slopes.map, 0, x, y, 1)};
}

/// The vector a texel stores.
vec3<double> vector_at(const Image& map, int x, int y) {
  return {2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1,
          map.channels > 2 ? 2.0 * map.at(x, y, 2) - 1 : 1.0};
}

TEST(SlopeMap, OfThreeChannelsLeadsToTheDirectionOfTheTexelWhateverItsLength) {
  constexpr std::uint64_t seed = 11;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  Image map = make_image(64, 64, 3, Depth::unorm16);
  for (std::size_t i = 0; i < map.texels.size(); i += 3) {
    const vec3<double> u = random.unit_vector();
    const double size = random.uniform(0.2, 1.0);
    const double z = std::abs(u.z) + 0.02; // steeper ones meet the clamp
    map.texels[i] = test::stored(0.5 * size * u.x + 0.5, map.depth);
    map.texels[i + 1] = test::stored(0.5 * size * u.y + 0.5, map.depth);
    map.texels[i + 2] = test::stored(0.5 * size * z + 0.5, map.depth);
  }
  const SlopeMap slopes = make_slope_map(map, NormalChannels::xyz, true);
  EXPECT_EQ(slopes.inward_texels, 0);
  test::Worst worst("normal of the slope, three channels");
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) // A slope d rounded to float turns the normal by eps / 2 * |d| / (1 + d^2).
      worst.add(normal_from_derivative(slope_at(slopes, x, y)), normalize_or_zero(vector_at(map, x, y)),
                float_eps, y * 64 + x);
}

TEST(SlopeMap, OfTwoChannelsLeadsToTheUnitNormalWithTheseComponents) {
  constexpr std::uint64_t seed = 12;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  Image map = make_image(64, 64, 2, Depth::unorm16);
  for (std::size_t i = 0; i < map.texels.size(); i += 2) {
    const vec3<double> u = random.unit_vector();
    map.texels[i] = test::stored(0.5 * 0.999 * u.x + 0.5, map.depth);
    map.texels[i + 1] = test::stored(0.5 * 0.999 * u.y + 0.5, map.depth);
  }
  const SlopeMap slopes = make_slope_map(map, NormalChannels::automatic, true);
  EXPECT_EQ(slopes.channels, NormalChannels::xy);
  test::Worst worst("components of the slope's normal, two channels");
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const vec3<double> n = normal_from_derivative(slope_at(slopes, x, y));
      const vec3<double> m = vector_at(map, x, y);
      worst.add(vec2<double>{n.x, n.y}, vec2<double>{m.x, m.y}, float_eps, y * 64 + x);
    }
}

TEST(SlopeMap, TakesAConstantThirdChannelForAbsentUnlessTheMapIsFlat) {
  test::Random random(13);
  Image map = test::random_image(random, 8, 8, 3);
  EXPECT_EQ(make_slope_map(map, NormalChannels::automatic, true).channels, NormalChannels::xyz);
  for (std::size_t i = 2; i < map.texels.size(); i += 3) map.texels[i] = 1;
  EXPECT_EQ(make_slope_map(map, NormalChannels::automatic, true).channels, NormalChannels::xy);
  EXPECT_EQ(make_slope_map(map, NormalChannels::xyz, true).channels, NormalChannels::xyz);
  map.texels[map.texels.size() - 1] = 0.5f; // the last texel counts too
  EXPECT_EQ(make_slope_map(map, NormalChannels::automatic, true).channels, NormalChannels::xyz);

  // All texels (0.6, 0, 0.6): a tilted plane stored short. Believing x alone would give another tilt.
  const SlopeMap flat =
      make_slope_map(test::constant_image(4, 4, {0.8, 0.5, 0.8}), NormalChannels::automatic, true);
  EXPECT_EQ(flat.channels, NormalChannels::xyz);
  EXPECT_FLOAT_EQ(texel(flat.map, 0, 1, 2, 0), -1.0f);
}

TEST(SlopeMap, WithGreenDownNegatesTheSecondSlopeOnly) {
  test::Random random(14);
  const Image map = test::random_normal_map(random, 16, 8);
  const SlopeMap up = make_slope_map(map, NormalChannels::xyz, true);
  const SlopeMap down = make_slope_map(map, NormalChannels::xyz, false);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(slope_at(down, x, y).x, slope_at(up, x, y).x);
      EXPECT_EQ(slope_at(down, x, y).y, -slope_at(up, x, y).y);
    }
}

TEST(SlopeMap, CountsTexelsThatDoNotPointOutwardsAndKeepsThemWithinTheClamp) {
  Image map = test::constant_image(4, 2, {0.5, 0.5, 1});
  const auto put = [&](int x, vec3<float> v) {
    for (int c = 0; c < 3; ++c) map.at(x, 0, c) = c == 0 ? v.x : c == 1 ? v.y : v.z;
  };
  put(0, {1.0f, 0.5f, 0.5f});   // z = 0
  put(1, {1.0f, 0.25f, 0.25f}); // z < 0
  put(2, {0.5f, 0.5f, 0.5f});   // the zero vector
  put(3, {0.5f, 0.5f, 0.0f});   // (0, 0, -1)
  const SlopeMap slopes = make_slope_map(map, NormalChannels::xyz, true);
  EXPECT_EQ(slopes.inward_texels, 4);
  EXPECT_EQ(slope_at(slopes, 0, 0).x, -128);
  EXPECT_EQ(slope_at(slopes, 1, 0).x, -2); // read as |z|
  EXPECT_EQ(slope_at(slopes, 1, 0).y, 1);
  for (const int x : {2, 3}) EXPECT_EQ(max_abs(slope_at(slopes, x, 0)), 0);
}

TEST(SlopeMap, AFloatFilesTexelsThatAreNotFiniteStayFlatAndAlone) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  Image map = test::constant_image(8, 8, {0.5, 0.5, 1});
  map.at(3, 3, 0) = nan;
  map.at(5, 1, 1) = -inf;
  map.at(6, 6, 2) = inf;
  const SlopeMap slopes = make_slope_map(map, NormalChannels::xyz, true);
  EXPECT_EQ(slopes.inward_texels, 3);
  const Map directions = make_direction_map(map, true);
  const Map weights = make_channel_map(map, 0);
  for (const Map* m : {&slopes.map, &directions, &weights})
    for (const std::uint32_t word : m->words) EXPECT_TRUE(std::isfinite(std::bit_cast<float>(word)));
  EXPECT_EQ(texel(directions, 0, 3, 3, 2), 0); // no direction
}

TEST(ChannelMap, ReadsTheChannelAskedForOrTheNearestThatExists) {
  Image grey = make_image(1, 1, 1);
  grey.texels = {0.25f};
  Image grey_alpha = make_image(1, 1, 2);
  grey_alpha.has_alpha = true;
  grey_alpha.texels = {0.25f, 0.5f};
  Image rgb = make_image(1, 1, 3);
  rgb.texels = {0.125f, 0.25f, 0.375f};
  Image rgba = make_image(1, 1, 4);
  rgba.texels = {0.125f, 0.25f, 0.375f, 0.5f};
  const auto value = [](const Image& image, int channel) {
    return texel(make_channel_map(image, channel), 0, 0, 0, 0);
  };
  Image rg = grey_alpha; // two channels of data: an R,G file
  rg.has_alpha = false;
  EXPECT_EQ(value(rg, 0), 0.25f);
  EXPECT_EQ(value(rg, 1), 0.5f);
  EXPECT_EQ(value(rg, 3), 1);
  for (const int c : {0, 1, 2}) {
    EXPECT_EQ(value(grey, c), 0.25f);
    EXPECT_EQ(value(grey_alpha, c), 0.25f);
    EXPECT_EQ(value(rgb, c), 0.125f * static_cast<float>(c + 1));
    EXPECT_EQ(value(rgba, c), 0.125f * static_cast<float>(c + 1));
  }
  EXPECT_EQ(value(grey, 3), 1);
  EXPECT_EQ(value(rgb, 3), 1);
  EXPECT_EQ(value(grey_alpha, 3), 0.5f);
  EXPECT_EQ(value(rgba, 3), 0.5f);
}

TEST(ChannelMap, IsAWeightWhateverAFloatFileHolds) {
  Image map = make_image(4, 1, 1, Depth::float32);
  map.texels = {-3.0f, 7.0f, std::numeric_limits<float>::quiet_NaN(), 0.5f};
  const Map weights = make_channel_map(map, 0);
  EXPECT_EQ(texel(weights, 0, 0, 0, 0), 0);
  EXPECT_EQ(texel(weights, 0, 1, 0, 0), 1);
  EXPECT_EQ(texel(weights, 0, 2, 0, 0), 0);
  EXPECT_EQ(texel(weights, 0, 3, 0, 0), 0.5f);
}

} // namespace
} // namespace surfgrad::image
