// What an inspection says of maps that are made for it.

#include "maps/inspect.hpp"

#include "maps/convert.hpp"
#include "support/images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfgrad::maps {
namespace {

using surfgrad::test::Random;
using surfgrad::test::stored;
using testing::ElementsAre;
using testing::IsEmpty;

/// Bumps that repeat, as heights.
image::Image bumps(int side) {
  Random random(1821);
  image::Image heights = image::make_image(side, side, 1, image::Depth::float32);
  for (int n = 0; n < 12; ++n) {
    const int k = 1 + static_cast<int>(random.uniform(0, 5));
    const int l = static_cast<int>(random.uniform(-5, 6));
    const double phase = random.uniform(0, 6);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        heights.at(x, y, 0) +=
            static_cast<float>(std::sin(2 * std::numbers::pi * (k * x + l * y) / side + phase));
  }
  return heights;
}

/// Their normal map as a file has it.
image::Image normals_of(const image::Image& heights, Conversion conversion = {}, double slope_scale = 0.5) {
  conversion.from.kind = Kind::height;
  conversion.slope_scale = slope_scale;
  image::Image map = convert(heights, conversion, "h").map;
  map.depth = conversion.depth;
  for (float& v : map.texels.floats()) v = stored(v, conversion.depth);
  return map;
}

TEST(Inspect, GreenIsFoundByTheCurlAndAReliefTurnedOverHasTheSame) {
  for (const stack::Green green : {stack::Green::up, stack::Green::down})
    for (const bool is_turned : {false, true}) {
      Conversion conversion;
      conversion.to.green = green;
      conversion.from.is_depth = is_turned;
      const Inspection found = inspect(normals_of(bumps(64), conversion), nullptr, "n.png");
      EXPECT_EQ(found.look, Look::tangent_normals);
      EXPECT_EQ(found.green.confidence, Confidence::certain);
      EXPECT_EQ(found.green.green, green);
      EXPECT_GT(std::abs(found.green.agreement), 0.99);
    }
}

TEST(Inspect, CannotTellOfMapsWithoutAnyOrWithoutOneSurface) {
  Random random(1822);
  const image::Image flat = surfgrad::test::constant_image(64, 64, {0.5, 0.5, 1});
  const image::Image noise = surfgrad::test::random_normal_map(random, 64, 64, 0.7);
  image::Image ridges = image::make_image(64, 64, 1, image::Depth::float32);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) ridges.at(x, y, 0) = static_cast<float>(std::sin(x * 0.589));
  for (const image::Image& map :
       {flat, noise, normals_of(ridges), surfgrad::test::constant_image(64, 64, {0.7, 0.6, 0.9})})
    EXPECT_EQ(inspect(map, nullptr, "n.png").green.confidence, Confidence::cannot_tell);
  EXPECT_THAT(inspect(flat, nullptr, "n.png").constant_channels, ElementsAre(0, 1, 2));
}

TEST(Inspect, ObjectSpaceColoursAndHeightsAreToldApart) {
  Random random(1823);
  image::Image sphere = image::make_image(64, 64, 3, image::Depth::unorm8);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double a = 0.1 * x;
      const double b = std::numbers::pi * (y + 0.5) / 64;
      const double n[] = {std::cos(a) * std::sin(b), std::sin(a) * std::sin(b), std::cos(b)};
      for (int c = 0; c < 3; ++c) sphere.at(x, y, c) = stored(0.5 * n[c] + 0.5, image::Depth::unorm8);
    }
  EXPECT_EQ(inspect(sphere, nullptr, "n.png").look, Look::other_normals);
  EXPECT_EQ(inspect(surfgrad::test::random_image(random, 32, 32, 3), nullptr, "n.png").look,
            Look::no_normals);
  EXPECT_EQ(inspect(surfgrad::test::random_image(random, 32, 32, 1), nullptr, "n.png").look, Look::heights);
}

