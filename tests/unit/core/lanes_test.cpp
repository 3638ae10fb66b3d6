/// The core on a pack of lanes: the same bits as one lane at a time, for every function.

#include "simd/emulated_lanes.hpp"
#include "support/core_functions.hpp"
#include <bit>
#include <gtest/gtest.h>

namespace surfgrad::test {
namespace {

using simd::emulated_width;
using simd::EmulatedFloat;

/// One fragment a lane.
CoreInputs<EmulatedFloat> pack(const std::array<CoreInputs<float>, emulated_width>& lanes) {
  std::array<EmulatedFloat, core_input_count<EmulatedFloat>> packed;
  for (int lane = 0; lane < emulated_width; ++lane) {
    const auto one = elements(lanes[lane]);
    for (std::size_t i = 0; i < one.size(); ++i) packed[i].lane[lane] = one[i];
  }
  return from_elements(packed);
}

void expect_equal_lanes(const InputRanges& ranges, std::uint64_t seed, int rounds) {
  for_each_core_function([&](const char* name, int, auto call, auto) {
    Random random(seed);
    for (int round = 0; round < rounds; ++round) {
      std::array<CoreInputs<float>, emulated_width> lanes;
      for (auto& in : lanes) in = random_inputs<float>(random, ranges);
      const auto together = call(pack(lanes));
      for (int lane = 0; lane < emulated_width; ++lane) {
        const auto alone = call(lanes[lane]);
        for (std::size_t k = 0; k < alone.size(); ++k) {
          ASSERT_EQ(std::bit_cast<std::uint32_t>(together[k].lane[lane]),
                    std::bit_cast<std::uint32_t>(alone[k]))
              << name << ", seed " << seed << ", round " << round << ", lane " << lane << ", component " << k
              << ": " << together[k].lane[lane] << " against " << alone[k];
        }
      }
    }
  });
}

TEST(Lanes, PackEqualsFloatBitForBit) { expect_equal_lanes({}, 8, 200); }

TEST(Lanes, PackEqualsFloatOverTheWholeRangeAndZeros) {
  // Here some lanes take every degenerate branch while their neighbours do not.
  expect_equal_lanes({.shortest = 1e-12, .longest = 1e12, .zero_chance = 0.1}, 9, 200);
}

TEST(Lanes, PowersEqualFloatBitForBit) {
  Random random(10);
  for (int round = 0; round < 2000; ++round) {
    EmulatedFloat a;
    EmulatedFloat k;
    for (int lane = 0; lane < emulated_width; ++lane) {
      a.lane[lane] = static_cast<float>(random.sign() * random.magnitude(1e-38, 1e38));
      k.lane[lane] = static_cast<float>(random.uniform(-150, 150));
    }
    const EmulatedFloat logarithm = log2(a);
    const EmulatedFloat power = exp2(k);
    const EmulatedFloat both = pow(a, k);
    for (int lane = 0; lane < emulated_width; ++lane) {
      ASSERT_EQ(logarithm.lane[lane], surfgrad::log2(a.lane[lane]));
      ASSERT_EQ(power.lane[lane], surfgrad::exp2(k.lane[lane]));
      ASSERT_EQ(both.lane[lane], surfgrad::pow(a.lane[lane], k.lane[lane]));
    }
  }
}

} // namespace
} // namespace surfgrad::test
