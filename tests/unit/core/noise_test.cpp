#include "unit/core/gradient_check.hpp"

#include <surfgrad/noise.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace surfgrad {
namespace {

using test::check_gradient;
using test::GradientCheck;
using test::PointSource;

constexpr std::uint64_t seed = 20240611;

// The project's bound for exact gradients: differences of doubles are good to about 1e-8 here (third
// derivatives of Perlin's fade jump at cell borders), a wrong term is at least a thousand times larger.
constexpr double exactness = 1e-6;

// ----------------------------------------------------------------------------------------- Perlin

// The permutation that Perlin published with his noise of 2002.
constexpr std::array<int, 256> perlin_permutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,
    69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,
    94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136,
    171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161,
    1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196, 135, 130, 116, 188, 159, 86,
    164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126,
    255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,   129, 22,  39,  253,
    19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,  242, 193,
    238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

int permuted(int i) { return perlin_permutation[static_cast<std::size_t>(i & 255)]; }

std::uint32_t perlin_hash(std::int32_t x, std::int32_t y, std::int32_t z) {
  return static_cast<std::uint32_t>(permuted(permuted(permuted(x) + y) + z));
}

/// Improved noise from its definition: the interpolated sum of eight ramps, one direction each.
double improved_noise(double x, double y, double z) {
  constexpr std::array<std::array<int, 3>, 16> directions{{{1, 1, 0},
                                                           {-1, 1, 0},
                                                           {1, -1, 0},
                                                           {-1, -1, 0},
                                                           {1, 0, 1},
                                                           {-1, 0, 1},
                                                           {1, 0, -1},
                                                           {-1, 0, -1},
                                                           {0, 1, 1},
                                                           {0, -1, 1},
                                                           {0, 1, -1},
                                                           {0, -1, -1},
                                                           {1, 1, 0},
                                                           {0, -1, 1},
                                                           {-1, 1, 0},
                                                           {0, -1, -1}}};
  const auto weight = [](double t) {
    t = std::abs(t);
    return 1 - t * t * t * (10 - 15 * t + 6 * t * t);
  };
  double sum = 0;
  for (int dz = 0; dz < 2; ++dz) {
    for (int dy = 0; dy < 2; ++dy) {
      for (int dx = 0; dx < 2; ++dx) {
        const double cx = std::floor(x) + dx, cy = std::floor(y) + dy, cz = std::floor(z) + dz;
        const auto& d = directions[perlin_hash(int(cx), int(cy), int(cz)) & 15u];
        sum += weight(x - cx) * weight(y - cy) * weight(z - cz) *
               (d[0] * (x - cx) + d[1] * (y - cy) + d[2] * (z - cz));
      }
    }
  }
  return sum;
}

TEST(Perlin, GivesThePublishedNoiseWithThePublishedPermutation) {
  std::array<int, 256> sorted = perlin_permutation;
  std::sort(sorted.begin(), sorted.end());
  std::array<int, 256> all{};
  std::iota(all.begin(), all.end(), 0);
  ASSERT_EQ(sorted, all);

  // A value that implementations of the published code agree on.
  EXPECT_NEAR(perlin(vec3<double>{3.14, 42, 7}, perlin_hash).value, 0.13691995878400012, 1e-15);

  PointSource points(seed, 300);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3<double> p = points();
    worst = std::max(worst, std::abs(perlin(p, perlin_hash).value - improved_noise(p.x, p.y, p.z)));
  }
  std::cout << "worst difference from the definition: " << worst << " (seed " << seed << ")\n";
  // Two orders of summing eight terms of magnitude up to 1: a few units in the last place.
  EXPECT_LT(worst, 16 * std::numeric_limits<double>::epsilon());
}