TEST(Inspect, TiltLengthsInwardTexelsAndSlopesAreMeasured) {
  image::Image map = surfgrad::test::constant_image(40, 40, {0.5 + 0.5 * -0.28, 0.5, 0.5 + 0.5 * 0.96});
  for (int x = 0; x < 40; ++x) map.at(x, 7, 2) = 0.4f; // z = -0.2
  const Inspection found = inspect(map, nullptr, "n.png");
  EXPECT_EQ(found.inward, 40);
  // 39 of 40 rows have the slope 7 / 24, the rest 0.28 / 0.2: vectors are read as if they pointed outward.
  EXPECT_NEAR(found.tilt.x, 7.0 / 24 * 39 / 40 + 1.4 / 40, 1e-4);
  EXPECT_NEAR(found.steepest, 1.4, 1e-6);
  EXPECT_NEAR(found.mean_length, (39 + std::hypot(0.28, 0.2)) / 40, 1e-5);
  EXPECT_NEAR(found.unit_share, 39.0 / 40, 1e-9);
}

TEST(Inspect, EightBitsInAFileOfSixteenAreSeen) {
  const image::Image heights = bumps(64);
  image::Image narrow = normals_of(heights, {.depth = image::Depth::unorm8});
  EXPECT_FALSE(inspect(narrow, nullptr, "n.png").is_banded); // a file of 8 bits has no more
  narrow.depth = image::Depth::unorm16;
  EXPECT_TRUE(inspect(narrow, nullptr, "n.png").is_banded);
  EXPECT_FALSE(inspect(normals_of(heights), nullptr, "n.png").is_banded);
}

TEST(Inspect, SeamsAreSeenAlongTheirAxis) {
  const image::Image whole = normals_of(bumps(96));
  const Inspection repeated = inspect(whole, nullptr, "n.png");
  EXPECT_TRUE(repeated.along_s.repeats);
  EXPECT_TRUE(repeated.along_t.repeats);
  EXPECT_EQ(repeated.along_s.confidence, Confidence::certain);
  // A part of it, cut off along s.
  image::Image cut = image::make_image(67, 96, 3, image::Depth::unorm16);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 67; ++x)
      for (int c = 0; c < 3; ++c) cut.at(x, y, c) = whole.at(x, y, c);
  const Inspection torn = inspect(cut, nullptr, "n.png");
  EXPECT_FALSE(torn.along_s.repeats);
  EXPECT_EQ(torn.along_s.confidence, Confidence::certain);
  EXPECT_TRUE(torn.along_t.repeats);
  Random random(1824);
  EXPECT_EQ(inspect(surfgrad::test::random_normal_map(random, 64, 64), nullptr, "n.png").along_s.confidence,
            Confidence::cannot_tell);
}

TEST(Inspect, HeightsGiveTheScaleTheReliefAndTheGreen) {
  const image::Image heights = bumps(64);
  for (const stack::Green green : {stack::Green::up, stack::Green::down})
    for (const bool is_turned : {false, true}) {
      Conversion conversion;
      conversion.kernel = Kernel::central;
      conversion.to.green = green;
      conversion.from.is_depth = is_turned;
      const Inspection found = inspect(normals_of(heights, conversion, 0.25), &heights, "n.png");
      ASSERT_TRUE(found.heights);
      EXPECT_EQ(found.heights->confidence, Confidence::certain);
      EXPECT_EQ(found.heights->green, green);
      EXPECT_EQ(found.heights->is_inverted, is_turned);
      EXPECT_NEAR(found.heights->scale, 0.25, 1e-3);
    }
}

TEST(Inspect, HiddenRoughnessGrowsToThatOfAllSlopes) {
  const image::Image map = normals_of(bumps(64));
  const Inspection found = inspect(map, nullptr, "n.png");
  ASSERT_EQ(found.hidden_roughness.size(), 6u);
  for (std::size_t i = 1; i < 6; ++i) EXPECT_GT(found.hidden_roughness[i], found.hidden_roughness[i - 1]);
  // A single texel hides all normals but their mean.
  vec3<double> mean{0, 0, 0};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      mean = mean + normalize_or_zero(vec3<double>{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1,
                                                   2.0 * map.at(x, y, 2) - 1});
  mean = (1.0 / (map.width * map.height)) * mean;
  EXPECT_NEAR(found.hidden_roughness[5], std::pow(1 - dot(mean, mean), 0.25), 1e-3);
  EXPECT_THAT(inspect(surfgrad::test::constant_image(1, 1, {0.5, 0.5, 1}), nullptr, "n.png").hidden_roughness,
              IsEmpty());
}

} // namespace
} // namespace surfgrad::maps
