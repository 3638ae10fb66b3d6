// Barycentrics and their derivatives against exact perspective projection.

#include "raster/surface.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::raster {
namespace {

using Corners = std::array<vec3<double>, 3>;

/// Barycentrics of the point where the ray through the raster position (x, y) meets the triangle's
/// plane: solves [c0 c1 c2] b = (x, y, 1) w with sum b = 1.
std::array<double, 3> by_definition(const Corners& c, double x, double y) {
  const vec3<double> ray{x, y, 1};
  const double det = dot(c[0], cross(c[1], c[2]));
  const std::array<double, 3> k{dot(ray, cross(c[1], c[2])) / det, dot(ray, cross(c[2], c[0])) / det,
                                dot(ray, cross(c[0], c[1])) / det};
  const double sum = k[0] + k[1] + k[2];
  return {k[0] / sum, k[1] / sum, k[2] / sum};
}

Corners random_corners(test::Random& random, bool crossing) {
  Corners c;
  for (vec3<double>& corner : c) {
    const double w = crossing ? random.uniform(-2, 4) : random.uniform(0.5, 4);
    corner = {random.uniform(-20, 120) * w, random.uniform(-20, 120) * w, w};
  }
  return c;
}

TEST(TrianglePlanes, InterpolateAsPerspectiveProjectionDoes) {
  constexpr std::uint64_t seed = 51;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst value("barycentrics");
  test::Worst rate("their derivatives");
  test::Worst depth("inverse w");
  for (long k = 0; k < 4000; ++k) {
    const Corners c = random_corners(random, k % 2 == 1);
    const TrianglePlanes planes(c);
    ASSERT_FALSE(planes.degenerate());
    // A point of the triangle in front of the eye, reached from random weights.
    const double a = random.uniform(0, 1);
    const double b = random.uniform(0, 1 - a);
    const vec3<double> p = a * c[0] + b * c[1] + (1 - a - b) * c[2];
    const double area = std::abs(dot(c[0], cross(c[1], c[2])));
    if (p.z < 0.3 || area < 100) continue; // slivers magnify rounding
    const double x = p.x / p.z;
    const double y = p.y / p.z;
    EXPECT_TRUE(planes.covers(x, y));
    const TrianglePlanes::Barycentrics got = planes.barycentrics(x, y);
    const double weights[] = {a, b, 1 - a - b};
    constexpr double step = 1e-4; // squared times the third derivative: 1e-8 of the rate
    const auto x_high = by_definition(c, x + step, y);
    const auto x_low = by_definition(c, x - step, y);
    const auto y_high = by_definition(c, x, y + step);
    const auto y_low = by_definition(c, x, y - step);
    for (std::size_t i = 0; i < 3; ++i) {
      // Products of three corner values of up to 500 over an area of at least 100.
      value.add(got.value[i], weights[i], 1e-9, k);
      const double size = std::max(std::abs(got.dx[i]) + std::abs(got.dy[i]), 1e-3);
      rate.add(got.dx[i], (x_high[i] - x_low[i]) / (2 * step), 1e-4 * size, k);
      rate.add(got.dy[i], (y_high[i] - y_low[i]) / (2 * step), 1e-4 * size, k);
    }
    depth.add(planes.inverse_w(x, y), 1 / p.z, 1e-8, k);
  }
}

TEST(TrianglePlanes, SumOfBarycentricsIsOneAndOfTheirDerivativesZero) {
  test::Random random(52);
  test::Worst worst("sums");
  for (long k = 0; k < 1000; ++k) {
    const TrianglePlanes planes(random_corners(random, false));
    const auto b = planes.barycentrics(random.uniform(0, 100), random.uniform(0, 100));
    double size = 1;
    double rate = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      size = std::max(size, std::abs(b.value[i]));
      rate = std::max({rate, std::abs(b.dx[i]), std::abs(b.dy[i])});
    }
    worst.add(b.value[0] + b.value[1] + b.value[2], 1, 1e-12 * size,
              k); // a few eps, outside the triangle too
    worst.add(b.dx[0] + b.dx[1] + b.dx[2], 0, 1e-10 * rate * size, k);
    worst.add(b.dy[0] + b.dy[1] + b.dy[2], 0, 1e-10 * rate * size, k);
  }
}

TEST(TrianglePlanes, CoverOnlyWhatLiesInFrontOfTheEye) {
  constexpr std::uint64_t seed = 53;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  long covered = 0;
  for (long k = 0; k < 2000; ++k) {
    Corners c = random_corners(random, true);
    if (k % 4 == 0)
      for (vec3<double>& corner : c) corner = corner.z > 0 ? -corner : corner; // all behind
    const TrianglePlanes planes(c);
    for (int j = 0; j < 50; ++j) {
      const double x = random.uniform(-200, 300);
      const double y = random.uniform(-200, 300);
      if (!planes.covers(x, y)) continue;
      ++covered;
      EXPECT_NE(k % 4, 0) << "a triangle behind the eye covers " << x << ", " << y;
      EXPECT_GT(planes.inverse_w(x, y), 0);
      for (const double b : by_definition(c, x, y)) EXPECT_GE(b, -1e-9);
    }
  }
  EXPECT_GT(covered, 1000);
}

TEST(TrianglePlanes, TellWindingAndZeroArea) {
  const vec3<double> a{1, 1, 1};
  const vec3<double> b{5, 1, 1};
  const vec3<double> c{1, 4, 1};
  EXPECT_TRUE(TrianglePlanes({a, b, c}).counter_clockwise());
  EXPECT_FALSE(TrianglePlanes({a, c, b}).counter_clockwise());
  EXPECT_TRUE(TrianglePlanes({a, b, c}).covers(2, 2));
  EXPECT_TRUE(TrianglePlanes({a, c, b}).covers(2, 2));
  for (const Corners& flat :
       {Corners{a, b, b}, Corners{a, b, {9, 1, 1}}, Corners{a, a, a}, Corners{a, b, {NAN, 1, 1}}}) {
    EXPECT_TRUE(TrianglePlanes(flat).degenerate());
    EXPECT_FALSE(TrianglePlanes(flat).covers(2, 1));
  }
}

} // namespace
} // namespace surfgrad::raster
