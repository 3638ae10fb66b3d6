// The sampler against its definition: weighted texels, indices folded back by the wrap.

#include "filter_definition.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::image {
namespace {

using test::bilinear_by_definition;
using test::coordinate;
using test::folded;
using test::sizes;
using test::trilinear_by_definition;
using test::wraps;

TEST(Sampler, BilinearIsTheDefinitionForEveryWrapAtEveryCoordinate) {
  constexpr std::uint64_t seed = 31;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("bilinear in double");
  for (const auto& [width, height] : sizes) {
    for (const Map& map : test::maps_of_all_formats(random, width, height))
      for (const Wrap s : wraps)
        for (const Wrap t : wraps)
          for (int k = 0; k < 200; ++k) {
            const vec2<double> st{coordinate(random, width), coordinate(random, height)};
            const auto got = test::sampled<double>(map, st, 0.0, {s, t}, Filter::bilinear, true);
            // The fraction of a coordinate of size 1000 in texels loses 1000 * 16 eps.
            for (int c = 0; c < map.components; ++c)
              worst.add(got[static_cast<std::size_t>(c)], bilinear_by_definition(map, 0, st, {s, t}, c),
                        1e-11, k);
          }
  }
}

TEST(Sampler, FloatAgreesWithDouble) {
  constexpr std::uint64_t seed = 32;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("float against double");
  for (const auto& [width, height] : sizes) {
    for (const Map& map : test::maps_of_all_formats(random, width, height))
      for (const Wrap wrap : wraps)
        for (int k = 0; k < 200; ++k) {
          const vec2<float> st{static_cast<float>(random.uniform(-4, 4)),
                               static_cast<float>(random.uniform(-4, 4))};
          const float lod = static_cast<float>(random.uniform(-1, 5));
          const auto narrow = test::sampled<float>(map, st, lod, {wrap, wrap}, Filter::trilinear, true);
          const auto wide =
              test::sampled<double>(map, {st.x, st.y}, double{lod}, {wrap, wrap}, Filter::trilinear, true);
          // Wrapping is exact here; s * n rounds to eps / 2 * 16 texels, neighbours differ by up to 2,
          // two axes; the blends add a few eps. Slopes differ by twice as much.
          const double most = map.components == 2 ? 80 : 40;
          for (std::size_t c = 0; c < narrow.size(); ++c)
            worst.add(narrow[c], wide[c], most * std::numeric_limits<float>::epsilon(), k);
        }
  }
}

TEST(Sampler, ReturnsTexelsAtTheirCentresExactly) {
  test::Random random(33);
  const Map map = make_direction_map(test::random_image(random, 16, 8, 3), true);
  for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear})
    for (const Wrap wrap : wraps)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
          const vec2<float> st{(static_cast<float>(x) + 0.5f) / 16, (static_cast<float>(y) + 0.5f) / 8};
          const auto got = sample<3, float>(map, st, 0.0f, {wrap, wrap}, filter, true);
          for (int c = 0; c < 3; ++c)
            EXPECT_EQ(got[static_cast<std::size_t>(c)], test::texel(map, 0, x, y, c));
        }
}

TEST(Sampler, IsLinearOnARamp) {
  Image ramp = make_image(16, 1, 1, Depth::float32);
  for (int x = 0; x < 16; ++x) ramp.at(x, 0, 0) = static_cast<float>(x) / 16;
  const Map map = make_channel_map(ramp, 0);
  test::Worst worst("linear ramp");
  for (int k = 0; k <= 1000; ++k) {
    const double s = 0.5 / 16 + k * (15.0 / 16000);
    const double got = sample<1, double>(map, {s, 0.5}, 0.0, {}, Filter::bilinear, true)[0];
    worst.add(got, s - 0.5 / 16, 8 * std::numeric_limits<double>::epsilon(), k); // a few roundings below 1
  }
}

TEST(Sampler, NearestShowsTheTexelThatHoldsThePoint) {
  constexpr std::uint64_t seed = 34;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (const auto& [width, height] : sizes) {
    const Map map = make_channel_map(test::random_image(random, width, height, 1), 0);
    for (const Wrap wrap : wraps)
      for (int k = 0; k < 300; ++k) {
        const vec2<double> st{random.uniform(-3, 3), random.uniform(-3, 3)};
        const double got = sample<1, double>(map, st, 0.0, {wrap, wrap}, Filter::nearest, true)[0];
        const int x = folded(static_cast<long long>(std::floor(st.x * width)), width, wrap);
        const int y = folded(static_cast<long long>(std::floor(st.y * height)), height, wrap);
        ASSERT_EQ(got, test::texel_value(map, 0, x, y)) << "case " << k << " at " << st.x << ", " << st.y;
      }
  }
}

TEST(Sampler, TrilinearBlendsTheTwoLevelsAroundTheLod) {
  constexpr std::uint64_t seed = 35;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("trilinear");
  for (const auto& [width, height] : sizes)
    for (const Map& map : test::maps_of_all_formats(random, 3 * width, 2 * height))
      for (const Wrap wrap : wraps)
        for (int k = 0; k < 200; ++k) {
          const vec2<double> st = random.vector2(-2, 2);
          double lod = random.uniform(-2, 8);
          if (k % 3 == 0) lod = random.integer(9) - 1;
          if (k % 3 == 1) lod = random.integer(9) - 0.5;
          const auto got = test::sampled<double>(map, st, lod, {wrap, wrap}, Filter::trilinear, true);
          for (int c = 0; c < map.components; ++c) // rounding of 64 texels at most
            worst.add(got[static_cast<std::size_t>(c)],
                      trilinear_by_definition(map, lod, st, {wrap, wrap}, c), 1e-13, k);
        }
}

TEST(Sampler, StaysWithinTheTexelsForCoordinatesThatAreNoNumbers) {
  test::Random random(36);
  Image floats = test::random_image(random, 7, 5, 1, Depth::float32);
  const Map maps[] = {make_channel_map(test::random_image(random, 7, 5, 1), 0), make_channel_map(floats, 0),
                      make_channel_map(test::random_image(random, 1, 1, 1), 0)};
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double odd[] = {nan, inf, -inf, 1e300, -1e300, 1e17, -1e-300, 2147483647.0, -2147483648.0};
  for (const double s : odd)
    for (const double t : odd)
      for (const double lod : odd)
        for (const Wrap wrap : wraps)
          for (const Filter filter : {Filter::nearest, Filter::bilinear, Filter::trilinear})
            for (const Map& map : maps) {
              const double got = sample<1, double>(map, {s, t}, lod, {wrap, wrap}, filter, true)[0];
              EXPECT_TRUE(got >= 0 && got <= 1) << s << " " << t << " " << lod << " gives " << got;
              const float narrow = sample<1, float>(map, {static_cast<float>(s), static_cast<float>(t)},
                                                    static_cast<float>(lod), {wrap, wrap}, filter, true)[0];
              EXPECT_TRUE(narrow >= 0 && narrow <= 1) << s << " " << t << " " << lod << " gives " << narrow;
            }
}

} // namespace
} // namespace surfgrad::image
