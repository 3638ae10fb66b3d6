/// Moments of slopes: averaging them keeps what averaging slopes loses.

#include "support/random.hpp"
#include "support/worst.hpp"
#include <surfgrad/moments.hpp>

#include <vector>

namespace surfgrad::test {
namespace {

using Moments = SlopeMoments<double>;

Moments average(const std::vector<Moments>& all) {
  Moments sum{{0, 0}, {0, 0}, 0};
  const double share = 1.0 / static_cast<double>(all.size());
  for (const Moments& m : all) {
    sum.mean = sum.mean + share * m.mean;
    sum.square = sum.square + share * m.square;
    sum.product += share * m.product;
  }
  return sum;
}

TEST(Moments, OfASlopeAreItsPowers) {
  const Moments m = moments_from_derivative(vec2<double>{-3, 0.5});
  EXPECT_EQ(m.mean.x, -3);
  EXPECT_EQ(m.mean.y, 0.5);
  EXPECT_EQ(m.square.x, 9);
  EXPECT_EQ(m.square.y, 0.25);
  EXPECT_EQ(m.product, -1.5);
}

TEST(Moments, OfOneSlopeLeaveTheRoughnessAlone) {
  Random random(901);
  Worst worst("roughness of one slope, in float");
  for (long k = 0; k < 1000; ++k) {
    const float alpha = static_cast<float>(random.uniform(0.01, 1));
    const vec2<float> d{static_cast<float>(random.uniform(-3, 3)), static_cast<float>(random.uniform(-3, 3))};
    const float got = roughness_from_moments(alpha, moments_from_derivative(d));
    worst.add(got, alpha, 2 * std::numeric_limits<float>::epsilon() * (alpha + dot(d, d) / alpha), k);
  }
}

TEST(Moments, GiveTheVarianceOfFacetsOnBumps) {
  // The definition: slopes of microfacets, alpha^2 / 2 along every direction, on top of those of bumps.
  // Both are finite sets here, so that all sums are exact to rounding.
  Random random(902);
  Worst worst("roughness against the variance of all slopes");
  for (long k = 0; k < 200; ++k) {
    const double alpha = random.uniform(0.05, 0.4);
    const double step = alpha / std::sqrt(2.0); // four facets: variance step^2 along s and along t
    const vec2<double> facets[] = {{step, step}, {-step, step}, {step, -step}, {-step, -step}};
    std::vector<Moments> bumps, all;
    const double steep = random.uniform(0, 0.5);
    const vec2<double> lean = random.vector2(-2, 2);
    for (int i = 0; i < 16; ++i) {
      const vec2<double> d = lean + steep * random.vector2(-1, 1);
      bumps.push_back(moments_from_derivative(d));
      for (const vec2<double> facet : facets) all.push_back(moments_from_derivative(d + facet));
    }
    const Moments m = average(all);
    const double variances = m.square.x - m.mean.x * m.mean.x + m.square.y - m.mean.y * m.mean.y;
    // alpha^2 / 2 is the mean of the variances along s and t; 64 terms of up to 10 are summed.
    worst.add(roughness_from_moments(alpha, average(bumps)), std::min(1.0, std::sqrt(variances)), 1e-12, k);
  }
}

TEST(Moments, GiveARoughnessWithinReasonForWhatNoSlopesHave) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  const vec2<double> zero{0, 0};
  EXPECT_EQ(roughness_from_moments(0.25, Moments{{1, 2}, {0.5, 3.9}, 0}), 0.25); // negative variances
  EXPECT_EQ(roughness_from_moments(0.25, Moments{{nan, nan}, {nan, nan}, nan}), 0.25);
  EXPECT_EQ(roughness_from_moments(0.25, Moments{zero, {inf, 0}, 0}), 1);
  EXPECT_EQ(roughness_from_moments(0.0, Moments{zero, zero, 0}), 0);
  EXPECT_EQ(roughness_from_moments(0.5, Moments{zero, {50, 50}, 0}), 1);
}

} // namespace
} // namespace surfgrad::test
