// Panoramas: which part of the image lights which side, and how much.

#include "render/environment.hpp"

#include "support/images.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace surfgrad::render {
namespace {

constexpr int width = 64;
constexpr int height = 32;

/// Black but for a bright patch around a column and row.
image::Image patch(int column, int row) {
  image::Image map = image::make_image(width, height, 3, image::Depth::float32);
  for (int y = std::max(0, row - 2); y < std::min(height, row + 2); ++y)
    for (int x = column - 2; x < column + 2; ++x)
      for (int c = 0; c < 3; ++c) map.at((x + width) % width, y, c) = 10;
  return map;
}

TEST(Environment, LightsTheSideThatItsImageShowsThere) {
  struct Place {
    int column;
    int row;
    vec3<double> direction;
  };
  // The middle column towards -z, as a camera looks; further right towards +x; the top row up.
  for (const Place& p : {Place{32, 16, {0, 0, -1}}, Place{48, 16, {1, 0, 0}}, Place{0, 16, {0, 0, 1}},
                         Place{16, 16, {-1, 0, 0}}, Place{40, 24, {0.5, std::sqrt(0.5), -0.5}}}) {
    const Environment environment(patch(p.column, p.row), 0.3);
    const double ahead = environment.specular(p.direction).x;
    EXPECT_GT(ahead, 1) << p.column;
    EXPECT_GT(environment.diffuse(p.direction).x, 0.9 * environment.diffuse(p.direction).y);
    surfgrad::test::Random random(251);
    for (int k = 0; k < 200; ++k) {
      const vec3<double> other = random.unit_vector();
      if (dot(other, p.direction) > 0.8) continue;
      EXPECT_LT(environment.specular(other).x, ahead);
      EXPECT_LT(environment.diffuse(other).x, environment.diffuse(p.direction).x);
    }
  }
  const image::Image top = [] {
    image::Image map = image::make_image(width, height, 3, image::Depth::float32);
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) map.at(x, height - 1, c) = 10;
    return map;
  }();
  const Environment above(top, 0.3);
  EXPECT_GT(above.specular({0, 1, 0}).x, 10 * above.specular({0, -1, 0}).x);
}

TEST(Environment, OfOneColourIsThatColourEverywhereAtAnySize) {
  surfgrad::test::Random random(252);
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {3, 5}, {64, 32}, {130, 70}, {512, 256}}) {
    const Environment environment(surfgrad::test::constant_image(w, h, {0.25, 0.5, 1}), 0.36);
    for (int k = 0; k < 100; ++k) {
      const vec3<double> d = random.unit_vector();
      for (const vec3<double>& got : {environment.diffuse(d), environment.specular(d)})
        EXPECT_LT(max_abs(got - vec3<double>{0.25, 0.5, 1}), 1e-6) << w << "x" << h; // float texels
    }
  }
}

TEST(Environment, DiffuseLightIsTheCosineWeightedMean) {
  // Radiance 1 above the horizon, 0 below: irradiance / pi is (1 + cos) / 2 of the tilt.
  image::Image map = image::make_image(128, 64, 3, image::Depth::float32);
  for (int y = 32; y < 64; ++y)
    for (int x = 0; x < 128; ++x)
      for (int c = 0; c < 3; ++c) map.at(x, y, c) = 1;
  const Environment environment(map, 0.5);
  surfgrad::test::Random random(253);
  for (int k = 0; k < 200; ++k) {
    const vec3<double> n = random.unit_vector();
    // Between texels of 5.6 degrees linear interpolation misses the cosine by 0.12 percent.
    EXPECT_NEAR(environment.diffuse(n).y, 0.5 * (1 + n.y), 3e-3);
  }
}

TEST(Environment, SurvivesTexelsThatAreNoNumbers) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  image::Image map = surfgrad::test::constant_image(64, 32, {0.5, 0.5, 0.5});
  map.at(3, 3, 0) = nan;
  map.at(5, 20, 1) = inf;
  map.at(7, 9, 2) = -inf;
  const Environment environment(map, 0.36);
  surfgrad::test::Random random(254);
  for (int k = 0; k < 100; ++k) {
    const vec3<double> d = random.unit_vector();
    for (const vec3<double>& got : {environment.diffuse(d), environment.specular(d)}) {
      EXPECT_TRUE(got.x >= 0 && got.y >= 0 && got.z >= 0);
      EXPECT_TRUE(std::isfinite(got.x + got.y + got.z));
    }
  }
  EXPECT_GT(environment.specular(normalize_or_zero(vec3<double>{-0.5, 0.4, 0.75})).y,
            1); // the sun stays bright
  // Must read inside the image; that it does is for AddressSanitizer to see.
  for (const double odd : {double{nan}, double{inf}, 1e300}) (void)environment.diffuse({odd, odd, -odd});
}

TEST(Environment, OfGreyImagesIsGrey) {
  image::Image map = image::make_image(8, 4, 1, image::Depth::float32);
  for (float& t : map.texels) t = 0.75f;
  const vec3<double> got = Environment(map, 0.5).diffuse({0, 1, 0});
  EXPECT_NEAR(got.x, 0.75, 1e-6);
  EXPECT_NEAR(got.z, 0.75, 1e-6);
}

TEST(BuiltInSky, IsBrighterAboveThanBelow) {
  const Environment sky(built_in_sky(), 0.5);
  EXPECT_GT(sky.diffuse({0, 1, 0}).y, 2 * sky.diffuse({0, -1, 0}).y);
  EXPECT_NEAR(sky.diffuse({1, 0, 0}).x, sky.diffuse({0, 0, -1}).x, 1e-3); // the same all round
}

} // namespace
} // namespace surfgrad::render