TEST(Perlin, GradientIsExactEverywhere) {
  const GradientCheck own =
      check_gradient([](vec3<double> p) { return perlin(p); }, PointSource(seed, 40), 20000);
  test::print("perlin", own);
  EXPECT_EQ(own.kinks, 0);
  EXPECT_LT(own.relative_error(), exactness);

  const GradientCheck published =
      check_gradient([](vec3<double> p) { return perlin(p, perlin_hash); }, PointSource(seed, 40), 20000);
  test::print("perlin, published permutation", published);
  EXPECT_LT(published.relative_error(), exactness);
}

/// A hash that chooses, corner by corner, what the caller prepared for the cell at the origin.
struct ChosenCorners {
  std::array<std::uint32_t, 8> choice;
  std::uint32_t operator()(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return choice[static_cast<std::size_t>(x + 2 * y + 4 * z)];
  }
};

/// Best choice of the eight directions for a quantity that is linear in each of them.
template <class Quantity>
double maximised(vec3<double> p, Quantity quantity) {
  ChosenCorners corners{};
  for (std::size_t c = 0; c < 8; ++c) {
    double best = -std::numeric_limits<double>::infinity();
    std::uint32_t chosen = 0;
    for (std::uint32_t direction = 0; direction < 16; ++direction) {
      corners.choice[c] = direction;
      const double q = quantity(perlin(p, corners));
      if (q > best) best = q, chosen = direction;
    }
    corners.choice[c] = chosen;
  }
  return quantity(perlin(p, corners));
}

TEST(Perlin, StaysWithinTheDocumentedBoundsAndReachesThem) {
  const auto value = [](Noise<double> n) { return n.value; };
  EXPECT_NEAR(maximised({0.4815, 0.3553, 0.5}, value), 1.0363, 1e-3);
  const double third = 1 / std::sqrt(3.0);
  double largest_value = 0, largest_gradient = 0;
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 3000; ++i) {
    const vec3<double> p{unit(engine), unit(engine), unit(engine)};
    const vec3<double> d =
        normalize_or_zero(vec3<double>{unit(engine) - 0.5, unit(engine) - 0.5, unit(engine) - 0.5});
    largest_value = std::max(largest_value, maximised(p, value));
    largest_gradient =
        std::max(largest_gradient, maximised(p, [d](Noise<double> n) { return dot(n.gradient, d); }));
  }
  const vec3<double> diagonal{third, third, third};
  const vec3<double> middle{0.5, 0.5, 0.5};
  for (const vec3<double> d : {diagonal, vec3<double>{1, 0, 0}}) {
    largest_gradient =
        std::max(largest_gradient, maximised(middle, [d](Noise<double> n) { return dot(n.gradient, d); }));
  }
  std::cout << "worst directions at random points: value " << largest_value << ", gradient "
            << largest_gradient << " (seed " << seed << ")\n";
  EXPECT_LT(largest_value, 1.0364);
  EXPECT_LT(largest_gradient, 3.7500001);
  EXPECT_GT(largest_gradient, 3.7);
}

// ---------------------------------------------------------------------------------------- simplex

TEST(Simplex, GradientIsExactEverywhere) {
  const GradientCheck check =
      check_gradient([](vec3<double> p) { return simplex(p); }, PointSource(seed, 40), 20000);
  test::print("simplex", check);
  EXPECT_EQ(check.kinks, 0);
  EXPECT_LT(check.relative_error(), exactness);
}

TEST(Simplex, StaysWithinTheDocumentedBounds) {
  PointSource points(seed, 1000);
  double value = 0, gradient = 0;
  for (int i = 0; i < 1000000; ++i) {
    const Noise<double> n = simplex(points());
    value = std::max(value, std::abs(n.value));
    gradient = std::max(gradient, length(n.gradient));
  }
  std::cout << "largest |value| " << value << ", |gradient| " << gradient << " (seed " << seed << ")\n";
  EXPECT_LE(value, 1);
  EXPECT_GT(value, 0.9);
  EXPECT_LE(gradient, 6.97);
  EXPECT_GT(gradient, 5.5);
}

