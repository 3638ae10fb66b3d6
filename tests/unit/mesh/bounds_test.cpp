#include "mesh/bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace surfgrad::mesh {
namespace {

using Points = std::vector<vec3<float>>;

void expect_equal(const vec3<double>& actual, const vec3<double>& expected) {
  EXPECT_EQ(actual.x, expected.x);
  EXPECT_EQ(actual.y, expected.y);
  EXPECT_EQ(actual.z, expected.z);
}

TEST(Bounds, holds_all_points_tightly) {
  const Bounds b = bounds_of(Points{{1, -2, 3}, {-4, 5, 0}, {0, 0, 9}});
  expect_equal(b.low, {-4, -2, 0});
  expect_equal(b.high, {1, 5, 9});
  expect_equal(center(b), {-1.5, 1.5, 4.5});
  EXPECT_EQ(radius(bounds_of(Points{{1, 1, 1}, {3, 4, 7}})), 3.5); // half of sqrt(4 + 9 + 36)
}

TEST(Bounds, of_one_point_is_not_empty_and_has_no_radius) {
  const Bounds b = bounds_of(Points{{1, 2, 3}});
  EXPECT_FALSE(is_empty(b));
  expect_equal(center(b), {1, 2, 3});
  EXPECT_EQ(radius(b), 0);
}

TEST(Bounds, of_nothing_is_empty_with_a_finite_center_and_radius) {
  const Bounds b = bounds_of({});
  EXPECT_TRUE(is_empty(b));
  expect_equal(center(b), {0, 0, 0});
  EXPECT_EQ(radius(b), 0);
}

TEST(Bounds, union_covers_both_and_ignores_the_empty_one) {
  const Bounds a = bounds_of(Points{{0, 0, 0}, {1, 1, 1}});
  const Bounds b = bounds_of(Points{{5, -1, 0.5f}});
  const Bounds both = unite(a, b);
  expect_equal(both.low, {0, -1, 0});
  expect_equal(both.high, {5, 1, 1});
  for (const Bounds& same : {unite(a, Bounds{}), unite(Bounds{}, a)}) {
    expect_equal(same.low, a.low);
    expect_equal(same.high, a.high);
  }
  EXPECT_TRUE(is_empty(unite(Bounds{}, Bounds{})));
}

TEST(Bounds, leaves_out_points_that_are_not_finite) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const Bounds b = bounds_of(Points{{nan, 7, 7}, {1, 2, 3}, {7, inf, 7}, {7, 7, -inf}, {7, 7, nan}});
  expect_equal(b.low, {1, 2, 3});
  expect_equal(b.high, {1, 2, 3});
  EXPECT_TRUE(is_empty(bounds_of(Points{{nan, nan, nan}})));
}

TEST(Bounds, of_the_largest_floats_does_not_overflow) {
  constexpr float most = std::numeric_limits<float>::max();
  const Bounds b = bounds_of(Points{{-most, -most, -most}, {most, most, most}});
  expect_equal(center(b), {0, 0, 0});
  EXPECT_TRUE(std::isfinite(radius(b)));
  EXPECT_GT(radius(b), most);
}

} // namespace
} // namespace surfgrad::mesh
