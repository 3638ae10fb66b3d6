/// Sine and cosine in turns, against extended precision.

#include "simd/emulated_lanes.hpp"
#include "support/random.hpp"
#include <surfgrad/trigonometry.hpp>

#include <bit>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>

namespace surfgrad::test {
namespace {

template <class T>
class Trigonometry : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Trigonometry, Precisions);

struct Truth {
  long double sin, cos;
};
Truth truth(long double turns) {
  int quarter = 0;                                              // its last bits, of either sign
  const long double rest = std::remquo(turns, 0.25L, &quarter); // exact
  const long double s = std::sin(rest * (2 * std::numbers::pi_v<long double>));
  const long double c = std::cos(rest * (2 * std::numbers::pi_v<long double>));
  switch (quarter & 3) {
  case 1:
    return {c, -s};
  case 2:
    return {-s, -c};
  case 3:
    return {-c, s};
  default:
    return {s, c};
  }
}

/// Error in units of the last place of the true value.
template <class T>
double in_ulp(T got, long double expected) {
  const T rounded = static_cast<T>(std::abs(expected));
  const T next = std::nextafter(rounded, std::numeric_limits<T>::infinity());
  // Where rounding went up to a power of two, the truth has the smaller unit below it.
  const T previous = std::nextafter(rounded, T(0));
  const T unit = static_cast<long double>(rounded) > std::abs(expected) ? rounded - previous : next - rounded;
  return static_cast<double>(std::abs(static_cast<long double>(got) - expected) / unit);
}

TYPED_TEST(Trigonometry, HoldsItsBoundAtEveryMagnitude) {
  using T = TypeParam;
  constexpr int seed = 84;
  Random random(seed);
  double worst = 0;
  T where = 0;
  for (int i = 0; i < 1000000; ++i) {
    T turns{};
    switch (i % 4) {
    case 0: // every power of two up to where only whole turns are left
      turns = static_cast<T>(random.sign() * std::exp2(random.uniform(std::numeric_limits<T>::min_exponent,
                                                                      std::numeric_limits<T>::digits + 2)));
      break;
    case 1: // densely about the first turns
      turns = static_cast<T>(random.uniform(-2, 2));
      break;
    case 2: // on both sides of the octants, where the reduction decides
      turns = static_cast<T>(random.integer(64) - 32) / 8;
      for (int step = random.integer(5); step > 0; --step)
        turns = std::nextafter(turns, static_cast<T>(random.sign() * 1e9));
      break;
    default: // a turn and little more
      turns =
          static_cast<T>(random.integer(1000)) + static_cast<T>(random.sign() * random.magnitude(1e-6, 0.1));
    }
    const Truth expected = truth(turns);
    const SinCos<T> got = sin_cos_turns(turns);
    for (const double error : {in_ulp(got.sin, expected.sin), in_ulp(got.cos, expected.cos)})
      if (!(error <= worst)) {
        worst = error;
        where = turns;
      }
  }
  std::printf("  worst %.3f ulp of the 1.5 documented, at %.17g turns (seed %d)\n", worst, double(where), seed);
  EXPECT_LE(worst, 1.5) << "at " << where;
}

TYPED_TEST(Trigonometry, QuarterTurnsAreWholeNumbers) {
  using T = TypeParam;
  constexpr int whole[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
  for (int i = -4000; i <= 4000; ++i) {
    const SinCos<T> got = sin_cos_turns(static_cast<T>(i) / 4);
    const auto& expected = whole[((i % 4) + 4) % 4];
    ASSERT_EQ(got.sin, static_cast<T>(expected[0])) << i << " quarters";
    ASSERT_EQ(got.cos, static_cast<T>(expected[1])) << i << " quarters";
    ASSERT_FALSE(expected[0] == 0 && std::signbit(got.sin)) << i;
    ASSERT_FALSE(expected[1] == 0 && std::signbit(got.cos)) << i;
  }
}

TYPED_TEST(Trigonometry, IsOddAndEvenAndPeriodicToTheBit) {
  using T = TypeParam;
  Random random(85);
  for (int i = 0; i < 100000; ++i) {
    // Multiples of 2^-16 leave room for whole turns in a float.
    const T turns = static_cast<T>(random.integer(65536)) / 65536;
    const SinCos<T> a = sin_cos_turns(turns);
    const SinCos<T> mirrored = sin_cos_turns(-turns);
    ASSERT_EQ(mirrored.sin, -a.sin);
    ASSERT_EQ(mirrored.cos, a.cos);
    const SinCos<T> later = sin_cos_turns(turns + static_cast<T>(random.integer(100)));
    ASSERT_EQ(later.sin, a.sin) << turns;
    ASSERT_EQ(later.cos, a.cos) << turns;
  }
}

TYPED_TEST(Trigonometry, EdgesAreAsDocumented) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  for (const T turns : {T(0), -T(0), Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(),
                        Limits::max(), -Limits::max(), T(1e20)}) {
    const SinCos<T> got = sin_cos_turns(turns);
    EXPECT_EQ(got.sin, T(0)) << turns;
    EXPECT_FALSE(std::signbit(got.sin)) << turns;
    EXPECT_EQ(got.cos, T(1)) << turns;
  }
  const SinCos<T> tiny = sin_cos_turns(Limits::denorm_min());
  EXPECT_NEAR(tiny.sin / Limits::denorm_min(), 6, 1); // 2 pi of the smallest steps
  EXPECT_EQ(tiny.cos, T(1));
}

TEST(TrigonometryLanes, EqualFloatBitForBit) {
  using simd::emulated_width;
  Random random(86);
  for (int round = 0; round < 20000; ++round) {
    simd::EmulatedFloat turns;
    for (float& lane : turns.lane) lane = static_cast<float>(random.sign() * random.magnitude(1e-38, 1e9));
    turns.lane[round % emulated_width] = std::numeric_limits<float>::quiet_NaN();
    const SinCos<simd::EmulatedFloat> together = sin_cos_turns(turns);
    for (int lane = 0; lane < emulated_width; ++lane) {
      const SinCos<float> alone = sin_cos_turns(turns.lane[lane]);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(together.sin.lane[lane]),
                std::bit_cast<std::uint32_t>(alone.sin));
      ASSERT_EQ(std::bit_cast<std::uint32_t>(together.cos.lane[lane]),
                std::bit_cast<std::uint32_t>(alone.cos));
    }
  }
}

} // namespace
} // namespace surfgrad::test
