/// log2, exp2 and pow against extended precision, in units of their documented bounds.

#include "support/random.hpp"
#include "support/worst.hpp"
#include <surfgrad/power.hpp>

namespace surfgrad::test {
namespace {

template <class T>
class Power : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Power, Precisions);

/// Error of a result in units of the precision's eps times `scale`.
template <class T>
double in_eps(T got, long double truth, long double scale) {
  return static_cast<double>(std::abs(static_cast<long double>(got) - truth) /
                             (scale * static_cast<long double>(std::numeric_limits<T>::epsilon())));
}

TYPED_TEST(Power, Log2HoldsItsBound) {
  using T = TypeParam;
  Random random(81);
  double worst = 0;
  for (int i = 0; i < 400000; ++i) {
    // The whole range, and densely about 1, where the logarithm vanishes.
    const T a =
        static_cast<T>(i % 2 == 0 ? std::exp2(random.uniform(std::numeric_limits<T>::min_exponent,
                                                             std::numeric_limits<T>::max_exponent - 1))
                                  : random.uniform(0.5, 2.0));
    const long double truth = std::log2(static_cast<long double>(a));
    worst = std::max(worst, in_eps(surfgrad::log2(a), truth, std::max(1.0L, std::abs(truth))));
  }
  std::printf("  log2: worst %.2f eps of the 2 documented\n", worst);
  EXPECT_LE(worst, 2);
}

TYPED_TEST(Power, Log2IsExactForPowersOfTwo) {
  using T = TypeParam;
  for (int n = std::numeric_limits<T>::min_exponent - 1; n < std::numeric_limits<T>::max_exponent; ++n)
    EXPECT_EQ(surfgrad::log2(std::ldexp(T(1), n)), T(n));
}

TYPED_TEST(Power, Exp2HoldsItsBound) {
  using T = TypeParam;
  Random random(82);
  double worst = 0;
  for (int i = 0; i < 400000; ++i) {
    const T a = static_cast<T>(i % 2 == 0 ? random.uniform(std::numeric_limits<T>::min_exponent - 1,
                                                           std::numeric_limits<T>::max_exponent)
                                          : random.uniform(-1.5, 1.5));
    const long double truth = std::exp2(static_cast<long double>(a));
    if (truth < static_cast<long double>(std::numeric_limits<T>::min())) continue;
    worst = std::max(worst, in_eps(surfgrad::exp2(a), truth, truth));
  }
  std::printf("  exp2: worst %.2f eps of the 4 documented\n", worst);
  EXPECT_LE(worst, 4);
}

TYPED_TEST(Power, PowHoldsItsBound) {
  using T = TypeParam;
  Random random(83);
  double worst = 0;
  for (int i = 0; i < 400000; ++i) {
    const T a = static_cast<T>(i % 2 == 0 ? random.uniform(0.0, 1.0) : random.magnitude(1e-6, 1e6));
    const T k = static_cast<T>(random.uniform(0.1, 100));
    const long double exponent = static_cast<long double>(k) * std::log2(static_cast<long double>(a));
    if (std::abs(exponent) > std::numeric_limits<T>::max_exponent - 3) continue; // saturates
    const long double truth = std::pow(static_cast<long double>(a), static_cast<long double>(k));
    worst = std::max(worst, in_eps(surfgrad::pow(a, k), truth, truth * (4 + 2 * std::abs(exponent))));
  }
  std::printf("  pow: worst %.2f of the documented bound\n", worst);
  EXPECT_LE(worst, 1);
}

TYPED_TEST(Power, EdgesAreAsDocumented) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  const T lowest = T(Limits::min_exponent - 1);
  for (const T a :
       {T(0), -T(0), T(-1), Limits::denorm_min(), Limits::min(), -Limits::infinity(), Limits::quiet_NaN()})
    EXPECT_EQ(surfgrad::log2(a), lowest);
  EXPECT_EQ(surfgrad::log2(Limits::infinity()), surfgrad::log2(Limits::max()));
  EXPECT_NEAR(surfgrad::log2(Limits::max()), T(Limits::max_exponent), T(1e-4));
  EXPECT_EQ(surfgrad::exp2(lowest), T(0));
  EXPECT_EQ(surfgrad::exp2(-Limits::infinity()), T(0));
  EXPECT_EQ(surfgrad::exp2(Limits::quiet_NaN()), T(0));
  EXPECT_EQ(surfgrad::exp2(T(Limits::max_exponent)), Limits::max());
  EXPECT_EQ(surfgrad::exp2(Limits::infinity()), Limits::max());
  EXPECT_EQ(surfgrad::exp2(T(0)), T(1));
  EXPECT_EQ(surfgrad::exp2(T(10)), T(1024));
  for (const T a : {T(0), -T(0), T(-2), Limits::quiet_NaN()}) EXPECT_EQ(surfgrad::pow(a, T(3)), T(0));
  EXPECT_EQ(surfgrad::pow(T(1), T(77)), T(1));
}

} // namespace
} // namespace surfgrad::test
