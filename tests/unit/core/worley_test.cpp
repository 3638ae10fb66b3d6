#include "unit/core/gradient_check.hpp"

#include <surfgrad/worley.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace surfgrad {
namespace {

using test::check_gradient;
using test::GradientCheck;
using test::PointSource;

constexpr std::uint64_t seed = 20240612;

/// Distances to the two nearest feature points among those of 7 x 7 x 7 cells, counted as 1 from 1 on.
std::array<double, 2> two_nearest(vec3<double> p) {
  std::array<double, 2> distance{1, 1};
  for (int z = -3; z <= 3; ++z) {
    for (int y = -3; y <= 3; ++y) {
      for (int x = -3; x <= 3; ++x) {
        const double cx = std::floor(p.x) + x, cy = std::floor(p.y) + y, cz = std::floor(p.z) + z;
        const std::uint32_t h = lattice_hash<double>(int(cx), int(cy), int(cz));
        const auto inside_cell = [&](int bits) { return ((h >> bits) % 1024 + 0.5) / 1024; };
        const double d =
            std::hypot(p.x - cx - inside_cell(0), p.y - cy - inside_cell(10), p.z - cz - inside_cell(20));
        if (d < distance[0]) {
          distance = {d, distance[0]};
        } else {
          distance[1] = std::min(distance[1], d);
        }
      }
    }
  }
  return distance;
}

TEST(Worley, IsTheDistanceToTheNearestFeaturePointsHoweverFarOneLooks) {
  PointSource points(seed, 60);
  double worst = 0;
  int capped = 0;
  for (int i = 0; i < 20000; ++i) {
    const vec3<double> p = points();
    const auto [f1, f2] = two_nearest(p);
    worst = std::max({worst, std::abs(worley(p).value - f1),
                      std::abs(worley(p, WorleyKind::f2_minus_f1).value - (f2 - f1))});
    capped += f2 == 1;
  }
  std::cout << "worst difference from the definition " << worst << ", second distance capped in " << capped
            << " of 20000 (seed " << seed << ")\n";
  // Coordinates up to 60 round at 64 eps when the definition subtracts cells from them.
  EXPECT_LT(worst, 64 * std::numeric_limits<double>::epsilon());
  EXPECT_GT(capped, 0);
}

TEST(Worley, GradientIsExactAwayFromKinks) {
  for (const WorleyKind kind : {WorleyKind::f1, WorleyKind::f2_minus_f1}) {
    const GradientCheck check =
        check_gradient([kind](vec3<double> p) { return worley(p, kind); }, PointSource(seed, 40), 20000);
    test::print(kind == WorleyKind::f1 ? "worley f1" : "worley f2 - f1", check);
    EXPECT_LT(check.relative_error(), 1e-6); // the project's bound for exact gradients
    EXPECT_LT(check.kink_share(), 0.01);
  }
}

TEST(Worley, IsContinuous) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> coordinate(-200, 200);
  double rise = 0;
  for (int i = 0; i < 100000; ++i) {
    // Either side of a cell's face, where the cells searched change.
    const vec3<double> p{std::round(coordinate(engine)), coordinate(engine), coordinate(engine)};
    const vec3<double> step{1e-9, 0, 0};
    for (const WorleyKind kind : {WorleyKind::f1, WorleyKind::f2_minus_f1}) {
      rise = std::max(rise, std::abs(worley(p + step, kind).value - worley(p - step, kind).value));
    }
  }
  std::cout << "largest step over 2e-9: " << rise << " (seed " << seed << ")\n";
  EXPECT_LT(rise, 2 * 2e-9 + 1e-12); // the gradient is at most 2, distances round at some eps * 200
}

TEST(Worley, StaysInRangeWithGradientsOfTheRightLength) {
  PointSource points(seed, 500);
  for (int i = 0; i < 100000; ++i) {
    const vec3<double> p = points();
    const Noise<double> f1 = worley(p);
    const Noise<double> border = worley(p, WorleyKind::f2_minus_f1);
    ASSERT_TRUE(f1.value >= 0 && f1.value <= 1 && border.value >= 0 && border.value <= 1);
    ASSERT_NEAR(length(f1.gradient), f1.value < 1 ? 1 : 0, 1e-14);
    ASSERT_LE(length(border.gradient), 2 + 1e-14);
  }
}

TEST(Worley, HasNoGradientAtAFeaturePoint) {
  const std::uint32_t h = lattice_hash<float>(4, 5, 6);
  const auto inside_cell = [&](int bits) { return (static_cast<float>((h >> bits) % 1024) + 0.5f) / 1024; };
  const vec3<float> feature{4 + inside_cell(0), 5 + inside_cell(10), 6 + inside_cell(20)};
  const Noise<float> f1 = worley(feature);
  EXPECT_EQ(f1.value, 0);
  EXPECT_EQ(max_abs(f1.gradient), 0);
  EXPECT_NEAR(length(worley(feature, WorleyKind::f2_minus_f1).gradient), 1, 1e-6);
}

TEST(Worley, FloatKeepsTheDocumentedError) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<float> coordinate(0, 100); // where subtracting the cell is exact
  constexpr double eps = std::numeric_limits<float>::epsilon();
  double value = 0, gradient = 0;
  int ties = 0;
  for (int i = 0; i < 100000; ++i) {
    const vec3<float> p{coordinate(engine), coordinate(engine), coordinate(engine)};
    const Noise<float> narrow = worley(p);
    const Noise<double> wide = worley(vec3<double>{p.x, p.y, p.z});
    value = std::max(value, std::abs(narrow.value - wide.value) / eps);
    // Where two distances agree to rounding (or both are capped), either point may count as nearest.
    if (worley(vec3<double>{p.x, p.y, p.z}, WorleyKind::f2_minus_f1).value < 8 * eps) {
      ++ties;
      continue;
    }
    const vec3<double> g{narrow.gradient.x, narrow.gradient.y, narrow.gradient.z};
    gradient = std::max(gradient, max_abs(g - wide.gradient) * wide.value / eps);
  }
  std::cout << "float against double: value " << value << " eps, gradient " << gradient << " eps / distance, "
            << ties << " ties (seed " << seed << ")\n";
  EXPECT_LT(value, 4);
  EXPECT_LT(gradient, 8);
  EXPECT_LT(ties, 1000); // 1 %, as for the kinks
}

TEST(Worley, StaysFiniteAndBoundedBeyondTheLattice) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float x : {0.f, -0.f, 1e-30f, 2147483648.f, -2147483648.f, 3e9f, 1e30f, inf, -inf, nan}) {
    for (const WorleyKind kind : {WorleyKind::f1, WorleyKind::f2_minus_f1}) {
      const Noise<float> n = worley(vec3<float>{x, 1.5f, -x}, kind);
      EXPECT_TRUE(n.value >= 0 && n.value <= 1) << x;
      EXPECT_TRUE(std::isfinite(max_abs(n.gradient))) << x;
    }
  }
}

} // namespace
} // namespace surfgrad
