// Heights of slopes, and back.

#include "maps/integrate.hpp"

#include "support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfgrad::maps {
namespace {

using surfgrad::test::Random;

/// A smooth surface that repeats: waves of at least four texels a period.
image::Image waves(Random& random, int width, int height) {
  image::Image heights = image::make_image(width, height, 1, image::Depth::float32);
  for (int n = 0; n < 20; ++n) {
    const int k = static_cast<int>(random.uniform(0, width / 4.0));
    const int l = static_cast<int>(random.uniform(0, height / 4.0)) * (n % 2 == 0 ? 1 : -1);
    const double phase = random.uniform(0, 6);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        heights.at(x, y, 0) += static_cast<float>(
            0.1 * std::sin(2 * std::numbers::pi * (1.0 * k * x / width + 1.0 * l * y / height) + phase));
  }
  return heights;
}

void remove_mean(image::Image& heights) {
  double sum = 0;
  for (const float h : heights.texels.floats()) sum += h;
  for (float& h : heights.texels.floats())
    h -= static_cast<float>(sum / static_cast<double>(heights.texels.size()));
}

double worst_difference(const image::Image& a, const image::Image& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.texels.size(); ++i)
    worst = std::max(worst, std::abs(double{a.texels[i]} - b.texels[i]));
  return worst;
}

TEST(Integrate, RepeatedHeightsComeBackFromTheirSlopes) {
  Random random(1805);
  for (const auto& [width, height] : {std::pair{32, 32}, {30, 17}, {64, 8}})
    for (const Kernel kernel : {Kernel::central, Kernel::sobel, Kernel::scharr, Kernel::bspline}) {
      image::Image heights = waves(random, width, height);
      remove_mean(heights);
      const Integrated made =
          integrate(slopes_of_heights(heights, kernel, Border::repeat, 1), kernel, Border::repeat);
      const double worst = worst_difference(made.heights, heights);
      std::printf("  %dx%d: worst %.2g, not integrable %.2g\n", width, height, worst, made.not_integrable);
      EXPECT_LT(worst, 2e-5); // float slopes of about 1, 2^-24 each, over paths of up to 64 texels
      EXPECT_LT(made.not_integrable, 1e-5);
    }
}

TEST(Integrate, ClampedHeightsComeBackWithTheirTilt) {
  // A polynomial of degree 3, which the steps between texels are exact for: slopes are given by its
  // derivative.
  const auto h = [](double x, double y) {
    return 0.002 * x * x * x - 0.03 * x * y + 0.01 * y * y + 0.7 * x - y;
  };
  image::Image slopes = image::make_image(21, 14, 2, image::Depth::float32);
  image::Image heights = image::make_image(21, 14, 1, image::Depth::float32);
  for (int y = 0; y < 14; ++y)
    for (int x = 0; x < 21; ++x) {
      slopes.at(x, y, 0) = static_cast<float>(0.006 * x * x - 0.03 * y + 0.7);
      slopes.at(x, y, 1) = static_cast<float>(-0.03 * x + 0.02 * y - 1);
      heights.at(x, y, 0) = static_cast<float>(h(x, y));
    }
  remove_mean(heights);
  const Integrated made = integrate(slopes, Kernel::bspline, Border::clamp);
  const double worst = worst_difference(made.heights, heights);
  std::printf("  worst %.2g of heights up to 30, not integrable %.2g\n", worst, made.not_integrable);
  EXPECT_LT(worst, 3e-5); // floats of up to 30 are 2e-6 apart, and slopes are floats too
  EXPECT_LT(made.not_integrable, 1e-5);
}

TEST(Integrate, LeavesOutWhatNoSurfaceHas) {
  // A surface, and a field of slopes that goes round in circles; it is as large and has no part in the
  // heights.
  Random random(1806);
  constexpr int side = 32;
  image::Image heights = waves(random, side, side);
  remove_mean(heights);
  image::Image slopes = slopes_of_heights(heights, Kernel::central, Border::repeat, 1);
  const image::Image potential =
      slopes_of_heights(waves(random, side, side), Kernel::central, Border::repeat, 1);
  double of_surface = 0;
  double of_curl = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      for (int c = 0; c < 2; ++c) {
        of_surface += slopes.at(x, y, c) * slopes.at(x, y, c);
        of_curl += potential.at(x, y, c) * potential.at(x, y, c);
      }
      slopes.at(x, y, 0) += potential.at(x, y, 1);
      slopes.at(x, y, 1) -= potential.at(x, y, 0);
    }
  const Integrated made = integrate(slopes, Kernel::central, Border::repeat);
  EXPECT_LT(worst_difference(made.heights, heights), 2e-5);
  // Both fields are perpendicular: their squares add up.
  EXPECT_NEAR(made.not_integrable, std::sqrt(of_curl / (of_curl + of_surface)), 1e-4);
}

TEST(Integrate, MeanSlopeIsTheTiltAndRepeatedHeightsHaveNone) {
  image::Image slopes = image::make_image(16, 16, 2, image::Depth::float32);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      slopes.at(x, y, 0) = 0.5f;
      slopes.at(x, y, 1) = -0.25f;
    }
  const Integrated repeated = integrate(slopes, Kernel::bspline, Border::repeat);
  EXPECT_NEAR(repeated.tilt.x, 0.5, 1e-7);
  EXPECT_NEAR(repeated.tilt.y, -0.25, 1e-7);
  for (std::size_t i = 0; i < repeated.heights.texels.size(); ++i)
    EXPECT_NEAR(repeated.heights.texels[i], 0, 1e-7);
  const Integrated clamped = integrate(slopes, Kernel::bspline, Border::clamp);
  EXPECT_NEAR(clamped.tilt.x, 0.5, 1e-7);
  EXPECT_NEAR(clamped.heights.at(15, 3, 0) - clamped.heights.at(0, 3, 0), 7.5, 1e-5);
  EXPECT_EQ(clamped.not_integrable, 0);
  EXPECT_EQ(repeated.not_integrable, 0);
}

TEST(Integrate, SingleTexelsRowsAndColumnsHaveHeights) {
  for (const Border border : {Border::repeat, Border::clamp})
    for (const auto& [width, height] : {std::pair{1, 1}, {5, 1}, {1, 4}, {2, 2}}) {
      image::Image slopes = image::make_image(width, height, 2, image::Depth::float32);
      for (float& s : slopes.texels.floats()) s = 1;
      const Integrated made = integrate(slopes, Kernel::bspline, border);
      for (std::size_t i = 0; i < made.heights.texels.size(); ++i)
        EXPECT_TRUE(std::isfinite(made.heights.texels[i]));
      if (border == Border::clamp) {
        EXPECT_NEAR(made.heights.at(width - 1, 0, 0) - made.heights.at(0, 0, 0), width - 1, 1e-5);
      }
    }
}

} // namespace
} // namespace surfgrad::maps
