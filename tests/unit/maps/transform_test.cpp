// The transforms against their definitions, summed term by term.

#include "maps/transform.hpp"

#include "maps/plan.hpp"

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

// Numbers are kept as floats after rows and after columns: two roundings of 2^-24 of sums that reach 30.
constexpr double bound = 4e-6;

TEST(Plan, IsItsSumAndItsInverseUndoesIt) {
  Random random(1800);
  double worst = 0;
  for (const std::size_t length : {1, 2, 3, 8, 12, 23, 29, 31, 46, 58, 61, 97, 121, 128}) {
    const auto n = static_cast<double>(length);
    std::vector<Complex> line(length), spectrum(length), again(length);
    for (Complex& v : line) v = {random.uniform(-1, 1), random.uniform(-1, 1)};
    Plan(length, false).transform(line.data(), spectrum.data());
    for (std::size_t k = 0; k < length; ++k) {
      Complex sum = 0;
      for (std::size_t x = 0; x < length; ++x)
        sum += line[x] * std::polar(1.0, -2 * pi * static_cast<double>(x * k % length) / n);
      worst = std::max(worst, std::abs(spectrum[k] - sum));
    }
    Plan(length, true).transform(spectrum.data(), again.data());
    for (std::size_t x = 0; x < length; ++x) worst = std::max(worst, std::abs(again[x] / n - line[x]));
  }
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst, 1e-13); // of sums of up to 128 values below 2: their roundings, 2^-52 each
}

TEST(Transform, FourierIsItsSumAndItsInverseUndoesIt) {
  Random random(1801);
  double worst = 0;
  for (const Size size : sizes) {
    std::vector<float> values(2 * at(size, 0, size.height));
    for (float& v : values) v = static_cast<float>(random.uniform(-1, 1));
    std::vector<float> spectrum = values;
    const auto number = [](const std::vector<float>& pairs, std::size_t i) {
      return Complex(pairs[2 * i], pairs[2 * i + 1]);
    };
    fourier(spectrum, size.width, size.height);
    for (int l = 0; l < size.height; ++l)
      for (int k = 0; k < size.width; ++k) {
        Complex sum = 0;
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            sum += number(values, at(size, x, y)) *
                   std::polar(
                       1.0, -2 * pi * (double{1.0 * x * k} / size.width + double{1.0 * y * l} / size.height));
        worst = std::max(worst, std::abs(number(spectrum, at(size, k, l)) - sum));
      }
    inverse_fourier(spectrum, size.width, size.height);
    for (std::size_t i = 0; i < values.size(); ++i)
      worst = std::max(worst, std::abs(double{spectrum[i]} - values[i]));
  }
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst, bound);
}

TEST(Transform, CosineIsItsSumAndItsInverseUndoesIt) {
  Random random(1802);
  double worst = 0;
  for (const Size size : sizes) {
    std::vector<float> values(at(size, 0, size.height));
    for (float& v : values) v = static_cast<float>(random.uniform(-1, 1));
    std::vector<float> spectrum = values;
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
      worst = std::max(worst, std::abs(double{spectrum[i]} - values[i]));
  }
  std::printf("  worst %.2g\n", worst);
  EXPECT_LT(worst, bound);
}

} // namespace
} // namespace surfgrad::maps
