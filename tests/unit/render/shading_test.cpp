// The glazed body: its formulas, and that no more light comes out than goes in.

#include "render/shading.hpp"

#include "simd/emulated_lanes.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <vector>

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

vec3<double> lit(const Shading& shading, vec3<double> normal, vec3<double> to_viewer) {
  return shade(shading, normal, to_viewer, 1.0);
}

/// GGX distribution, height-correlated Smith visibility and Schlick's Fresnel factor as their papers have
/// them: what the glaze returns of a light, per cosine.
double textbook_gloss(vec3<double> n, vec3<double> v, vec3<double> l) {
  constexpr double alpha2 = 0.36 * 0.36 * 0.36 * 0.36;
  const vec3<double> h = normalize_or_zero(l + v);
  const double nh = dot(n, h);
  const double nv = std::max(dot(n, v), 1e-4);
  const double nl = dot(n, l);
  const double base = nh * nh * (alpha2 - 1) + 1;
  const double distribution = alpha2 / (std::numbers::pi * base * base);
  const auto masking = [&](double c) { // Lambda
    return 0.5 * (std::sqrt(1 + alpha2 * (1 - c * c) / (c * c)) - 1);
  };
  const double geometry = 1 / (1 + masking(nv) + masking(nl));
  const double fresnel = 0.05 + 0.95 * std::pow(1 - dot(h, v), 5);
  return fresnel * distribution * geometry / (4 * nv * nl);
}

TEST(Shading, OfASunIsTheTextbooksFormula) {
  constexpr std::uint64_t seed = 262;
  SCOPED_TRACE(seed);
  Random random(seed);
  surfgrad::test::Worst worst("radiance against the textbook's formula");
  for (int k = 0; k < 20000; ++k) {
    const vec3<double> l = random.unit_vector();
    const vec3<double> n = random.unit_vector();
    // Half of the views near the highlight.
    const vec3<double> v =
        k % 2 == 0 ? random.unit_vector() : normalize_or_zero(2 * dot(n, l) * n - l + 0.2 * random.vector3());
    if (dot(n, l) <= 0) continue;
    const Shading shading(lights(2, 0, l), nullptr);
    const double mirrored = shading.mirrored(std::clamp(dot(n, v), 0.0, 1.0));
    const double gloss = textbook_gloss(n, v, l);
    const double sunlight = random.uniform(0, 1);
    const vec3<double> matte = ((1 - mirrored) / std::numbers::pi) * vec3<double>{0.37, 0.32, 0.28};
    const vec3<double> expected = (2 * sunlight * dot(n, l)) * (matte + vec3<double>{gloss, gloss, gloss});
    // 1 / alpha^2 = 60 times a few roundings of 1e-16; grazing views add the inverse of their cosine.
    const double bound = 1e-12 * std::max(1.0, max_abs(expected));
    worst.add(shade(shading, n, v, sunlight), expected, bound, k);
  }
}

TEST(Shading, MirrorsWhatTheGlazeReturnsOfAWhiteSky) {
  const Shading shading(lights(1, 0), nullptr);
  surfgrad::test::Worst worst("share of a white sky that the glaze mirrors");
  constexpr int rings = 400;
  constexpr int spokes = 400;
  for (const double cos_view : {1.0, 0.87, 0.5, 0.3, 0.11, 0.05}) {
    const vec3<double> v = towards(cos_view, 0);
    double sum = 0;
    for (int i = 0; i < rings; ++i)
      for (int j = 0; j < spokes; ++j) {
        const vec3<double> l = towards((i + 0.5) / rings, 2 * std::numbers::pi * (j + 0.5) / spokes);
        sum += textbook_gloss({0, 0, 1}, v, l) * l.z;
      }
    // A table of 65 entries from 2304 half vectors each: a code of 8 bits at most.
    worst.add(shading.mirrored(cos_view), 2 * std::numbers::pi / (rings * spokes) * sum, 1.0 / 255,
              static_cast<long>(100 * cos_view));
  }
}

