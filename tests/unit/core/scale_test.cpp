/// Nothing depends on the size of the scene, and nothing finite gives NaN or Inf.

#include "support/core_functions.hpp"
#include "support/worst.hpp"

namespace surfgrad::test {
namespace {

/// The same scene, every length multiplied: positions, heights and their derivatives.
template <class T>
CoreInputs<T> scaled(CoreInputs<T> in, T s) {
  in.dp_du = s * in.dp_du;
  in.dp_dv = s * in.dp_dv;
  in.position = s * in.position;
  in.dh_duv = s * in.dh_duv;
  in.height = s * in.height;
  in.height_x = s * in.height_x;
  in.height_y = s * in.height_y;
  in.bump_scale = s * in.bump_scale;
  for (vec4<T>* row : {&in.world_from_screen.x, &in.world_from_screen.y, &in.world_from_screen.z})
    *row = s * *row; // the homogeneous point's w stays
  in.frame.dp_dx = s * in.frame.dp_dx;
  in.frame.dp_dy = s * in.frame.dp_dy;
  in.frame.sigma_x = s * in.frame.sigma_x;
  in.frame.sigma_y = s * in.frame.sigma_y;
  return in;
}

TEST(Scale, PowersOfTwoChangeNoBit) {
  // 2^20 is about 1e6. Scaling by a power of two is exact, so equality is the strictest test: a clamp
  // that depended on the scene's size would show at once. Degenerate input is included.
  for (const InputRanges& ranges : {InputRanges{}, InputRanges{.zero_chance = 0.1}}) {
    for_each_core_function([&](const char* name, int power, auto call, auto) {
      Random random(20);
      for (int i = 0; i < 3000; ++i) {
        const CoreInputs<float> in = random_inputs<float>(random, ranges);
        const auto base = call(in);
        for (const float s : {0x1p-20f, 0x1p20f}) {
          const auto result = call(scaled(in, s));
          const float factor = power == 0 ? 1.0f : power > 0 ? s : 1 / s;
          for (std::size_t k = 0; k < base.size(); ++k)
            ASSERT_EQ(result[k], factor * base[k])
                << name << ", case " << i << ", scale " << s << ", component " << k;
        }
      }
    });
  }
}

TEST(Scale, AMillionthAndAMillionKeepTheErrorBound) {
  for_each_core_function([](const char* name, int power, auto call, auto bound) {
    Random random(21);
    Worst worst(std::string(name) + ", scene times 1e-6 and 1e6");
    for (long i = 0; i < 3000; ++i) {
      const CoreInputs<float> in = random_inputs<float>(random);
      for (const float s : {1e-6f, 1e6f}) {
        const CoreInputs<float> other = scaled(in, s);
        const CoreInputs<double> exact = convert<double>(other);
        const auto got = call(other);
        const auto expected = call(exact);
        const auto bounds = bound(exact);
        double size = 0;
        for (const double e : expected) size = std::max(size, std::abs(e));
        for (std::size_t k = 0; k < got.size(); ++k) {
          if (bounds[k] * epsilon_v < float >> 0.01 * size) continue; // degenerate: see precision_test
          worst.add(static_cast<double>(got[k]), expected[k], 1.001 * epsilon_v<float> * bounds[k], i);
        }
      }
    }
    static_cast<void>(power);
  });
}

template <class T>
class Finite : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Finite, Precisions);

TYPED_TEST(Finite, ZerosAndMagnitudesFrom1em12To1e12GiveNoNanNorInf) {
  using T = TypeParam;
  for (const double zero_chance : {0.0, 0.05, 0.5}) {
    const InputRanges ranges{.shortest = 1e-12, .longest = 1e12, .zero_chance = zero_chance};
    for_each_core_function([&](const char* name, int, auto call, auto) {
      Random random(22);
      int failures = 0;
      for (int i = 0; i < 6000; ++i) {
        const CoreInputs<T> in = random_inputs<T>(random, ranges);
        const auto result = call(in);
        for (std::size_t k = 0; k < result.size(); ++k) failures += !std::isfinite(result[k]);
      }
      EXPECT_EQ(failures, 0) << name << ", share of zeros " << zero_chance;
    });
  }
}

} // namespace
} // namespace surfgrad::test
