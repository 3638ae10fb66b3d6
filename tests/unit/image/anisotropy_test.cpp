// Anisotropic filtering against its definition, and against what it is for.

#include "filter_definition.hpp"
#include "image/anisotropy.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace surfgrad::image {
namespace {

using test::coordinate;
using test::trilinear_by_definition;

struct Steps {
  vec2<double> dx, dy;
};

/// Steps of all kinds: along the axes, slanted, sheared, collapsed, magnifying.
Steps random_steps(test::Random& random) {
  const double length = random.magnitude(1e-3, 2);
  const double width = length * random.magnitude(1e-3, 1);
  const double turn = random.uniform(0, 6.3);
  const vec2<double> along{std::cos(turn), std::sin(turn)};
  Steps steps{length * along,
              width * vec2<double>{-along.y, along.x} + random.uniform(-1, 1) * length * along};
  if (random.integer(8) == 0) steps.dy = {0, 0};
  if (random.integer(8) == 0) steps.dy = 0.5 * steps.dx;
  if (random.integer(2) == 0) std::swap(steps.dx, steps.dy);
  return steps;
}

std::vector<double> by_definition(const Map& map, vec2<double> st, const Steps& steps, int most, Wraps wrap) {
  const vec2<double> size{static_cast<double>(map.width()), static_cast<double>(map.height())};
  const vec2<double> a = size * steps.dx, b = size * steps.dy;
  const bool b_longer = std::hypot(a.x, a.y) < std::hypot(b.x, b.y);
  const double length = std::max(std::hypot(a.x, a.y), std::hypot(b.x, b.y));
  const double width = std::abs(a.x * b.y - a.y * b.x) / length;
  const double probe = std::max({width, length / most, std::min(length, 1.0)});
  const int probes = std::max(1, static_cast<int>(std::ceil(length / probe - 1.0 / 64)));
  std::vector<double> sum(static_cast<std::size_t>(map.components));
  for (int k = 0; k < probes; ++k) {
    const vec2<double> at = st + ((k + 0.5) / probes - 0.5) * (b_longer ? steps.dy : steps.dx);
    for (int c = 0; c < map.components; ++c)
      sum[static_cast<std::size_t>(c)] +=
          trilinear_by_definition(map, std::log2(probe), at, wrap, c) / probes;
  }
  return sum;
}

template <class T>
std::vector<T> sampled(const Map& map, vec2<T> st, const Footprint<T>& footprint, Wraps wrap,
                       mask_t<T> active) {
  const auto all = [](const auto& c) { return std::vector<T>(c.begin(), c.end()); };
  if (map.components == 1) return all(sample<1, T>(map, st, footprint, wrap, active));
  if (map.components == 2) return all(sample<2, T>(map, st, footprint, wrap, active));
  return all(sample<3, T>(map, st, footprint, wrap, active));
}

template <class T>
vec2<T> size_of(const Map& map) {
  return {T(static_cast<value_t<T>>(map.width())), T(static_cast<value_t<T>>(map.height()))};
}

TEST(Anisotropy, IsTheAverageOfProbesAlongTheLongerStep) {
  constexpr std::uint64_t seed = 91;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("anisotropic in double");
  int many = 0;
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 64}, {32, 128}})
    for (const Map& map : test::maps_of_all_formats(random, width, height))
      for (const Wrap wrap : test::wraps)
        for (int k = 0; k < 200; ++k) {
          const Steps steps = random_steps(random);
          const vec2<double> st = random.vector2(-2, 2);
          const int most = 1 + random.integer(16);
          const auto footprint = footprint_of(steps.dx, steps.dy, size_of<double>(map), most);
          EXPECT_LE(footprint.probes, most);
          many += footprint.probes > 4;
          const auto got = sampled<double>(map, st, footprint, {wrap, wrap}, true);
          const auto expected = by_definition(map, st, steps, most, {wrap, wrap});
          // The LOD is right to some 10 eps, texels differ by up to 4, positions err by 128 * 4 eps texels;
          // the ratio of near-parallel steps loses up to 1e3 eps to cancellation.
          for (std::size_t c = 0; c < got.size(); ++c) worst.add(got[c], expected[c], 1e-11, k);
        }
  EXPECT_GT(many, 500);
}

