// Blends of two maps against the map of both reliefs together.

#include "maps/blend.hpp"

#include "maps/convert.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"

#include <surfgrad/derivative.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfgrad::maps {
namespace {

using surfgrad::test::Random;

constexpr int side = 128;

/// Waves that repeat, up to `periods` of them along an axis.
image::Image waves(Random& random, int periods) {
  image::Image heights = image::make_image(side, side, 1, image::Depth::float32);
  for (int n = 0; n < 10; ++n) {
    const int k = static_cast<int>(random.uniform(1, periods));
    const int l = static_cast<int>(random.uniform(-periods, periods));
    const double phase = random.uniform(0, 6);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        heights.at(x, y, 0) +=
            static_cast<float>(std::sin(2 * std::numbers::pi * (k * x + l * y) / side + phase) / (k + 1));
  }
  return heights;
}

image::Image slopes_of(const image::Image& heights, double scale) {
  return slopes_of_heights(heights, Kernel::central, Border::repeat, scale);
}

/// As a file of 16 bits holds them.
image::Image through_file(const image::Image& slopes) {
  image::Image map = write_slopes(slopes, {}, {}).map;
  for (float& v : map.texels.floats()) v = surfgrad::test::stored(v, image::Depth::unorm16);
  return read_slopes(map, {}, "map.png").map;
}

struct Angles {
  double mean = 0;
  double most = 0;
};

Angles between(const image::Image& a, const image::Image& b) {
  Angles result;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double angle =
          surfgrad::test::unit_angle(normal_from_derivative(vec2<double>{a.at(x, y, 0), a.at(x, y, 1)}),
                                     normal_from_derivative(vec2<double>{b.at(x, y, 0), b.at(x, y, 1)}));
      result.mean += angle / (double{1.0 * a.width} * a.height);
      result.most = std::max(result.most, angle);
    }
  return result;
}

TEST(Blend, OfTwoMapsIsTheMapOfTheSummedHeightsByNoOtherMethod) {
  Random random(1831);
  const image::Image coarse = waves(random, 4);
  const image::Image fine = waves(random, 20);
  image::Image both = coarse;
  for (std::size_t i = 0; i < both.texels.size(); ++i) both.texels.floats()[i] += fine.texels[i];
  struct Row {
    Method method;
    const char* name;
    bool is_exact;
  };
  const Row rows[] = {{Method::surface_gradient, "surface gradient", true},
                      {Method::partial_derivative, "partial derivative", true},
                      {Method::linear, "linear", false},
                      {Method::overlay, "overlay", false},
                      {Method::whiteout, "whiteout", false},
                      {Method::udn, "udn", false},
                      {Method::rnm, "rnm", false}};
  for (const double steepness : {2.0, 4.0, 8.0}) {
    const image::Image truth = slopes_of(both, steepness);
    double square = 0;
    for (std::size_t i = 0; i < truth.texels.size(); ++i) square += truth.texels[i] * truth.texels[i];
    std::printf("  slopes of %.2f in the root mean square\n", std::sqrt(square / (side * side)));
    const image::Image base = through_file(slopes_of(coarse, steepness));
    std::vector<Detail> details(1);
    details[0].slopes = through_file(slopes_of(fine, steepness));
    for (const Row& row : rows) {
      const Angles angles = between(blended(base, details, row.method), truth);
      std::printf("    %-20s %8.4f degrees in the mean, %8.4f at most\n", row.name, angles.mean, angles.most);
      // A code of 16 bits is 3e-5 of a unit normal: 0.0009 degrees, of two maps, and three times that where
      // both are so steep that their sum is nearer to the horizon than either.
      if (row.is_exact) {
        EXPECT_LT(angles.most, 0.01) << row.name;
      } else {
        EXPECT_GT(angles.mean, 0.3) << row.name;
      }
    }
  }
}

