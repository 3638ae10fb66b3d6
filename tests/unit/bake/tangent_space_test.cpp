// Normals in vertex frames: the inverse of the standard decode, and where it has none.

#include "bake/tangent_space.hpp"

#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;
using surfgrad::test::Worst;

/// The decode of every engine.
vec3<double> decoded(vec3<double> n, vec3<double> t, double sign, vec3<double> m) {
  return normalize_or_zero(m.x * t + m.y * (sign * cross(n, t)) + m.z * n);
}

TEST(TangentSpace, DecodesBackToTheDirectionInAnyFrame) {
  constexpr std::uint64_t seed = 181;
  SCOPED_TRACE(seed);
  Random random(seed);
  Worst worst("decode of the solved normal");
  for (long k = 0; k < 5000; ++k) {
    const vec3<double> n = random.magnitude(1e-3, 1e3) * random.unit_vector();
    const vec3<double> t = random.magnitude(1e-3, 1e3) * random.unit_vector();
    const double sign = random.sign();
    if (length(cross(n, t)) < 0.1 * length(n) * length(t)) continue;
    // Any normal within the slope limit of the frame.
    const double slope = random.magnitude(1e-3, 100);
    const vec3<double> m{slope * random.uniform(), slope * random.uniform(), 1};
    const vec3<double> direction = random.magnitude(1e-2, 1e2) * decoded(n, t, sign, m);
    const TangentNormal<double> got = in_vertex_frame(n, t, sign, direction);
    ASSERT_FALSE(got.singular || got.clamped) << k;
    EXPECT_NEAR(length(got.normal), 1, 1e-14);
    worst.add(decoded(n, t, sign, got.normal), normalize_or_zero(direction), 1e-12,
              k); // a condition of up to 1e3
    // The triangle's area scales the entries against each other: compare as directions.
    worst.add(got.normal, normalize_or_zero(m), 1e-9, k);
  }
}

TEST(TangentSpace, IsSingularWhereTheVectorsVanishOrAlign) {
  const vec3<double> n{0, 0, 1};
  const auto singular = [&](vec3<double> normal, vec3<double> tangent) {
    const TangentNormal<double> r = in_vertex_frame<double>(normal, tangent, 1, {0.3, 0.2, 0.9});
    EXPECT_EQ(max_abs(r.normal - (r.singular ? n : r.normal)), 0);
    return r.singular;
  };
  EXPECT_TRUE(singular({0, 0, 0}, {1, 0, 0}));
  EXPECT_TRUE(singular(n, {0, 0, 0}));
  EXPECT_TRUE(singular(n, {0, 0, -3}));
  EXPECT_TRUE(singular(n, {0.99e-3, 0, 1}));
  EXPECT_FALSE(singular(n, {1.01e-3, 0, 1}));
  EXPECT_TRUE(singular(1e-8 * n, {1e-14, 0, 1e-11}));
  EXPECT_FALSE(singular(1e-8 * n, {2e-14, 0, 1e-11})); // the limit is relative
  EXPECT_TRUE(singular({NAN, 0, 1}, {1, 0, 0}));
}

TEST(TangentSpace, ClampsWhatLiesBelowTheSurfaceToTheSteepestSlopeInItsDirection) {
  const vec3<double> n{0, 0, 1};
  const vec3<double> t{1, 0, 0};
  const auto solved = [&](vec3<double> direction) { return in_vertex_frame(n, t, 1.0, direction); };
  for (const vec3<double>& d : {vec3<double>{0.6, -0.3, -0.4}, {0.6, -0.3, 0}, {0.6, -0.3, 0.001}}) {
    const TangentNormal<double> r = solved(d);
    EXPECT_TRUE(r.clamped);
    EXPECT_FALSE(r.singular);
    EXPECT_LT(max_abs(r.normal - normalize_or_zero(vec3<double>{0.6, -0.3, 0.6 / 128})), 1e-15);
  }
  const TangentNormal<double> inward = solved({0, 0, -1}); // no direction to prefer
  EXPECT_TRUE(inward.clamped);
  EXPECT_EQ(inward.normal.z, 1);
  for (const vec3<double>& none : {vec3<double>{0, 0, 0}, {NAN, NAN, NAN}}) {
    EXPECT_TRUE(solved(none).clamped);
    EXPECT_EQ(max_abs(solved(none).normal - n), 0);
  }
  EXPECT_FALSE(solved({127.9, -127.9, 1}).clamped);
  EXPECT_TRUE(solved({128.1, 0, 1}).clamped);
}

} // namespace
} // namespace surfgrad::bake
