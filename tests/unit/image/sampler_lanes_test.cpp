// A pack of lanes samples as each of its lanes would alone, bit for bit.

#include "filter_definition.hpp"
#include "simd/emulated_lanes.hpp"

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

/// Lanes as neighbouring pixels have them, of one mip level, or of any.
EmulatedFloat levels(test::Random& random, bool alike) {
  EmulatedFloat lod{};
  const double level = random.integer(3);
  for (float& lane : lod.lane)
    lane = static_cast<float>(alike ? level + random.uniform(0, 0.99) : random.uniform(-1, 5));
  // A LOD that is a level has no second one, whatever its neighbours have.
  if (random.integer(2) == 0) lod.lane[3] = alike ? static_cast<float>(level) : 1.0f;
  return lod;
}

TEST(SamplerLanes, EqualOneLaneForEveryFormatWrapAndFilter) {
  constexpr std::uint64_t seed = 41;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  long compared = 0;
  for (const int width : {1, 7, 16})
    for (const int height : {1, 4})
      for (const Map& map : test::maps_of_all_formats(random, width, height))
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
          for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear})
            for (int k = 0; k < 60; ++k) {
              vec2<EmulatedFloat> st{};
              EmulatedMask active{};
              for (int i = 0; i < emulated_width; ++i) {
                st.x.lane[i] = coordinate(random);
                st.y.lane[i] = coordinate(random);
                active.lane[i] = random.integer(4) != 0;
              }
              const EmulatedFloat lod = levels(random, k % 2 == 0);
              const auto pack = test::sampled<EmulatedFloat>(map, st, lod, {wrap, wrap}, filter, active);
              for (int i = 0; i < emulated_width; ++i) {
                const auto one = test::sampled<float>(map, {st.x.lane[i], st.y.lane[i]}, lod.lane[i],
                                                      {wrap, wrap}, filter, active.lane[i]);
                for (std::size_t c = 0; c < one.size(); ++c, ++compared) {
                  ASSERT_EQ(std::bit_cast<std::uint32_t>(pack[c].lane[i]),
                            std::bit_cast<std::uint32_t>(one[c]))
                      << "lane " << i << " case " << k;
                  ASSERT_TRUE(active.lane[i] || one[c] == 0);
                }
              }
            }
  EXPECT_GT(compared, 0);
}

TEST(SamplerLanes, KeepTheSignOfAZeroWhateverOthersBlend) {
  // A lane between no levels must not meet another lane's arithmetic: -0 + 0 is 0.
  std::vector<float> slopes(2 * 16, -1.0f);
  slopes[0] = slopes[1] = -0.0f;
  const Map map = with_pyramid(rows_of(slopes, 4, 2), 4, 4, 2);
  EmulatedFloat lod(0.5f);
  lod.lane[2] = 0;
  const vec2<EmulatedFloat> st{EmulatedFloat(0.125f), EmulatedFloat(0.125f)};
  const auto pack = sample<2, EmulatedFloat>(map, st, lod, {}, Filter::trilinear, EmulatedMask(true));
  const auto one = sample<2, float>(map, {0.125f, 0.125f}, 0.0f, {}, Filter::trilinear, true);
  EXPECT_TRUE(std::signbit(one[0]));
  EXPECT_TRUE(std::signbit(pack[0].lane[2]));
}

/// A map of two levels, the second behind so many words that their number is no float: as a mask of 4096x4096
/// texels has them.
Map map_beyond_the_whole_numbers_of_float() {
  constexpr std::uint32_t first = (1u << 24) + 3;
  Map map;
  map.components = 1;
  map.level_count = 2;
  map.level_table = {2, 1, 0, 4, 3, first};
  map.words.resize(first + 5 * 4, 0);
  for (std::uint32_t i = 0; i < 5 * 4; ++i) // rows and the column of copies: each texel its own value
    map.words[first + i] = std::bit_cast<std::uint32_t>(static_cast<float>(i + 1));
  return map;
}

TEST(SamplerLanes, ReadTheTexelsOfLargeMaps) {
  const Map map = map_beyond_the_whole_numbers_of_float();
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) {
      const float s = (static_cast<float>(x) + 0.5f) / 4;
      const float t = (static_cast<float>(y) + 0.5f) / 3;
      const float expected = static_cast<float>(5 * y + x + 1);
      // To float rounding: centres of thirds are no floats.
      EXPECT_NEAR((sample<1, float>(map, {s, t}, 1.0f, {}, Filter::trilinear, true)[0]), expected, 1e-5);
      EXPECT_NEAR((sample<1, double>(map, {s, t}, 1.0, {}, Filter::trilinear, true)[0]), expected, 1e-5);
      EmulatedFloat lod(1.0f);
      for (const float other : {1.0f, 0.0f}) { // all lanes of one level, and not
        lod.lane[2] = other;
        const auto pack = sample<1, EmulatedFloat>(map, {EmulatedFloat(s), EmulatedFloat(t)}, lod, {},
                                                   Filter::trilinear, EmulatedMask(true));
        EXPECT_NEAR(pack[0].lane[5], expected, 1e-5);
      }
    }
}

TEST(SamplerLanes, TellWhetherAllThatAreActiveAgree) {
  simd::EmulatedIndex index(7);
  EmulatedMask active(true);
  std::int32_t value = -1;
  EXPECT_TRUE(same_in_all(index, active, value));
  EXPECT_EQ(value, 7);
  index.lane[5] = 6;
  EXPECT_FALSE(same_in_all(index, active, value));
  active.lane[5] = false;
  EXPECT_TRUE(same_in_all(index, active, value));
  EXPECT_EQ(value, 7);
  EXPECT_TRUE(same_in_all(index, EmulatedMask(false), value));
  EXPECT_EQ(value, 0);
}

} // namespace
} // namespace surfgrad::image
