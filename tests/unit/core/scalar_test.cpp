/// What the concepts promise, for one lane, for a pack and for dual numbers.

#include "simd/emulated_lanes.hpp"
#include "support/dual.hpp"
#include "support/least_scalar.hpp"
#include <gtest/gtest.h>
#include <surfgrad/noise.hpp>
#include <surfgrad/vec.hpp>

namespace surfgrad::test {
namespace {

using simd::EmulatedBits;
using simd::EmulatedFloat;
using simd::EmulatedIndex;
using simd::EmulatedMask;

static_assert(LaneScalar<float> && LaneScalar<double> && LaneScalar<EmulatedFloat> && LaneScalar<LeastFloat>);
static_assert(!std::constructible_from<LeastIndex, std::int32_t> &&
              !std::constructible_from<LeastBits, std::uint32_t>);
static_assert(Scalar<Dual<2>> && !LaneScalar<Dual<2>>, "a dual number serves the listings only");
static_assert(!Scalar<int>);

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

TEST(Scalar, MinAndMaxGiveTheSecondOperandForNan) {
  EXPECT_EQ(surfgrad::min(nan, 2.0f), 2.0f);
  EXPECT_EQ(surfgrad::max(nan, 2.0f), 2.0f);
  EXPECT_TRUE(std::isnan(surfgrad::min(2.0f, nan)));
  EXPECT_TRUE(std::isnan(surfgrad::max(2.0f, nan)));
  const EmulatedFloat m = max(EmulatedFloat(nan), EmulatedFloat(2.0f));
  EXPECT_EQ(m.lane[7], 2.0f);
}

TEST(Scalar, AbsClearsTheSignOfZeroAndKeepsNan) {
  EXPECT_FALSE(std::signbit(surfgrad::abs(-0.0f)));
  EXPECT_EQ(surfgrad::abs(-3.0), 3.0);
  EXPECT_TRUE(std::isnan(surfgrad::abs(nan)));
}

TEST(Scalar, ToIndexTruncatesAndSaturates) {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
  struct Row {
    float value;
    std::int32_t index;
  };
  for (const Row& row :
       {Row{0.0f, 0}, Row{-0.9f, 0}, Row{2.9f, 2}, Row{-2.9f, -2}, Row{2147483648.0f, most}, Row{3e38f, most},
        Row{inf, most}, Row{-2147483648.0f, least}, Row{-3e38f, least}, Row{-inf, least}, Row{nan, 0}}) {
    EXPECT_EQ(to_index(row.value), row.index) << row.value;
    EXPECT_EQ(to_index(static_cast<double>(row.value)), row.index) << row.value;
    EXPECT_EQ(to_index(EmulatedFloat(row.value)).lane[3], row.index) << row.value;
  }
}

TEST(Scalar, GatherReadsNothingInUnsetLanes) {
  const std::uint32_t words[2] = {7, 9};
  EXPECT_EQ(gather(Words{words, 2}, 1, true), 9u);
  EXPECT_EQ(gather(Words{words, 2}, 1 << 30, false), 0u);
  EmulatedIndex index(1);
  EmulatedMask mask(true);
  index.lane[5] = -123456; // outside: must not be read
  mask.lane[5] = false;
  const EmulatedBits got = gather(Words{words, 2}, index, mask);
  EXPECT_EQ(got.lane[4], 9u);
  EXPECT_EQ(got.lane[5], 0u);
}

TEST(Scalar, EmulatedIntegersWrapAndShiftAsRegistersDo) {
  const EmulatedIndex most(std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ((most + EmulatedIndex(1)).lane[0], std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ((EmulatedIndex(-5) >> 1).lane[0], -3);
  EXPECT_EQ((EmulatedBits(0x80000000u) >> 31).lane[0], 1u);
  EXPECT_EQ((EmulatedBits(0x9E3779B9u) * EmulatedBits(0x85EBCA6Bu)).lane[2], 0x9E3779B9u * 0x85EBCA6Bu);
  EXPECT_EQ(EmulatedFloat(EmulatedIndex(-7)).lane[1], -7.0f);
  EXPECT_EQ(EmulatedIndex(EmulatedBits(0xFFFFFFFFu)).lane[1], -1);
}

TEST(Scalar, NoiseOnWhatTheConceptsAskForAloneIsNoiseOnFloats) {
  for (int i = 0; i < 200; ++i) {
    const vec3<float> p{0.37f * static_cast<float>(i) - 40, 1.9f - 0.71f * static_cast<float>(i),
                        0.11f * static_cast<float>(i)};
    const vec3<LeastFloat> q{LeastFloat(p.x), LeastFloat(p.y), LeastFloat(p.z)};
    EXPECT_EQ(perlin(q).value.v, perlin(p).value) << i;
    EXPECT_EQ(simplex(q).gradient.y.v, simplex(p).gradient.y) << i;
  }
}

TEST(Scalar, MasksSelectLaneByLane) {
  EmulatedMask m(false);
  m.lane[2] = true;
  const EmulatedFloat s = select(m, EmulatedFloat(1.0f), EmulatedFloat(2.0f));
  EXPECT_EQ(s.lane[2], 1.0f);
  EXPECT_EQ(s.lane[3], 2.0f);
  EXPECT_TRUE(any(m));
  EXPECT_FALSE(all(m));
  EXPECT_TRUE(all(m | !m));
  EXPECT_FALSE(any(m & !m));
  const vec3<EmulatedFloat> v = select<EmulatedFloat>(m, vec3<EmulatedFloat>{s, s, s}, vec3<EmulatedFloat>{});
  EXPECT_EQ(v.y.lane[2], 1.0f);
  EXPECT_EQ(v.y.lane[3], 0.0f);
}

TEST(Scalar, DualNumbersDifferentiate) {
  const Dual<2> x = Dual<2>::variable(0.7, 0);
  const Dual<2> y = Dual<2>::variable(-1.3, 1);
  const Dual<2> f = sin(x * y) / sqrt(x) - abs(y) * atan2(y, x);
  const auto value = [](double a, double b) {
    return std::sin(a * b) / std::sqrt(a) - std::abs(b) * std::atan2(b, a);
  };
  constexpr double h = 1e-6; // a central difference errs by h^2 and by 1e-16 / h
  EXPECT_NEAR(f.value, value(0.7, -1.3), 1e-15);
  EXPECT_NEAR(f.partial[0], (value(0.7 + h, -1.3) - value(0.7 - h, -1.3)) / (2 * h), 1e-9);
  EXPECT_NEAR(f.partial[1], (value(0.7, -1.3 + h) - value(0.7, -1.3 - h)) / (2 * h), 1e-9);
}

} // namespace
} // namespace surfgrad::test