struct Case {
  vec3<float> normal, to_viewer;
  float sunlight;
};

vec3<float> as_float(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
vec3<double> as_double(vec3<float> v) { return {v.x, v.y, v.z}; }

std::vector<Case> random_cases(Random& random, int count, vec3<double> to_sun) {
  std::vector<Case> cases;
  for (int k = 0; k < count; ++k) {
    const vec3<double> n = random.unit_vector();
    const vec3<double> v = k % 2 == 0
                               ? random.unit_vector()
                               : normalize_or_zero(2 * dot(n, to_sun) * n - to_sun + 0.1 * random.vector3());
    cases.push_back({as_float(n), as_float(v), static_cast<float>(random.uniform(0, 1))});
  }
  return cases;
}

const vec3<double> tilted_sun = normalize_or_zero(vec3<double>{0.3, 0.8, 0.5});

TEST(Shading, InFloatKeepsItsBound) {
  constexpr std::uint64_t seed = 263;
  SCOPED_TRACE(seed);
  Random random(seed);
  const Shading shading(lights(1, 0, tilted_sun), nullptr);
  constexpr double eps = std::numeric_limits<float>::epsilon();
  surfgrad::test::Worst worst("sunlight in float");
  long k = 0;
  for (const Case& c : random_cases(random, 50000, tilted_sun)) {
    const vec3<double> n = as_double(c.normal);
    const vec3<double> v = as_double(c.to_viewer);
    const double cos_light = dot(n, tilted_sun);
    if (cos_light < 1e-5) continue;
    const double cos_view = std::max(dot(n, v), 1e-4);
    const vec3<double> expected = shade<double>(shading, n, v, c.sunlight);
    const vec3<double> got = as_double(shade(shading, c.normal, c.to_viewer, c.sunlight));
    const double bound = 4 / cos_view + 4 / cos_light + 800 / length(v + tilted_sun); // as shade states
    worst.add(got, expected, bound * eps * max_abs(expected), k++);
  }
}

TEST(Shading, InLanesHasTheSameBytesAsInFloatAndIsFinite) {
  using Lanes = simd::EmulatedFloat;
  constexpr std::uint64_t seed = 264;
  SCOPED_TRACE(seed);
  Random random(seed);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const vec3<float> up{0, 1, 0};
  const vec3<float> sun = as_float(tilted_sun);
  for (const auto& [sun_strength, sky_strength] : {std::pair{3.0, 1.0}, {3.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}}) {
    const Shading shading(lights(sun_strength, sky_strength, tilted_sun), nullptr);
    std::vector<Case> cases = random_cases(random, 4000, tilted_sun);
    for (const vec3<float>& odd :
         {vec3<float>{0, 0, 0}, vec3<float>{nan, 0, 1}, -sun, sun, vec3<float>{0, -1, 0}, up}) {
      cases.insert(cases.begin() + random.integer(4000), {odd, up, 1});
      cases.insert(cases.begin() + random.integer(4000), {up, odd, 0});
      cases.insert(cases.begin() + random.integer(4000), {odd, odd, 1});
      cases.insert(cases.begin() + random.integer(4000), {odd, -odd, 0.5f});
    }
    for (std::size_t first = 0; first + simd::emulated_width <= cases.size(); first += simd::emulated_width) {
      vec3<Lanes> n;
      vec3<Lanes> v;
      Lanes sunlight;
      for (int i = 0; i < simd::emulated_width; ++i) {
        const Case& c = cases[first + i];
        n.x.lane[i] = c.normal.x;
        n.y.lane[i] = c.normal.y;
        n.z.lane[i] = c.normal.z;
        v.x.lane[i] = c.to_viewer.x;
        v.y.lane[i] = c.to_viewer.y;
        v.z.lane[i] = c.to_viewer.z;
        sunlight.lane[i] = c.sunlight;
      }
      const vec3<Lanes> got = shade(shading, n, v, sunlight);
      for (int i = 0; i < simd::emulated_width; ++i) {
        const Case& c = cases[first + i];
        const vec3<float> one = shade(shading, c.normal, c.to_viewer, c.sunlight);
        const std::array<float, 3> a{got.x.lane[i], got.y.lane[i], got.z.lane[i]};
        const std::array<float, 3> b{one.x, one.y, one.z};
        EXPECT_EQ(std::memcmp(a.data(), b.data(), sizeof a), 0) << first + i;
        for (const float channel : b) EXPECT_TRUE(std::isfinite(channel) && channel >= 0) << first + i;
      }
    }
  }
}

TEST(Shading, UnderAWhiteSkyReturnsNoMoreThanWhite) {
  const Shading shading(lights(0, 1), &white);
  double least = 1;
  double most = 0;
  for (int i = 0; i <= 1000; ++i) {
    const vec3<double> c = lit(shading, {0, 0, 1}, towards(i / 1000.0, 0.3));
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
        sum = sum + lit(sun, turn * vec3<double>{0, 0, 1}, turn * v);
      }
    const vec3<double> returned = (2 * std::numbers::pi / (rings * spokes)) * sum;
    const vec3<double> of_sky = lit(sky, {0, 0, 1}, v);
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
  const double peak = lit(Shading(lights(1, 0, n), &white), n, n).x;
  const double aside = lit(Shading(lights(1, 0, towards(0.5, 0)), &white), n, n).x / 0.5;
  const double alpha = 0.36 * 0.36;
  EXPECT_NEAR(peak - aside, 0.05 / (4 * std::numbers::pi * alpha * alpha), 3e-3); // the rest at 60 degrees
}

TEST(Shading, ScalesWithItsLights) {
  const vec3<double> n = towards(0.9, 1);
  const vec3<double> v = towards(0.8, -1);
  const vec3<double> one = lit(Shading(lights(1, 0), &white), n, v);
  const vec3<double> three = lit(Shading(lights(3, 0), &white), n, v);
  EXPECT_NEAR(three.x, 3 * one.x, 1e-12);
  const vec3<double> sky = lit(Shading(lights(0, 1), &white), n, v);
  EXPECT_NEAR(lit(Shading(lights(3, 1), &white), n, v).y, three.y + sky.y, 1e-12);
  EXPECT_EQ(max_abs(lit(Shading(lights(3, 0, -n), &white), n, v)), 0);
}

TEST(Shading, AnEnvironmentReplacesTheDefaultSunButNotOneThatIsNamed) {
  const vec3<double> n{0, 0, 1};
  stack::Lights unnamed;
  const vec3<double> by_default = lit(Shading(unnamed, nullptr), n, n);
  unnamed.sky = 0;
  EXPECT_EQ(max_abs(lit(Shading(unnamed, &white), n, n)), 0);
  EXPECT_GT(lit(Shading(unnamed, nullptr), n, n).x, 0.1);
  EXPECT_GT(by_default.x, lit(Shading(unnamed, nullptr), n, n).x); // the built-in sky shines, too
  EXPECT_GT(lit(Shading(lights(1, 0), &white), n, n).x, 0.1);
}

TEST(Shading, IsFiniteForEveryNormalIncludingThoseThatFaceAway) {
  Random random(261);
  const Shading shading(lights(3, 1), &white);
  for (int k = 0; k < 5000; ++k) {
    const vec3<double> v = random.unit_vector();
    const vec3<double> n = k % 10 == 0 ? -v : k % 10 == 1 ? vec3<double>{0, 0, 0} : random.unit_vector();
    const vec3<double> c = lit(shading, n, v);
    EXPECT_TRUE(std::isfinite(c.x + c.y + c.z) && c.x >= 0 && c.y >= 0 && c.z >= 0);
  }
}

} // namespace
} // namespace surfgrad::render
