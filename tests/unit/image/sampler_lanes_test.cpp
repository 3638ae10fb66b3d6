// A pack of lanes samples as each of its lanes would alone, bit for bit.

#include "image/sampler.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/images.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

namespace surfgrad::image {
namespace {

using simd::emulated_width;
using simd::EmulatedFloat;
using simd::EmulatedMask;

float coordinate(test::Random& random) {
  switch (random.integer(8)) {
  case 0:
    return std::numeric_limits<float>::quiet_NaN();
  case 1:
    return random.sign() < 0 ? -1e30f : std::numeric_limits<float>::infinity();
  case 2:
    return static_cast<float>(random.integer(5) - 2);
  default:
    return static_cast<float>(random.uniform(-3, 3));
  }
}

TEST(SamplerLanes, EqualOneLaneForEveryWrapAndFilter) {
  constexpr std::uint64_t seed = 41;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  long compared = 0;
  for (const int width : {1, 7, 16})
    for (const int height : {1, 4}) {
      const Map map =
          make_slope_map(test::random_normal_map(random, width, height), NormalChannels::xyz, true).map;
      for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
        for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear})
          for (int k = 0; k < 100; ++k) {
            vec2<EmulatedFloat> st{};
            EmulatedFloat lod{};
            EmulatedMask active{};
            for (int i = 0; i < emulated_width; ++i) {
              st.x.lane[i] = coordinate(random);
              st.y.lane[i] = coordinate(random);
              lod.lane[i] = static_cast<float>(random.uniform(-1, 5));
              active.lane[i] = random.integer(4) != 0;
            }
            const auto pack = sample<2, EmulatedFloat>(map, st, lod, {wrap, wrap}, filter, active);
            for (int i = 0; i < emulated_width; ++i) {
              const auto one = sample<2, float>(map, {st.x.lane[i], st.y.lane[i]}, lod.lane[i], {wrap, wrap},
                                                filter, active.lane[i]);
              for (std::size_t c = 0; c < 2; ++c, ++compared) {
                ASSERT_EQ(std::bit_cast<std::uint32_t>(pack[c].lane[i]), std::bit_cast<std::uint32_t>(one[c]))
                    << "lane " << i << " case " << k;
                ASSERT_TRUE(active.lane[i] || one[c] == 0);
              }
            }
          }
    }
  EXPECT_GT(compared, 0);
}

} // namespace
} // namespace surfgrad::image