TEST(Blend, MethodsAreTheirPublishedFormulas) {
  // Two slopes, worked out by hand: normals (-0.6, 0, 0.8) and (0, -0.28, 0.96).
  image::Image base = image::make_image(1, 1, 2, image::Depth::float32);
  base.texels = {0.75f, 0};
  std::vector<Detail> details(1);
  details[0].slopes = image::make_image(1, 1, 2, image::Depth::float32);
  details[0].slopes.texels = {0, 7.0f / 24};
  const auto slope = [&](Method method) {
    const image::Image result = blended(base, details, method);
    return vec2<double>{result.at(0, 0, 0), result.at(0, 0, 1)};
  };
  const auto expect = [&](Method method, double x, double y) {
    EXPECT_NEAR(slope(method).x, x, 1e-6) << static_cast<int>(method);
    EXPECT_NEAR(slope(method).y, y, 1e-6) << static_cast<int>(method);
  };
  expect(Method::surface_gradient, 0.75, 7.0 / 24);
  expect(Method::partial_derivative, 0.75, 7.0 / 24);
  expect(Method::linear, 0.6 / 1.76, 0.28 / 1.76);
  expect(Method::whiteout, 0.6 / 0.768, 0.28 / 0.768);
  expect(Method::udn, 0.6 / 0.8, 0.28 / 0.8);
  // The detail turned by the rotation that takes +z to the base: about the y axis.
  expect(Method::rnm, (0.6 * 0.96) / (0.8 * 0.96), 0.28 / (0.8 * 0.96));
  // Codes 0.2, 0.5, 0.9 over 0.5, 0.36, 0.98.
  expect(Method::overlay, -(2 * (2 * 0.2 * 0.5) - 1) / (2 * (1 - 2 * 0.1 * 0.02) - 1),
         -(2 * (1 - 2 * 0.5 * 0.64) - 1) / (2 * (1 - 2 * 0.1 * 0.02) - 1));
}

TEST(Blend, WeightsAndMasksScaleSlopes) {
  Random random(1832);
  const image::Image base = slopes_of(waves(random, 4), 1);
  std::vector<Detail> details(1);
  details[0].slopes = slopes_of(waves(random, 10), 1);
  details[0].weight = -0.5;
  details[0].mask = image::make_image(side, side, 1);
  for (int y = 0; y < side; ++y) details[0].mask.at(5, y, 0) = 0.25f;
  const image::Image result = blended(base, details, Method::surface_gradient);
  EXPECT_EQ(result.at(6, 9, 0), base.at(6, 9, 0));
  EXPECT_NEAR(result.at(5, 9, 1), base.at(5, 9, 1) - 0.125 * details[0].slopes.at(5, 9, 1), 1e-6);
}

TEST(Blend, TiledAndTurnedDetailIsThatOfItsHeightsDrawnSo) {
  // Heights of a detail, evaluated where each texel of the base lies in it: derivatives by differences.
  Random random(1833);
  const image::Image heights = waves(random, 3);
  const auto height = [&](double s, double t) {
    const auto at = [&](double v) { return static_cast<int>(std::floor(v - std::floor(v / side) * side)); };
    const double x = s * side - 0.5;
    const double y = t * side - 0.5;
    const double fx = x - std::floor(x);
    const double fy = y - std::floor(y);
    const auto h = [&](double i, double j) { return double{heights.at(at(i), at(j), 0)}; };
    return (1 - fy) *
               ((1 - fx) * h(std::floor(x), std::floor(y)) + fx * h(std::floor(x) + 1, std::floor(y))) +
           fy * ((1 - fx) * h(std::floor(x), std::floor(y) + 1) +
                 fx * h(std::floor(x) + 1, std::floor(y) + 1));
  };
  for (const bool mirrors : {false, true}) {
    std::vector<Detail> details(1);
    // Where nothing is minified: as large texels as the base's.
    details[0].slopes = slopes_of(heights, 1);
    details[0].tile = {mirrors ? -1.0 : 1.0, 1};
    details[0].rotate_deg = 30;
    details[0].offset = {0.1, 0.35};
    image::Image flat = image::make_image(side, side, 2, image::Depth::float32);
    const image::Image laid = blended(flat, details, Method::surface_gradient);
    const double c = std::cos(std::numbers::pi / 6);
    const double d = std::sin(std::numbers::pi / 6);
    const auto drawn = [&](double x, double y) {
      const double s = details[0].tile.x * (x + 0.5) / side;
      const double t = (y + 0.5) / side;
      return height(c * s - d * t + 0.1, d * s + c * t + 0.35);
    };
    double worst = 0;
    double steepest = 0;
    for (int y = 2; y < side - 2; ++y)
      for (int x = 2; x < side - 2; ++x) {
        const double ds = 0.5 * (drawn(x + 1, y) - drawn(x - 1, y));
        const double dt = 0.5 * (drawn(x, y + 1) - drawn(x, y - 1));
        worst = std::max({worst, std::abs(laid.at(x, y, 0) - ds), std::abs(laid.at(x, y, 1) - dt)});
        steepest = std::max({steepest, std::abs(ds), std::abs(dt)});
      }
    std::printf("  worst %.4f of slopes up to %.3f\n", worst, steepest);
    EXPECT_LT(worst, 0.05 * steepest); // differences of a turned grid see other points than those of the map
  }
}

} // namespace
} // namespace surfgrad::maps