TEST(Simplex, ValueAndGradientAreContinuousWhereSimplicesMeet) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> coordinate(-20, 20), tiny(-1e-9, 1e-9);
  double value_jump = 0, gradient_jump = 0;
  for (int i = 0; i < 200000; ++i) {
    vec3<double> p{coordinate(engine), coordinate(engine), coordinate(engine)};
    if (i % 2 == 0) {
      p.y = p.x + std::round(p.y - p.x); // faces between simplices of one cell, where components tie
    } else {
      const double skewed = p.x + (p.x + p.y + p.z) / 3; // faces between cells
      p.x -= 0.75 * (skewed - std::round(skewed));
    }
    const Noise<double> a = simplex(p);
    const Noise<double> b = simplex(p + vec3<double>{tiny(engine), tiny(engine), tiny(engine)});
    value_jump = std::max(value_jump, std::abs(a.value - b.value));
    gradient_jump = std::max(gradient_jump, length(a.gradient - b.gradient));
  }
  std::cout << "largest step over 1e-9: value " << value_jump << ", gradient " << gradient_jump << " (seed "
            << seed << ")\n";
  // A way of sqrt(3) * 1e-9 at a gradient of at most 6.97; second derivatives stay below 100.
  EXPECT_LT(value_jump, 1.3e-8);
  EXPECT_LT(gradient_jump, 2e-7);
}

// --------------------------------------------------------------------------------- precision, edges

struct FloatErrors {
  double value = 0, gradient = 0; // in eps
};

template <class Function>
FloatErrors float_errors(Function noise, double extent) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<float> coordinate(static_cast<float>(-extent), static_cast<float>(extent));
  constexpr double eps = std::numeric_limits<float>::epsilon();
  FloatErrors worst;
  for (int i = 0; i < 200000; ++i) {
    const vec3<float> p{coordinate(engine), coordinate(engine), coordinate(engine)};
    const Noise<float> narrow = noise(p);
    const Noise<double> wide = noise(vec3<double>{p.x, p.y, p.z});
    worst.value = std::max(worst.value, std::abs(narrow.value - wide.value) / eps);
    const vec3<double> g{narrow.gradient.x, narrow.gradient.y, narrow.gradient.z};
    worst.gradient = std::max(worst.gradient, max_abs(g - wide.gradient) / eps);
  }
  std::cout << "float against double within " << extent << ": value " << worst.value << " eps, gradient "
            << worst.gradient << " eps (seed " << seed << ")\n";
  return worst;
}

TEST(Perlin, FloatKeepsTheDocumentedErrorAtAnyDistance) {
  for (const double extent : {1.0, 100.0, 10000.0}) {
    const FloatErrors worst = float_errors([](auto p) { return perlin(p); }, extent);
    EXPECT_LT(worst.value, 32);
    EXPECT_LT(worst.gradient, 128);
  }
}

TEST(Simplex, FloatKeepsTheDocumentedError) {
  for (const double extent : {1.0, 100.0}) {
    const FloatErrors worst = float_errors([](auto p) { return simplex(p); }, extent);
    EXPECT_LT(worst.value, 64 * (1 + extent));
    EXPECT_LT(worst.gradient, 512 * (1 + extent));
  }
}

template <class T>
void expect_finite_at_hostile_coordinates() {
  constexpr T inf = std::numeric_limits<T>::infinity();
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  const std::array hostile{T(0),
                           -T(0),
                           T(1e-30),
                           T(-1e-30),
                           T(2147483647.0),
                           T(-2147483648.0),
                           T(2147483648.0),
                           T(3e9),
                           T(-3e9),
                           T(1e30),
                           T(-1e30),
                           inf,
                           -inf,
                           nan};
  for (const T x : hostile) {
    for (const T y : hostile) {
      const vec3<T> p{x, y, x};
      for (const Noise<T>& n : {perlin(p), simplex(p)}) {
        EXPECT_TRUE(std::isfinite(n.value) && std::isfinite(max_abs(n.gradient))) << x << ", " << y;
        EXPECT_LE(std::abs(n.value), T(1.0364)) << x << ", " << y;
      }
    }
  }
}

