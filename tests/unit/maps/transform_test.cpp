// The transforms against their definitions, summed term by term.

#include "maps/transform.hpp"

#include "support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace surfgrad::maps {
namespace {

using Complex = std::complex<double>;
using surfgrad::test::Random;
constexpr double pi = std::numbers::pi;

struct Size {
  int width, height;
};
// Powers of two, odd, small primes and large ones, which go another way, and of a single row, column or
// texel.
constexpr Size sizes[] = {{8, 4}, {16, 16}, {9, 10}, {7, 13}, {1, 6},  {5, 1},
                          {1, 1}, {2, 2},   {34, 3}, {61, 4}, {3, 74}, {29, 1}};

std::size_t at(Size size, int x, int y) { return static_cast<std::size_t>(y * size.width + x); }

TEST(Transform, FourierIsItsSumAndItsInverseUndoesIt) {
  Random random(1801);
  double worst = 0;
  for (const Size size : sizes) {
    std::vector<Complex> values(at(size, 0, size.height));
    for (Complex& v : values) v = {random.uniform(-1, 1), random.uniform(-1, 1)};
    std::vector<Complex> spectrum = values;
    fourier(spectrum, size.width, size.height);
    for (int l = 0; l < size.height; ++l)
      for (int k = 0; k < size.width; ++k) {
        Complex sum = 0;
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            sum += values[at(size, x, y)] *
                   std::polar(
                       1.0, -2 * pi * (double{1.0 * x * k} / size.width + double{1.0 * y * l} / size.height));
        worst = std::max(worst, std::abs(spectrum[at(size, k, l)] - sum));
      }
    inverse_fourier(spectrum, size.width, size.height);
    for (std::size_t i = 0; i < values.size(); ++i)
      worst = std::max(worst, std::abs(spectrum[i] - values[i]));
  }
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst, 1e-12); // of sums of up to 256 values below 2: their roundings, 2^-52 each
}

TEST(Transform, CosineIsItsSumAndItsInverseUndoesIt) {
  Random random(1802);
  double worst = 0;
  for (const Size size : sizes) {
    std::vector<double> values(at(size, 0, size.height));
    for (double& v : values) v = random.uniform(-1, 1);
    std::vector<double> spectrum = values;
    cosine(spectrum, size.width, size.height);
    for (int l = 0; l < size.height; ++l)
      for (int k = 0; k < size.width; ++k) {
        double sum = 0;
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            sum += values[at(size, x, y)] * std::cos(pi * k * (x + 0.5) / size.width) *
                   std::cos(pi * l * (y + 0.5) / size.height);
        worst = std::max(worst, std::abs(spectrum[at(size, k, l)] - sum));
      }
    inverse_cosine(spectrum, size.width, size.height);
    for (std::size_t i = 0; i < values.size(); ++i)
      worst = std::max(worst, std::abs(spectrum[i] - values[i]));
  }
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst, 1e-12);
}

} // namespace
} // namespace surfgrad::maps
