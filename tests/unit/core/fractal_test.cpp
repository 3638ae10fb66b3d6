#include "unit/core/gradient_check.hpp"

#include <surfgrad/fractal.hpp>
#include <surfgrad/worley.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace surfgrad {
namespace {

using test::check_gradient;
using test::GradientCheck;
using test::PointSource;

constexpr std::uint64_t seed = 20240613;
constexpr Fractal<double> six_octaves{6, 2.03, 0.55};
constexpr double exactness = 1e-6; // the project's bound for exact gradients
// Kinks of the highest octave lie within a step 32 times as often as those of the first.
constexpr double small_step = 0x1p-19;

/// The sums from their definition; `shape` maps an octave's noise to its contribution.
template <class Shape>
double definition(vec3<double> p, Fractal<double> fractal, double width, Shape shape) {
  double sum = 0;
  for (int i = 0; i < fractal.octaves; ++i) {
    const double frequency = std::pow(fractal.lacunarity, i);
    const double t = std::clamp((frequency * width - 0.25) / 0.5, 0.0, 1.0);
    sum += std::pow(fractal.gain, i) * (1 - t * t * (3 - 2 * t)) * shape(perlin(frequency * p).value);
  }
  return sum;
}

TEST(Fractal, SumsAreThoseOfTheirDefinition) {
  PointSource points(seed, 20);
  for (int i = 0; i < 2000; ++i) {
    const vec3<double> p = points();
    const double width = i % 2 == 0 ? 0.0 : 0.001 * (i % 500);
    // Frequencies reach 35 at coordinates up to 20: their rounding (eps * 700) times the slope.
    constexpr double rounding = 1e-11;
    EXPECT_NEAR(fractal_sum(p, six_octaves, width).value,
                definition(p, six_octaves, width, [](double v) { return v; }), rounding);
    EXPECT_NEAR(turbulence(p, six_octaves, width).value,
                definition(p, six_octaves, width, [](double v) { return std::abs(v); }), rounding);
    EXPECT_NEAR(
        ridged(p, six_octaves, width).value,
        definition(p, six_octaves, width, [](double v) { return (1 - std::abs(v)) * (1 - std::abs(v)); }),
        rounding);
  }
}

TEST(Fractal, GradientOfTheSumIsExactForEveryWidth) {
  for (const double width : {0.0, 0.02, 0.1, 0.4}) {
    const GradientCheck check =
        check_gradient([width](vec3<double> p) { return fractal_sum(p, six_octaves, width); },
                       PointSource(seed, 10), 5000, small_step);
    test::print("fractal sum", check);
    EXPECT_EQ(check.kinks, 0);
    EXPECT_LT(check.relative_error(), exactness);
  }
}

TEST(Fractal, GradientsOfTurbulenceAndRidgesAreExactAwayFromKinks) {
  for (const double width : {0.0, 0.1}) {
    const GradientCheck folded =
        check_gradient([width](vec3<double> p) { return turbulence(p, six_octaves, width); },
                       PointSource(seed, 10), 5000, small_step);
    test::print("turbulence", folded);
    EXPECT_LT(folded.relative_error(), exactness);
    EXPECT_LT(folded.kink_share(), 0.01);
    const GradientCheck crests =
        check_gradient([width](vec3<double> p) { return ridged(p, six_octaves, width); },
                       PointSource(seed, 10), 5000, small_step);
    test::print("ridged", crests);
    EXPECT_LT(crests.relative_error(), exactness);
    EXPECT_LT(crests.kink_share(), 0.01);
  }
}

TEST(Fractal, DentedTurbulenceFollowsTheChainRule) {
  const GradientCheck check =
      check_gradient([](vec3<double> p) { return power(turbulence(p, six_octaves), 3.0); },
                     PointSource(seed, 10), 5000, small_step);
  test::print("turbulence to the power 3", check);
  EXPECT_LT(check.relative_error(), exactness);
  EXPECT_LT(check.kink_share(), 0.01);
}

TEST(Fractal, AcceptsAnyBasis) {
  const auto basis = [](auto p) { return simplex(p); };
  const vec3<double> p{0.3, -4.7, 2.2};
  const Noise<double> one = fractal_sum(p, {1, 2.0, 0.5}, 0.0, basis);
  EXPECT_EQ(one.value, simplex(p).value);
  const GradientCheck check = check_gradient(
      [basis](vec3<double> q) {
        return fractal_sum(q, {3, 1.9, 0.6}, 0.0, basis);
      },
      PointSource(seed, 10), 2000);
  EXPECT_LT(check.relative_error(), exactness);
  const Noise<double> cells =
      turbulence(p, {2, 2.0, 0.5}, 0.0, [](vec3<double> q) { return worley(q, WorleyKind::f2_minus_f1); });
  EXPECT_GT(cells.value, 0);
}

TEST(Fractal, OctavesFadeAsTheirCellsNearThePixel) {
  const vec3<double> p{0.3, -4.7, 2.2};
  const Fractal<double> one{1, 2, 0.5};
  const double whole = fractal_sum(p, one).value;
  EXPECT_EQ(fractal_sum(p, one, 0.25).value, whole);
  EXPECT_DOUBLE_EQ(fractal_sum(p, one, 0.5).value, 0.5 * whole);
  EXPECT_EQ(fractal_sum(p, one, 0.75).value, 0);
  EXPECT_EQ(max_abs(fractal_sum(p, one, 0.75).gradient), 0);
  // NaN and negative widths leave the sum whole.
  EXPECT_EQ(fractal_sum(p, one, -1.0).value, whole);
  EXPECT_EQ(fractal_sum(p, one, std::numeric_limits<double>::quiet_NaN()).value, whole);
}

TEST(Fractal, InvisibleOctavesAreNotEvaluated) {
  int evaluations = 0;
  const auto counted = [&evaluations](vec3<double> p) { return ++evaluations, perlin(p); };
  const vec3<double> p{1.3, 2.7, 3.1};
  EXPECT_EQ(fractal_sum(p, {10, 2.0, 0.5}, 0.1, counted).value, fractal_sum(p, {3, 2.0, 0.5}, 0.1).value);
  EXPECT_EQ(evaluations, 3); // frequencies 1, 2, 4; from 8 on a pixel covers 0.8 cells
}

TEST(Fractal, FaultyParametersGiveFiniteSums) {
  const vec3<float> p{0.3f, -4.7f, 2.2f};
  constexpr float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(fractal_sum(p, {0, 2.f, 0.5f}).value, 0);
  EXPECT_EQ(fractal_sum(p, {-5, 2.f, 0.5f}).value, 0);
  for (const float lacunarity : {1e30f, inf, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(fractal_sum(p, {1000, lacunarity, 0.5f}).value, perlin(p).value);
  }
  const Noise<float> deep = turbulence(vec3<float>{1e30f, inf, -inf}, {1000, 2.f, 0.5f});
  EXPECT_TRUE(std::isfinite(deep.value) && std::isfinite(max_abs(deep.gradient)));
}

TEST(Fractal, FloatAndDoubleAgree) {
  PointSource points(seed, 8);
  const Fractal<float> narrow_fractal{6, 2, 0.5f};
  const Fractal<double> wide_fractal{6, 2, 0.5};
  double value = 0, gradient = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3<double> p = points();
    const vec3<float> q{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    const Noise<float> narrow = fractal_sum(q, narrow_fractal, 0.05f);
    const Noise<double> wide = fractal_sum(vec3<double>{q.x, q.y, q.z}, wide_fractal, double(0.05f));
    value = std::max(value, std::abs(narrow.value - wide.value));
    const vec3<double> g{narrow.gradient.x, narrow.gradient.y, narrow.gradient.z};
    gradient = std::max(gradient, max_abs(g - wide.gradient));
  }
  constexpr double eps = std::numeric_limits<float>::epsilon();
  std::cout << "float against double: value " << value / eps << " eps, gradient " << gradient / eps
            << " eps (seed " << seed << ")\n";
  // Powers of two scale exactly, so the basis' 32 and 128 eps add with weights 2^-i and 1, and 2 eps an
  // octave of the largest terms, 1.04 and 3.75.
  EXPECT_LT(value, (2 * 32 + 6 * 2 * 1.04) * eps);
  EXPECT_LT(gradient, (6 * 128 + 6 * 2 * 3.75) * eps);
}

} // namespace
} // namespace surfgrad
