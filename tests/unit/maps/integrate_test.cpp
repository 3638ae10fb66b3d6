// Slopes to heights: exact inverses where there are, nearest heights where there are none.

#include "maps/integrate.hpp"

#include "diagnostic/error.hpp"
#include "maps/heights.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace surfgrad::maps {
namespace {

using image::Image;

constexpr Kernel kernels[] = {Kernel::central, Kernel::sobel, Kernel::scharr, Kernel::bspline};
constexpr double pi = std::numbers::pi;
// Even and odd, powers of two and primes.
const std::vector<std::pair<int, int>> sizes{{16, 16}, {31, 48}, {37, 5}, {1, 9}, {8, 1}, {2, 3}};

Image random_heights(test::Random& random, int width, int height) {
  Image heights = image::make_image(width, height, 1, image::Depth::float32);
  for (float& h : heights.texels.floats()) h = static_cast<float>(random.uniform());
  return heights;
}

double mean_of(const Image& heights) {
  double sum = 0;
  for (std::size_t i = 0; i < heights.texels.size(); ++i) sum += heights.texels[i];
  return sum / static_cast<double>(heights.texels.size());
}

TEST(Integration, WrappedHeightsComeBackFromTheSlopesThatAKernelMadeOfThem) {
  test::Random random(20264);
  test::Worst worst("heights after a round trip, seed 20264");
  for (const Kernel kernel : kernels)
    for (const auto& [width, height] : sizes)
      for (const vec2<double> texel : {vec2<double>{1, 1}, vec2<double>{0.25, 3}}) {
        const Relief relief{.slope_scale = {1 / texel.x, 1 / texel.y}, .kernel = kernel};
        const Integration integration{.kernel = kernel, .texel = texel};
        // What the kernel hardly sees of random heights goes the first time.
        const Image seen =
            heights_of_slopes(slopes_of_heights(random_heights(random, width, height), relief), integration);
        EXPECT_NEAR(mean_of(seen), 0, 1e-6);
        const Image again = heights_of_slopes(slopes_of_heights(seen, relief), integration);
        for (std::size_t i = 0; i < again.texels.size(); ++i)
          // Each of four passes rounds to float; waves that are seen least grow 32-fold with their rounding.
          worst.add(again.texels[i], seen.texels[i], 32 * 4 * 0x1p-24, static_cast<long>(i));
      }
}

TEST(Integration, WrappedHeightsOfASplineComeBackWhole) {
  // Of odd sides, so short, the spline sees every wave but the mean.
  test::Random random(20265);
  const Image heights = random_heights(random, 27, 35);
  const Image again =
      heights_of_slopes(slopes_of_heights(heights, {.kernel = Kernel::bspline}), {.kernel = Kernel::bspline});
  test::Worst worst("whole heights after a round trip, seed 20265");
  const double mean = mean_of(heights);
  for (std::size_t i = 0; i < again.texels.size(); ++i)
    worst.add(again.texels[i], heights.texels[i] - mean, 32 * 4 * 0x1p-24, static_cast<long>(i)); // as above
}

TEST(Integration, ClampedHeightsOfThirdDegreeComeBackThemselves) {
  // Within: the cubic through four slopes. Borders: parabolas, and slopes of third degree are parabolas.
  const auto h = [](double x, double y) {
    return 0.3 * x - 0.7 * y + 0.2 * x * x - 0.4 * x * y + 0.1 * x * x * x - 0.2 * y * y * y;
  };
  const auto slope = [](double x, double y) {
    return vec2<double>{0.3 + 0.4 * x - 0.4 * y + 0.3 * x * x, -0.7 - 0.4 * x - 0.6 * y * y};
  };
  test::Worst worst("heights of third degree");
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{16, 16}, {31, 37}, {3, 5}, {40, 3}}) {
    const vec2<double> texel{2.0 / width, 3.0 / height};
    Image slopes = image::make_image(width, height, 2, image::Depth::float32);
    std::vector<double> expected;
    double mean = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const vec2<double> at{(x + 0.5) * texel.x - 1, (y + 0.5) * texel.y - 1.5};
        slopes.at(x, y, 0) = static_cast<float>(slope(at.x, at.y).x);
        slopes.at(x, y, 1) = static_cast<float>(slope(at.x, at.y).y);
        expected.push_back(h(at.x, at.y));
        mean += expected.back() / (width * height);
      }
    const Image heights = heights_of_slopes(slopes, {.borders = Borders::clamp, .texel = texel});
    for (std::size_t i = 0; i < expected.size(); ++i)
      // Slopes of up to 4 are rounded to float, over a path of 3; four passes round again.
      worst.add(heights.texels[i], expected[i] - mean, 3 * 4 * 4 * 0x1p-24, width);
  }
}

TEST(Integration, IsTheNearestWhereSlopesHaveACurl) {
  // The rotation (-y, x) has no heights at all; with a gradient added to it only that is left.
  constexpr int side = 24;
  Image slopes = image::make_image(side, side, 2, image::Depth::float32);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double u = 2 * pi * x / side, v = 2 * pi * y / side;
      // The curl of cos(u) cos(v), and the gradient of sin(u + v): both in terms of the spline's response.
      const double d = response_along(weights_of(Kernel::bspline), 2 * pi / side);
      slopes.at(x, y, 0) = static_cast<float>(d * (-std::cos(u) * std::sin(v) + std::cos(u + v)));
      slopes.at(x, y, 1) = static_cast<float>(d * (std::sin(u) * std::cos(v) + std::cos(u + v)));
    }
  const Image heights = heights_of_slopes(slopes, {.kernel = Kernel::bspline});
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      EXPECT_NEAR(heights.at(x, y, 0), std::sin(2 * pi * (x + y) / side), 1e-6); // a few roundings to float
}

TEST(Integration, StaysLevelWhereItWrapsAndRisesWhereItDoesNot) {
  constexpr int side = 16;
  Image slopes = image::make_image(side, side, 2, image::Depth::float32);
  for (std::size_t i = 0; i < slopes.texels.size(); i += 2) slopes.texels[i] = 0.5f;
  const Image wrapped = heights_of_slopes(slopes, {});
  const Image clamped = heights_of_slopes(slopes, {.borders = Borders::clamp});
  for (int x = 0; x < side; ++x) {
    EXPECT_NEAR(wrapped.at(x, 3, 0), 0, 1e-6);
    EXPECT_NEAR(clamped.at(x, 3, 0), 0.5 * (x - 7.5), 1e-5);
  }
}

TEST(Integration, StopsWhenAskedTo) {
  for (const Borders borders : {Borders::wrap, Borders::clamp}) {
    int calls = 0;
    const Report report{[&](double) { return ++calls < 3; }, {}};
    EXPECT_THROW((void)heights_of_slopes(image::make_image(8, 8, 2, image::Depth::float32),
                                         {.borders = borders}, report),
                 Cancelled);
    EXPECT_EQ(calls, 3);
  }
}

} // namespace
} // namespace surfgrad::maps