TEST(Anisotropy, OfOneProbeIsTrilinear) {
  constexpr std::uint64_t seed = 92;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const Map map = test::maps_of_all_formats(random, 32, 16)[0];
  for (int k = 0; k < 500; ++k) {
    const Steps steps = random_steps(random);
    const vec2<double> st = random.vector2(-2, 2);
    const auto got = sampled<double>(map, st, footprint_of(steps.dx, steps.dy, {32.0, 16.0}, 1), {}, true);
    const double lod = texture_lod(steps.dx, steps.dy, vec2<double>{32, 16});
    EXPECT_EQ(got, test::sampled<double>(map, st, lod, {}, Filter::trilinear, true));
  }
}

TEST(Anisotropy, KeepsLinesThatALongFootprintRunsAlong) {
  // Lines of one texel along s, seen under a footprint 8 texels long and 1 wide.
  Image lines = make_image(64, 64, 1, Depth::unorm8);
  for (int y = 0; y < 64; y += 2)
    for (int x = 0; x < 64; ++x) lines.at(x, y, 0) = 1;
  const Map map = make_channel_map(lines, 0);
  const vec2<double> along{8.0 / 64, 0}, across{0, 1.0 / 64}, st{0.3, 20.5 / 64};
  const auto seen = [&](int most) {
    return sampled<double>(map, st, footprint_of(along, across, {64.0, 64.0}, most), {}, true)[0];
  };
  EXPECT_NEAR(seen(1), 0.5, 1e-5); // level 3 is grey, to half a code of 16 bits
  EXPECT_NEAR(seen(8), 1, 1e-12);  // in the middle of a line: level 0
  EXPECT_EQ(footprint_of(along, across, vec2<double>{64, 64}, 16).probes, 8);
  // Across the lines all probes together see grey.
  EXPECT_NEAR(sampled<double>(map, {0.3, 0.4},
                              footprint_of(across, vec2<double>{0, 8.0 / 64}, {64.0, 64.0}, 16), {}, true)[0],
              0.5, 1e-5);
}

TEST(Anisotropy, StaysWithinTheTexelsForFootprintsThatAreNoNumbers) {
  test::Random random(93);
  const Map map = make_channel_map(test::random_image(random, 7, 5, 1), 0);
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float odd[] = {nan, inf, -inf, 3e38f, 1e-45f, 0.0f, -0.5f};
  for (const float a : odd)
    for (const float b : odd)
      for (const float c : odd)
        for (const float d : odd)
          for (const vec2<float> st : {vec2<float>{0.3f, 0.6f}, {nan, inf}}) {
            const auto footprint = footprint_of<float>({a, b}, {c, d}, {7, 5}, 16);
            EXPECT_TRUE(footprint.probes >= 1 && footprint.probes <= 16);
            const float got = sampled<float>(map, st, footprint, {}, true)[0];
            EXPECT_TRUE(got >= 0 && got <= 1.000001f) << a << " " << b << " " << c << " " << d << ": " << got;
          }
}

TEST(Anisotropy, EqualsOneLaneInEveryLane) {
  using simd::EmulatedFloat;
  constexpr std::uint64_t seed = 94;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (const Map& map : test::maps_of_all_formats(random, 32, 16))
    for (int k = 0; k < 200; ++k) {
      vec2<EmulatedFloat> st{}, dx{}, dy{};
      simd::EmulatedMask active{};
      for (int i = 0; i < simd::emulated_width; ++i) {
        const Steps steps = random_steps(random);
        const auto set = [&](vec2<EmulatedFloat>& v, vec2<double> of) {
          v.x.lane[i] = static_cast<float>(of.x);
          v.y.lane[i] = static_cast<float>(of.y);
        };
        set(st, random.vector2(-2, 2));
        set(dx, steps.dx);
        set(dy, steps.dy);
        active.lane[i] = random.integer(4) != 0;
      }
      const auto pack =
          sampled<EmulatedFloat>(map, st, footprint_of(dx, dy, size_of<EmulatedFloat>(map), 8), {}, active);
      for (int i = 0; i < simd::emulated_width; ++i) {
        const auto lane_of = [&](const vec2<EmulatedFloat>& v) {
          return vec2<float>{v.x.lane[i], v.y.lane[i]};
        };
        const auto footprint = footprint_of(lane_of(dx), lane_of(dy), size_of<float>(map), 8);
        const auto one = sampled<float>(map, lane_of(st), footprint, {}, active.lane[i]);
        for (std::size_t c = 0; c < one.size(); ++c)
          ASSERT_EQ(std::bit_cast<std::uint32_t>(pack[c].lane[i]), std::bit_cast<std::uint32_t>(one[c]));
      }
    }
}

} // namespace
} // namespace surfgrad::image
