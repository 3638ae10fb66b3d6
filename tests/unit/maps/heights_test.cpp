// Heights to slopes: kernels, their responses, borders and units.

#include "maps/heights.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace surfgrad::maps {
namespace {

using image::Image;

constexpr Kernel kernels[] = {Kernel::central, Kernel::sobel, Kernel::scharr, Kernel::bspline};
constexpr double pi = std::numbers::pi;

/// A float file of a function of the texel's column and row.
template <class Function>
Image heights_of(int width, int height, Function f) {
  Image heights = image::make_image(width, height, 1, image::Depth::float32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) heights.at(x, y, 0) = static_cast<float>(f(x, y));
  return heights;
}

TEST(HeightsToSlopes, APlaneHasItsSlopeEverywhereWithClampedBorders) {
  test::Worst worst("slope of a plane");
  // Sizes smaller than a kernel's reach too, where heights beyond the border are reflected several times.
  const std::vector<std::pair<int, int>> sizes{{2, 2}, {3, 5}, {17, 4}, {64, 33}};
  for (const Kernel kernel : kernels)
    for (const auto& [width, height] : sizes) {
      const Image slopes =
          slopes_of_heights(heights_of(width, height, [](int x, int y) { return 0.25 * x - 0.5 * y; }),
                            {.kernel = kernel, .borders = Borders::clamp});
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          // Heights and weights are exact or rounded in double: what is left is the rounding to float.
          worst.add(slopes.at(x, y, 0), 0.25, 0x1p-25, x);
          worst.add(slopes.at(x, y, 1), -0.5, 0x1p-25, y);
        }
    }
}

TEST(HeightsToSlopes, AreFlatWhereThereIsOneTexelOrOneHeight) {
  for (const Kernel kernel : kernels)
    for (const Borders borders : {Borders::wrap, Borders::clamp})
      for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1}, {1, 7}, {5, 1}, {6, 6}}) {
        const Image slopes = slopes_of_heights(heights_of(width, height, [](int, int) { return 0.3; }),
                                               {.kernel = kernel, .borders = borders});
        for (std::size_t i = 0; i < slopes.texels.size(); ++i)
          EXPECT_NEAR(slopes.texels[i], 0.0f,
                      borders == Borders::wrap ? 0 : 1e-15); // reflection adds and takes away
      }
}

TEST(HeightsToSlopes, AWaveComesOutByTheKernelsResponse) {
  constexpr int width = 48, height = 36;
  test::Worst worst("slope of a wave");
  for (const Kernel kernel : kernels)
    for (const auto& [cycles_s, cycles_t] :
         std::vector<std::pair<int, int>>{{1, 0}, {0, 3}, {5, 2}, {17, -11}, {23, 17}}) {
      const double u = 2 * pi * cycles_s / width;
      const double v = 2 * pi * cycles_t / height;
      const Image slopes =
          slopes_of_heights(heights_of(width, height, [&](int x, int y) { return std::sin(u * x + v * y); }),
                            {.kernel = kernel});
      const Weights weights = weights_of(kernel);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double cosine = std::cos(u * x + v * y);
          // Heights are rounded to 2^-25; a kernel's weights sum to 2 at most.
          worst.add(slopes.at(x, y, 0), response(weights, u, v) * cosine, 0x1p-23, cycles_s);
          worst.add(slopes.at(x, y, 1), response(weights, v, u) * cosine, 0x1p-23, cycles_t);
        }
    }
}

TEST(Kernels, RespondAsTheyAreDocumented) {
  for (double u = 0; u <= pi; u += pi / 64) {
    const double v = pi - 0.7 * u;
    const auto at = [&](Kernel kernel) { return response(weights_of(kernel), u, v); };
    EXPECT_NEAR(at(Kernel::central), std::sin(u), 1e-14);
    EXPECT_NEAR(at(Kernel::sobel), std::sin(u) * (1 + std::cos(v)) / 2, 1e-14);
    EXPECT_NEAR(at(Kernel::scharr), std::sin(u) * (5 + 3 * std::cos(v)) / 8, 1e-14);
    // Its weights end where they are below 2^-31, and those that are left make up for it.
    EXPECT_NEAR(at(Kernel::bspline), 3 * std::sin(u) / (2 + std::cos(u)), 0x1p-25);
  }
}

TEST(HeightsToSlopes, RealUnitsGiveTheSlopeOfTheSurface) {
  // A ramp that rises by 0.02 m over a map of 1.5 m x 0.5 m, in either direction.
  constexpr int width = 30, height = 20;
  const Image map = heights_of(width, height, [](int x, int y) { return x / 30.0 + y / 20.0; });
  const Relief relief{.slope_scale = slope_scale_of(0.02, {1.5, 0.5}, map), .borders = Borders::clamp};
  const Image slopes = slopes_of_heights(map, relief);
  // Heights of up to 2 are rounded to 2^-24, and their difference is multiplied by 0.8 at most.
  EXPECT_NEAR(slopes.at(11, 7, 0), 0.02 / 1.5, 0x1p-23);
  EXPECT_NEAR(slopes.at(11, 7, 1), 0.02 / 0.5, 0x1p-23);
}

} // namespace
} // namespace surfgrad::maps
