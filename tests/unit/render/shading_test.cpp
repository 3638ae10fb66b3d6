// The glazed body: no more light comes out than goes in.

#include "render/shading.hpp"

#include "support/images.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace surfgrad::render {
namespace {

using surfgrad::test::Random;

stack::Lights lights(double sun, double sky, vec3<double> to_sun = {0, 0, 1}) {
  stack::Lights result;
  result.sun = stack::Sun{to_sun, sun};
  result.sky = sky;
  return result;
}

const image::Image white = surfgrad::test::constant_image(2, 2, {1, 1, 1});

vec3<double> towards(double cosine, double azimuth) {
  const double s = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {s * std::cos(azimuth), s * std::sin(azimuth), cosine};
}

TEST(Shading, UnderAWhiteSkyReturnsNoMoreThanWhite) {
  const Shading shading(lights(0, 1), &white);
  double least = 1;
  double most = 0;
  for (int i = 0; i <= 1000; ++i) {
    const vec3<double> c = shading({0, 0, 1}, towards(i / 1000.0, 0.3));
    least = std::min({least, c.x, c.y, c.z});
    most = std::max({most, c.x, c.y, c.z});
  }
  std::printf("  white sky returns %.3f to %.3f\n", least, most);
  EXPECT_LE(most, 1);
  EXPECT_GT(least, 0.3); // a light body, not a black one
}

TEST(Shading, OfASunFromAnywhereReturnsNoMoreThanItSends) {
  // The sun integrated over the hemisphere is a white sky. Instead of the sun the surface is turned.
  const Shading sun(lights(1, 0), &white);
  const Shading sky(lights(0, 1), &white);
  constexpr int rings = 200;
  constexpr int spokes = 200;
  for (const double cos_view : {1.0, 0.7, 0.3, 0.08}) {
    const vec3<double> v = towards(cos_view, 0);
    vec3<double> sum{0, 0, 0};
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < spokes; ++j) {
        const vec3<double> l = towards((i + 0.5) / rings, 2 * std::numbers::pi * (j + 0.5) / spokes);
        const vec3<double> x = normalize_or_zero(cross(vec3<double>{0.3, 0.5, 0.8}, l));
        const mat3<double> turn{x, cross(l, x), l}; // takes l to +z, where the sun is
        sum = sum + sun(turn * vec3<double>{0, 0, 1}, turn * v);
      }
    const vec3<double> returned = (2 * std::numbers::pi / (rings * spokes)) * sum;
    const vec3<double> of_sky = sky({0, 0, 1}, v);
    std::printf("  cosine %.2f: sun returns %.3f, sky %.3f\n", cos_view, returned.x, of_sky.x);
    EXPECT_LE(max_abs(returned), 1);
    // The material is one for both lights; its body takes the sky's Fresnel factor for either.
    EXPECT_NEAR(returned.x, of_sky.x, 0.02);
  }
}

TEST(Shading, HasTheHighlightOfGgx) {
  // Seen along the normal the reflection of a sun there is f0 D / 4 with D = 1 / (pi alpha^2), for a
  // roughness of 0.36 and 5 percent at normal incidence; of a sun 60 degrees away next to nothing.
  const vec3<double> n{0, 0, 1};
  const double peak = Shading(lights(1, 0, n), &white)(n, n).x;
  const double aside = Shading(lights(1, 0, towards(0.5, 0)), &white)(n, n).x / 0.5;
  const double alpha = 0.36 * 0.36;
  EXPECT_NEAR(peak - aside, 0.05 / (4 * std::numbers::pi * alpha * alpha), 3e-3); // the rest at 60 degrees
}

TEST(Shading, ScalesWithItsLights) {
  const vec3<double> n = towards(0.9, 1);
  const vec3<double> v = towards(0.8, -1);
  const vec3<double> one = Shading(lights(1, 0), &white)(n, v);
  const vec3<double> three = Shading(lights(3, 0), &white)(n, v);
  EXPECT_NEAR(three.x, 3 * one.x, 1e-12);
  const vec3<double> sky = Shading(lights(0, 1), &white)(n, v);
  EXPECT_NEAR(Shading(lights(3, 1), &white)(n, v).y, three.y + sky.y, 1e-12);
  EXPECT_EQ(max_abs(Shading(lights(3, 0, -n), &white)(n, v)), 0);
}

TEST(Shading, AnEnvironmentReplacesTheDefaultSunButNotOneThatIsNamed) {
  const vec3<double> n{0, 0, 1};
  stack::Lights unnamed;
  const vec3<double> by_default = Shading(unnamed, nullptr)(n, n);
  unnamed.sky = 0;
  EXPECT_EQ(max_abs(Shading(unnamed, &white)(n, n)), 0);
  EXPECT_GT(Shading(unnamed, nullptr)(n, n).x, 0.1);
  EXPECT_GT(by_default.x, Shading(unnamed, nullptr)(n, n).x); // the built-in sky shines, too
  EXPECT_GT(Shading(lights(1, 0), &white)(n, n).x, 0.1);
}

TEST(Shading, IsFiniteForEveryNormalIncludingThoseThatFaceAway) {
  Random random(261);
  const Shading shading(lights(3, 1), &white);
  for (int k = 0; k < 5000; ++k) {
    const vec3<double> v = random.unit_vector();
    const vec3<double> n = k % 10 == 0 ? -v : k % 10 == 1 ? vec3<double>{0, 0, 0} : random.unit_vector();
    const vec3<double> c = shading(n, v);
    EXPECT_TRUE(std::isfinite(c.x + c.y + c.z) && c.x >= 0 && c.y >= 0 && c.z >= 0);
  }
}

TEST(DisplayValue, RisesFromBlackToWhiteWithoutAStep) {
  EXPECT_EQ(display_value(0), 0);
  EXPECT_EQ(display_value(-1), 0);
  EXPECT_NEAR(display_value(1e9), 1, 1e-6);
  double last = 0;
  for (int i = 1; i <= 20000; ++i) {
    const double y = display_value(i * 1e-4);
    EXPECT_GT(y, last);
    EXPECT_LT(y - last, 2e-3); // the sRGB curve's slope of 12.92 at black
    EXPECT_LE(y, 1);
    last = y;
  }
  EXPECT_NEAR(display_value(0.214041), 0.5, 1e-4); // sRGB's middle grey
}

} // namespace
} // namespace surfgrad::render
