// Transforms against their definitions, at lengths of every kind.

#include "maps/fourier.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace surfgrad::maps {
namespace {

constexpr double pi = std::numbers::pi;
// Powers of two, other small factors, primes on either side of what the library sums directly, products of
// those.
constexpr std::size_t lengths[] = {1, 2, 3, 4, 5, 7, 8, 12, 15, 31, 37, 49, 60, 62, 64, 74, 97, 121, 128};

std::vector<Complex> random_line(test::Random& random, std::size_t length) {
  std::vector<Complex> line;
  for (std::size_t i = 0; i < length; ++i) line.emplace_back(random.uniform(), random.uniform());
  return line;
}

// Sums of `length` products with errors of a unit in the last place each.
double bound(std::size_t length) { return 0x1p-50 * static_cast<double>(length); }

vec2<double> parts_of(Complex z) { return {z.real(), z.imag()}; }

template <class Factor>
void compare_with_sums(const std::vector<Complex>& line, const std::vector<Complex>& got, test::Worst& worst,
                       Factor factor) {
  for (std::size_t k = 0; k < line.size(); ++k) {
    Complex sum{};
    for (std::size_t n = 0; n < line.size(); ++n) sum += line[n] * factor(k, n);
    worst.add(parts_of(got[k]), parts_of(sum), bound(line.size()), static_cast<long>(line.size()));
  }
}

TEST(Fourier, IsTheSumOfItsDefinition) {
  test::Random random(20261);
  test::Worst worst("Fourier transform, seed 20261");
  for (const std::size_t length : lengths) {
    const std::vector<Complex> line = random_line(random, length);
    std::vector<Complex> got = line;
    Fourier(length).transform(got.data());
    compare_with_sums(line, got, worst, [&](std::size_t k, std::size_t n) {
      return std::polar(1.0, -2 * pi * static_cast<double>(k * n % length) / static_cast<double>(length));
    });
  }
}

TEST(Cosine, IsTheSumOfItsDefinition) {
  test::Random random(20262);
  test::Worst worst("cosine transform, seed 20262");
  for (const std::size_t length : lengths) {
    const std::vector<Complex> line = random_line(random, length);
    std::vector<Complex> got = line;
    Cosine(length).transform(got.data());
    compare_with_sums(line, got, worst, [&](std::size_t k, std::size_t n) {
      // Angles within a turn: beyond it the cosine's argument is rounded too coarsely.
      const std::size_t quarter_steps = k * (2 * n + 1) % (4 * length);
      return Complex(std::cos(0.5 * pi * static_cast<double>(quarter_steps) / static_cast<double>(length)));
    });
  }
}

template <class Transform>
void expect_inverse(test::Worst& worst, test::Random& random) {
  for (const std::size_t length : lengths) {
    const std::vector<Complex> line = random_line(random, length);
    std::vector<Complex> got = line;
    Transform transform(length);
    transform.transform(got.data());
    transform.inverse(got.data());
    for (std::size_t n = 0; n < length; ++n)
      worst.add(parts_of(got[n]), parts_of(line[n]), bound(length), static_cast<long>(length));
  }
}

TEST(Transforms, AreUndoneByTheirInverses) {
  test::Random random(20263);
  test::Worst fourier("inverse Fourier transform, seed 20263");
  expect_inverse<Fourier>(fourier, random);
  test::Worst cosine("inverse cosine transform, seed 20263");
  expect_inverse<Cosine>(cosine, random);
}

} // namespace
} // namespace surfgrad::maps
