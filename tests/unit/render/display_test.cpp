// Codes of a display: the sRGB curve behind a soft shoulder.

#include "render/display.hpp"

#include "simd/emulated_lanes.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace surfgrad::render {
namespace {

/// The definition, with the C library's power.
double defined(double linear) {
  const double y = linear <= 0.7 ? linear : 1 - 0.09 / (linear - 0.4);
  return y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055;
}

template <class T>
void compare_with_definition(const char* what) {
  surfgrad::test::Worst worst(what);
  constexpr double eps = std::numeric_limits<T>::epsilon();
  for (int i = 0; i <= 160000; ++i) {
    const T linear = static_cast<T>(i * 1e-4);
    // The bound that display_value states.
    worst.add(display_value(linear), defined(linear), 4 * eps * (defined(linear) + 0.055), i);
  }
}

TEST(DisplayValue, IsTheSrgbCurveBehindAShoulder) {
  compare_with_definition<double>("display code in double");
  compare_with_definition<float>("display code in float");
}

TEST(DisplayValue, RisesFromBlackToWhiteWithoutAStep) {
  EXPECT_EQ(display_value(0.0), 0);
  EXPECT_EQ(display_value(-1.0), 0);
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

TEST(DisplayValue, InLanesHasTheSameBytesAsInFloat) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const auto check = [](const simd::EmulatedFloat& linear) {
    const simd::EmulatedFloat got = display_value(linear);
    for (int i = 0; i < simd::emulated_width; ++i)
      EXPECT_EQ(std::bit_cast<std::uint32_t>(got.lane[i]),
                std::bit_cast<std::uint32_t>(display_value(linear.lane[i])))
          << linear.lane[i];
  };
  for (int k = 0; k < 4000; ++k) {
    simd::EmulatedFloat linear;
    for (int i = 0; i < simd::emulated_width; ++i)
      linear.lane[i] = 5e-4f * static_cast<float>(simd::emulated_width * k + i);
    check(linear);
  }
  simd::EmulatedFloat odd;
  odd.lane = {0, -0.0f, -1, inf, -inf, nan, std::numeric_limits<float>::denorm_min(), 1e30f};
  check(odd);
  EXPECT_EQ(display_value(nan), 0);
  EXPECT_EQ(display_value(-inf), 0);
  EXPECT_NEAR(display_value(inf), 1, 1e-6);
}

} // namespace
} // namespace surfgrad::render
