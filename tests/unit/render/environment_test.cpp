// Panoramas: which part of the image lights which side, and how much.

#include "render/environment.hpp"

#include "support/images.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

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
  EXPECT_GT(above.specular<double>({0, 1, 0}).x, 10 * above.specular<double>({0, -1, 0}).x);
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
  surfgrad::test::Worst worst("diffuse light of a hemisphere");
  for (int k = 0; k < 2000; ++k) {
    const vec3<double> n = random.unit_vector();
    // A line, so that only the cube's edges count: sample_cube's h / (4 sqrt(3)) beside them for a slope of
    // 1, with h = 1 / 16 and a slope of 0.5; and 0.001 for the patches.
    worst.add(environment.diffuse(n).y, 0.5 * (1 + n.y), 0.0055, k);
  }
}

/// Where a texel of a panorama is seen, y up, the middle column towards -z and x to its right.
vec3<double> seen_at(double column, double row, int across, int up) {
  const double azimuth = 2 * std::numbers::pi * (column + 0.5) / across;
  const double elevation = std::numbers::pi * ((row + 0.5) / up - 0.5);
  return {-std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

TEST(Environment, IsTheWeightedMeanOfItsPanorama) {
  constexpr std::uint64_t seed = 255;
  SCOPED_TRACE(seed);
  surfgrad::test::Random random(seed);
  constexpr int across = 128;
  constexpr int up = 64;
  constexpr double roughness = 0.36;
  constexpr double alpha = roughness * roughness;
  // Noise, and a sun of 100 that one texel holds.
  image::Image map = surfgrad::test::random_image(random, across, up, 3, image::Depth::float32);
  for (int c = 0; c < 3; ++c) map.at(40, 45, c) = 100;
  const vec3<double> sun = seen_at(40, 45, across, up);
  const Environment environment(map, roughness);
  const auto mean = [&](vec3<double> direction, auto weight) {
    vec3<double> sum{0, 0, 0};
    double total = 0;
    for (int y = 0; y < up; ++y)
      for (int x = 0; x < across; ++x) {
        const vec3<double> d = seen_at(x, y, across, up);
        const double w = weight(dot(d, direction)) * std::sqrt(1 - d.y * d.y);
        sum = sum + w * vec3<double>{map.at(x, y, 0), map.at(x, y, 1), map.at(x, y, 2)};
        total += w;
      }
    return (1 / total) * sum;
  };
  const auto cosine = [](double c) { return std::max(c, 0.0); };
  const auto ggx = [&](double c) {
    const double base = 0.5 * (1 + c) * (alpha * alpha - 1) + 1;
    return c > 0 ? alpha * alpha / (base * base) * c : 0;
  };
  surfgrad::test::Worst diffuse("diffuse light against the sum over the panorama");
  surfgrad::test::Worst specular("reflected light against the sum over the panorama");
  for (int k = 0; k < 300; ++k) {
    const vec3<double> d =
        k % 3 == 0 ? normalize_or_zero(sun + 0.2 * random.vector3()) : random.unit_vector();
    const vec3<double> soft = mean(d, cosine);
    const vec3<double> sharp = mean(d, ggx);
    // Linear interpolation between texels that are h = 1 / 16 wide misses h^2 / 8 of a second derivative:
    // 0.025 at the peak of a lobe with a standard deviation of 0.14. Of the cosine it misses less, but h / 8
    // where that bends into the night, for a lamp that sends under half of the light.
    diffuse.add(environment.diffuse(d), soft, 0.004 * max_abs(soft), k);
    specular.add(environment.specular(d), sharp, 0.025 * max_abs(sharp), k);
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
  for (const double odd : {double{nan}, double{inf}, 1e300})
    (void)environment.diffuse<double>({odd, odd, -odd});
}

TEST(Environment, OfGreyImagesIsGrey) {
  image::Image map = image::make_image(8, 4, 1, image::Depth::float32);
  for (float& t : map.texels.floats()) t = 0.75f;
  const vec3<double> got = Environment(map, 0.5).diffuse<double>({0, 1, 0});
  EXPECT_NEAR(got.x, 0.75, 1e-6);
  EXPECT_NEAR(got.z, 0.75, 1e-6);
}

TEST(BuiltInSky, IsBrighterAboveThanBelow) {
  const Environment sky(built_in_sky(), 0.5);
  EXPECT_GT(sky.diffuse<double>({0, 1, 0}).y, 2 * sky.diffuse<double>({0, -1, 0}).y);
  EXPECT_NEAR(sky.diffuse<double>({1, 0, 0}).x, sky.diffuse<double>({0, 0, -1}).x,
              1e-3); // the same all round
}

} // namespace
} // namespace surfgrad::render
