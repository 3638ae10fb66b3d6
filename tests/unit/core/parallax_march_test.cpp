#include <surfgrad/parallax_march.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <random>

namespace surfgrad {
namespace {

constexpr std::uint64_t seed = 20240615;

template <class T>
class ParallaxMarch : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(ParallaxMarch, Scalars);

template <class T>
double eps_of() {
  return static_cast<double>(std::numeric_limits<T>::epsilon());
}

TYPED_TEST(ParallaxMarch, MeetsAFlatMapAtItsHeight) {
  using T = TypeParam;
  const vec2<T> st{T(0.3), T(0.8)}, dst{T(0.1), T(-0.25)};
  double worst = 0;
  for (int steps : {1, 2, 7, 32}) {
    for (int i = 0; i <= 1000; ++i) {
      const T height = T(i) / T(1000);
      const auto hit = march_parallax([height](vec2<T>, T, bool) { return height; }, st, dst, steps);
      ASSERT_TRUE(hit.hit);
      worst = std::max(worst, std::abs(static_cast<double>(hit.height - height)) / eps_of<T>());
      EXPECT_EQ(hit.texture_coordinate.x, st.x + hit.height * dst.x);
      EXPECT_EQ(hit.texture_coordinate.y, st.y + hit.height * dst.y);
    }
  }
  std::cout << "worst error " << worst << " eps\n";
  EXPECT_LE(worst, 4); // the documented bound, ray and map approaching at rate 1
}

TYPED_TEST(ParallaxMarch, MeetsTheTopAndTheBottomExactly) {
  using T = TypeParam;
  const vec2<T> st{T(0.3), T(0.8)}, dst{T(0.1), T(-0.25)};
  for (const T height : {T(1), T(1.5), T(1e30), std::numeric_limits<T>::infinity()}) {
    const auto top = march_parallax([height](vec2<T>, T, bool) { return height; }, st, dst, 16);
    EXPECT_TRUE(top.hit);
    EXPECT_EQ(top.height, 1);
  }
  const auto bottom = march_parallax([](vec2<T>, T, bool) { return T(0); }, st, dst, 16);
  EXPECT_TRUE(bottom.hit);
  EXPECT_EQ(bottom.height, 0);
  EXPECT_EQ(bottom.texture_coordinate.x, st.x);
}

TYPED_TEST(ParallaxMarch, MeetsARampWhereAlgebraDoes) {
  using T = TypeParam;
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> unit(0, 1), slope(-0.9, 0.9);
  double worst = 0;
  for (int i = 0; i < 5000; ++i) {
    const vec2<T> st{T(unit(engine)), T(unit(engine))};
    const vec2<T> dst{T(slope(engine)), T(slope(engine))};
    const vec2<T> gradient{T(slope(engine)), T(slope(engine))};
    const T base = T(0.05 + 0.9 * unit(engine)); // height of the ramp at st
    const auto ramp = [&](vec2<T> uv, T, bool) { return base + dot(gradient, uv - st); };
    // base + h * rise = h
    const double rise = static_cast<double>(gradient.x) * dst.x + static_cast<double>(gradient.y) * dst.y;
    const double expected = static_cast<double>(base) / (1 - rise);
    if (expected > 1) continue; // enters through the ramp's side: height 1 at once
    const auto hit = march_parallax(ramp, st, dst, 16);
    ASSERT_TRUE(hit.hit);
    worst = std::max(worst, std::abs(static_cast<double>(hit.height) - expected) * (1 - rise) / eps_of<T>());
  }
  std::cout << "worst error " << worst << " eps / rate (seed " << seed << ")\n";
  // The march's own 4 eps; evaluating the ramp at a rounded coordinate adds four roundings of order one.
  EXPECT_LE(worst, 8);
}

TYPED_TEST(ParallaxMarch, BracketsAJumpToItsDocumentedWidth) {
  using T = TypeParam;
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  for (const int steps : {1, 4, 16, 64}) {
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
      const T edge = T(unit(engine));
      // A wall of height 1 wherever the ray has come below `edge`.
      const auto wall = [edge](vec2<T> uv, T, bool) { return uv.x < edge ? T(1) : T(0); };
      const auto hit = march_parallax(wall, vec2<T>{T(0), T(0)}, vec2<T>{T(1), T(0)}, steps);
      ASSERT_TRUE(hit.hit);
      worst = std::max(worst, std::abs(static_cast<double>(hit.height - edge)) * steps);
    }
    std::cout << steps << " steps: worst error " << worst << " of a step (seed " << seed << ")\n";
    EXPECT_LE(worst, 1.0 / 64 + 16 * eps_of<T>() * steps);
  }
}

TYPED_TEST(ParallaxMarch, FindsTheFirstOfSeveralCrossings) {
  using T = TypeParam;
  // Three walls, thicker than a step, over the ray's way from 1 to 0.
  const auto walls = [](vec2<T> uv, T, bool) {
    const bool first = T(0.70) < uv.x && uv.x < T(0.80);
    const bool second = T(0.40) < uv.x && uv.x < T(0.50);
    return first || second ? T(0.95) : T(0);
  };
  const auto hit = march_parallax(walls, vec2<T>{T(0), T(0)}, vec2<T>{T(1), T(0)}, 16);
  EXPECT_TRUE(hit.hit);
  EXPECT_NEAR(static_cast<double>(hit.height), 0.80, 1.0 / (64 * 16));
  // A tall wall before it hides it; a wall below the ray does not.
  const auto behind = [&](vec2<T> uv, T lod, bool active) {
    return T(0.86) < uv.x && uv.x < T(0.99) ? T(0.85) : walls(uv, lod, active);
  };
  EXPECT_NEAR(
      static_cast<double>(march_parallax(behind, vec2<T>{T(0), T(0)}, vec2<T>{T(1), T(0)}, 16).height), 0.80,
      1.0 / (64 * 16));
}

TYPED_TEST(ParallaxMarch, ReportsWhereNothingIsMet) {
  using T = TypeParam;
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  constexpr T inf = std::numeric_limits<T>::infinity();
  const vec2<T> st{T(0.3), T(0.8)};
  for (const T height : {T(-0.001), T(-1), -inf, nan}) {
    for (const vec2<T> dst : {vec2<T>{T(0.1), T(0.2)}, vec2<T>{T(0), T(0)}, vec2<T>{inf, nan}}) {
      int calls = 0;
      const auto miss = march_parallax([&](vec2<T>, T, bool) { return ++calls, height; }, st, dst, 16);
      EXPECT_FALSE(miss.hit);
      EXPECT_EQ(miss.height, 0);
      EXPECT_EQ(miss.texture_coordinate.x, st.x);
      EXPECT_EQ(miss.texture_coordinate.y, st.y);
      EXPECT_EQ(calls, 17);
    }
  }
}

TYPED_TEST(ParallaxMarch, PassesOverHolesOfNaN) {
  using T = TypeParam;
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  for (const T flat : {T(0.25), T(0.5), T(0.75)}) {
    const auto holed = [flat](vec2<T> uv, T, bool) { return uv.x > T(0.6) ? nan : flat; };
    const auto hit = march_parallax(holed, vec2<T>{T(0), T(0)}, vec2<T>{T(1), T(0)}, 16);
    EXPECT_TRUE(hit.hit);
    // The ray drops past 0.75 inside the hole, and comes out of it under the surface, at the hole's rim.
    EXPECT_NEAR(static_cast<double>(hit.height), std::min(static_cast<double>(flat), 0.6), 1.0 / (64 * 16));
  }
}

TYPED_TEST(ParallaxMarch, WithoutAWayGivesTheHeightInPlace) {
  using T = TypeParam;
  const vec2<T> st{T(0.3), T(0.8)}, none{T(0), T(0)};
  const auto bumps = [](vec2<T> uv, T, bool) { return T(0.5) + T(0.5) * (uv.x - uv.y); };
  const auto hit = march_parallax(bumps, st, none, 8);
  EXPECT_TRUE(hit.hit);
  EXPECT_NEAR(static_cast<double>(hit.height), 0.25, 4 * eps_of<T>());
  EXPECT_EQ(hit.texture_coordinate.x, st.x);
  EXPECT_EQ(hit.texture_coordinate.y, st.y);
}

TYPED_TEST(ParallaxMarch, EndsForAnyStepLimit) {
  using T = TypeParam;
  for (const int steps : {0, -7, std::numeric_limits<int>::min()}) {
    const auto hit = march_parallax([](vec2<T>, T, bool) { return T(0.5); }, vec2<T>{T(0), T(0)},
                                    vec2<T>{T(1), T(0)}, steps);
    EXPECT_TRUE(hit.hit);
    EXPECT_NEAR(static_cast<double>(hit.height), 0.5, 4 * eps_of<T>());
  }
  int calls = 0;
  const auto miss = march_parallax([&calls](vec2<T>, T, bool) { return ++calls, T(-1); }, vec2<T>{T(0), T(0)},
                                   vec2<T>{T(1), T(0)}, std::numeric_limits<int>::max());
  EXPECT_FALSE(miss.hit);
  EXPECT_EQ(calls, parallax_most_steps + 1);
}

TYPED_TEST(ParallaxMarch, StopsLookingOnceMetAndAsksForTheCallersLevel) {
  using T = TypeParam;
  int calls = 0;
  const auto map = [&calls](vec2<T>, T lod, bool active) {
    ++calls;
    EXPECT_EQ(lod, 0);
    EXPECT_TRUE(active);
    return T(0.9);
  };
  EXPECT_TRUE(march_parallax(map, vec2<T>{T(0), T(0)}, vec2<T>{T(1), T(0)}, 1000).hit);
  EXPECT_EQ(calls, 101 + parallax_refinements); // rays 1, 0.999, ... 0.9
}

TEST(ParallaxMarchPrecision, FloatFollowsDoubleOverASmoothMap) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> unit(0, 1), way(-0.05, 0.05);
  double worst = 0, distance_to_map = 0;
  int apart = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto waves = [](auto uv, auto, bool) {
      using T = decltype(uv.x);
      return T(0.5 + 0.2 * std::sin(40.0 * double(uv.x)) + 0.2 * std::cos(30.0 * double(uv.y)));
    };
    const vec2<float> st{float(unit(engine)), float(unit(engine))},
        dst{float(way(engine)), float(way(engine))};
    const auto narrow = march_parallax(waves, st, dst, 32);
    const vec2<double> wide_st{st.x, st.y}, wide_dst{dst.x, dst.y};
    const auto wide = march_parallax(waves, wide_st, wide_dst, 32);
    ASSERT_TRUE(narrow.hit && wide.hit);
    distance_to_map =
        std::max(distance_to_map, std::abs(waves(wide.texture_coordinate, 0.0, true) - wide.height));
    const double off = std::abs(double(narrow.height) - wide.height);
    // A ray that grazes the map within rounding may meet it a wave earlier or later.
    if (off > 1e-4) {
      ++apart;
    } else {
      worst = std::max(worst, off);
    }
  }
  std::cout << "worst float error " << worst << ", other crossing in " << apart
            << " of 20000, double's height off the map by at most " << distance_to_map << " (seed " << seed
            << ")\n";
  EXPECT_LT(apart, 20);
  // A chord of length 1 / (64 * 32) of ray height leaves 1/8 * its square times the curvature along the
  // ray, at most 0.2 * (40 * 0.05)^2 + 0.2 * (30 * 0.05)^2.
  EXPECT_LT(distance_to_map, 1.25 / 8 / (64.0 * 64 * 32 * 32));
}

} // namespace
} // namespace surfgrad
