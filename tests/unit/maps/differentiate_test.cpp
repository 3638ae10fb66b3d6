// Kernels against the waves and planes that they are for.

#include "maps/differentiate.hpp"

#include "support/random.hpp"

#include <surfgrad/derivative.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfgrad::maps {
namespace {

using surfgrad::test::Random;
constexpr double pi = std::numbers::pi;
constexpr Kernel kernels[] = {Kernel::central, Kernel::sobel, Kernel::scharr, Kernel::bspline};

template <class Height>
image::Image heights_of(int width, int height, const Height& h) {
  image::Image heights = image::make_image(width, height, 1, image::Depth::float32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) heights.at(x, y, 0) = static_cast<float>(h(x, y));
  return heights;
}

TEST(Differentiate, WavesComeOutAsSteepAsTheKernelSays) {
  constexpr int width = 24;
  constexpr int height = 20;
  double worst = 0;
  for (const Kernel kernel : kernels)
    for (const int k : {0, 1, 3, 7, 11})
      for (const int l : {0, 2, 5, 9}) {
        const double w = 2 * pi * k / width;
        const double v = 2 * pi * l / height;
        const auto phase = [&](int x, int y) { return w * x + v * y; };
        const image::Image slopes =
            slopes_of_heights(heights_of(width, height, [&](int x, int y) { return std::sin(phase(x, y)); }),
                              kernel, Border::repeat, 1);
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            const double c = std::cos(phase(x, y));
            worst = std::max(
                worst, std::abs(slopes.at(x, y, 0) - slope_along(kernel, w) * share_across(kernel, v) * c));
            worst = std::max(
                worst, std::abs(slopes.at(x, y, 1) - slope_along(kernel, v) * share_across(kernel, w) * c));
          }
      }
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst, 1e-6); // heights below 1 are floats (2^-24), slopes are up to 3 times as large
}

TEST(Differentiate, ResponsesAreThoseOfTheirWeights) {
  // Sobel's and Scharr's published weights, and the cubic spline's equation for its slopes at the knots,
  // (m[k-1] + 4 m[k] + m[k+1]) / 6 = (h[k+1] - h[k-1]) / 2.
  for (const double w : {0.0, 0.3, 1.0, 2.0, 3.0})
    for (const double v : {0.0, 0.5, 2.5}) {
      EXPECT_NEAR(slope_along(Kernel::sobel, w) * share_across(Kernel::sobel, v),
                  (1 * std::cos(v) + 2 + 1 * std::cos(v)) / 8 * 2 * std::sin(w), 1e-15);
      EXPECT_NEAR(slope_along(Kernel::scharr, w) * share_across(Kernel::scharr, v),
                  (3 * std::cos(v) + 10 + 3 * std::cos(v)) / 32 * 2 * std::sin(w), 1e-15);
      EXPECT_NEAR(slope_along(Kernel::bspline, w) * (4 + 2 * std::cos(w)) / 6, std::sin(w), 1e-15);
      EXPECT_EQ(share_across(Kernel::bspline, v), 1);
    }
  // The spline follows waves that central differences flatten: at 8 texels a period 0.2 % against 10 %.
  EXPECT_NEAR(slope_along(Kernel::bspline, pi / 4) / (pi / 4), 1, 0.0025);
  EXPECT_NEAR(slope_along(Kernel::central, pi / 4) / (pi / 4), 0.9, 0.001);
}

TEST(Differentiate, PlaneStaysOneUpToAClampedBorder) {
  for (const Kernel kernel : kernels) {
    const image::Image slopes = slopes_of_heights(
        heights_of(7, 5, [](int x, int y) { return 0.25 * x - 0.5 * y; }), kernel, Border::clamp, 2);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) {
        EXPECT_NEAR(slopes.at(x, y, 0), 0.5, 1e-6);
        EXPECT_NEAR(slopes.at(x, y, 1), -1, 1e-6);
      }
  }
}

TEST(Differentiate, ParabolaIsExactInsideOfAClampedMap) {
  for (const Kernel kernel : kernels) {
    const image::Image slopes = slopes_of_heights(
        heights_of(40, 3, [](int x, int) { return 0.01 * (x - 20) * (x - 20); }), kernel, Border::clamp, 1);
    for (int x = 12; x < 28; ++x) EXPECT_NEAR(slopes.at(x, 1, 0), 0.02 * (x - 20), 1e-6);
  }
}

TEST(Differentiate, RepeatedMapHasNoMeanSlope) {
  Random random(1803);
  for (const Kernel kernel : kernels) {
    const image::Image slopes = slopes_of_heights(
        heights_of(13, 9, [&](int, int) { return random.uniform(0, 1); }), kernel, Border::repeat, 3);
    double sum[2] = {};
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 13; ++x)
        for (int c = 0; c < 2; ++c) sum[c] += slopes.at(x, y, c);
    EXPECT_NEAR(sum[0], 0, 1e-5);
    EXPECT_NEAR(sum[1], 0, 1e-5);
  }
}

TEST(Differentiate, SingleRowsColumnsAndTexelsAreFlatAcross) {
  Random random(1804);
  for (const Kernel kernel : kernels)
    for (const Border border : {Border::repeat, Border::clamp}) {
      const auto noise = [&](int, int) { return random.uniform(0, 1); };
      const image::Image one = slopes_of_heights(heights_of(1, 1, noise), kernel, border, 1);
      EXPECT_EQ(one.at(0, 0, 0), 0);
      EXPECT_EQ(one.at(0, 0, 1), 0);
      const image::Image row = slopes_of_heights(heights_of(6, 1, noise), kernel, border, 1);
      for (int x = 0; x < 6; ++x) EXPECT_EQ(row.at(x, 0, 1), 0);
      EXPECT_NE(row.at(2, 0, 0), 0);
    }
}

TEST(Differentiate, SlopesStopWhereThoseOfNormalMapsDo) {
  const image::Image slopes = slopes_of_heights(heights_of(4, 4, [](int x, int) { return 1000.0 * x; }),
                                                Kernel::central, Border::clamp, 1);
  EXPECT_FLOAT_EQ(slopes.at(1, 1, 0), max_slope);
}

} // namespace
} // namespace surfgrad::maps