TEST(Noise, StaysFiniteAndBoundedBeyondTheLattice) {
  expect_finite_at_hostile_coordinates<float>();
  expect_finite_at_hostile_coordinates<double>();
}

TEST(Noise, IsZeroAtLatticePointsAndNotTheSameInEveryCell) {
  for (int i = -5; i <= 5; ++i) EXPECT_EQ(perlin(vec3<float>{float(i), float(2 * i), 3}).value, 0);
  const float first = perlin(vec3<float>{0.5f, 0.25f, 0.75f}).value;
  int same = 0;
  for (int i = 1; i <= 100; ++i) same += perlin(vec3<float>{0.5f + float(i), 0.25f, 0.75f}).value == first;
  EXPECT_LT(same, 10);
}

// ------------------------------------------------------------------------------------ compositions

TEST(NoisePower, FollowsTheChainRule) {
  for (const double k : {1.0, 2.0, 3.5}) {
    const auto dented = [k](vec3<double> p) {
      Noise<double> n = simplex(p);
      n.value = n.value + 1.1; // positive: the base's kink at 0 is another test's subject
      return power(n, k);
    };
    const GradientCheck check = check_gradient(dented, PointSource(seed, 10), 5000);
    test::print("power", check);
    EXPECT_EQ(check.kinks, 0);
    EXPECT_LT(check.relative_error(), exactness);
  }
}

TEST(NoisePower, IsFlatWhereTheValueIsNotPositive) {
  for (const double value : {0.0, -0.5}) {
    const Noise<double> n = power(Noise<double>{value, {1, 2, 3}}, 2.0);
    EXPECT_EQ(n.value, 0);
    EXPECT_EQ(max_abs(n.gradient), 0);
  }
}

TEST(GradientByDifferences, MatchesAnalyticGradients) {
  const auto f = [](vec3<double> p) { return std::sin(p.x) * std::cos(2 * p.y) + p.z * p.z; };
  PointSource points(seed, 3);
  double central = 0, forward = 0;
  for (int i = 0; i < 1000; ++i) {
    const vec3<double> p = points();
    const vec3<double> exact{std::cos(p.x) * std::cos(2 * p.y), -2 * std::sin(p.x) * std::sin(2 * p.y),
                             2 * p.z};
    central = std::max(central, max_abs(gradient_by_differences(f, p, 1e-5) - exact));
    forward = std::max(forward, max_abs(gradient_by_forward_differences(f, p, f(p), 1e-7) - exact));
  }
  std::cout << "central " << central << ", forward " << forward << " (seed " << seed << ")\n";
  // step^2 / 6 * 8 + eps * 10 / step, and step / 2 * 4 + 2 eps * 10 / step.
  EXPECT_LT(central, 1.4e-10 + 2.3e-10);
  EXPECT_LT(forward, 2e-7 + 4.5e-8);
}

TEST(GradientByDifferences, UsesTheStepThatRoundingLeft) {
  // At 3000 a float step of 1e-3 is off by up to 12 %: a linear function shows it undiminished.
  const auto f = [](vec3<float> p) { return 2 * (p.x - 3000) + p.y; };
  const vec3<float> g = gradient_by_differences(f, vec3<float>{3000.f, 0.f, 0.f}, 1e-3f);
  EXPECT_NEAR(g.x, 2, 4e-6);
  EXPECT_NEAR(g.y, 1, 4e-6);
  const vec3<float> none = gradient_by_differences(f, vec3<float>{1e9f, 0.f, 0.f}, 1e-3f);
  EXPECT_EQ(none.x, 0);
}

} // namespace
} // namespace surfgrad
