// Heights and their slopes: what a file's values mean, and how exact central differences are.

#include "image/height_map.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace surfgrad::image {
namespace {

using test::texel;

constexpr double float_eps = std::numeric_limits<float>::epsilon();
constexpr double two_pi = 6.28318530717958648;
const std::vector<std::pair<int, int>> sizes{{1, 1}, {2, 1}, {1, 9}, {13, 7}, {16, 16}, {64, 8}, {31, 63}};
constexpr Wrap wraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};

/// A float file of the function of s and t at the texel centres.
template <class Function>
Image heights_of(int width, int height, Function f) {
  Image image = make_image(width, height, 1, Depth::float32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y, 0) = static_cast<float>(f((x + 0.5) / width, (y + 0.5) / height));
  return image;
}

vec2<double> slope_at(const Map& map, int x, int y, int level = 0) {
  return {texel(map, level, x, y, 0), texel(map, level, x, y, 1)};
}

TEST(HeightMap, KeepsAFloatFilesValuesWhereverTheyLie) {
  Image image = make_image(4, 1, 1, Depth::float32);
  image.texels = {-3.5f, 7.25f, 0.5f, 1000.0f};
  const Map map = make_height_map(image, 0);
  EXPECT_EQ(map.components, 1);
  for (int x = 0; x < 4; ++x) EXPECT_EQ(texel(map, 0, x, 0, 0), image.at(x, 0, 0));
  EXPECT_EQ(texel(map, 2, 0, 0, 0), 1004.25f / 4);
}

TEST(HeightMap, ReadsTheChannelAskedFor) {
  Image image = make_image(1, 1, 4);
  image.texels = {0.125f, 0.25f, 0.375f, 0.5f};
  for (const int c : {0, 1, 2, 3})
    EXPECT_EQ(texel(make_height_map(image, c), 0, 0, 0, 0), 0.125f * static_cast<float>(c + 1));
}

TEST(HeightMap, TurnsWhatIsNotFiniteToZeroAndKeepsEveryLevelAndFilterFinite) {
  constexpr float huge = std::numeric_limits<float>::max();
  constexpr float inf = std::numeric_limits<float>::infinity();
  Image image = make_image(4, 2, 1, Depth::float32);
  image.texels = {huge, -huge, huge, -huge, std::numeric_limits<float>::quiet_NaN(), inf, -inf, 2};
  const Map map = make_height_map(image, 0);
  const Map slopes = make_height_slopes(image, 0, {});
  for (const int x : {0, 1, 2}) EXPECT_EQ(texel(map, 0, x, 1, 0), 0);
  EXPECT_EQ(texel(map, 0, 3, 1, 0), 2);
  for (const Map* m : {&map, &slopes})
    for (const std::uint32_t word : m->words) EXPECT_TRUE(std::isfinite(std::bit_cast<float>(word)));
  const auto h = sample<1, float>(map, {0.3f, 0.2f}, 0.0f, {}, Filter::bilinear, true);
  EXPECT_TRUE(std::isfinite(h[0]));
}

TEST(HeightSlopes, AreExactForQuadraticsAwayFromTheBorder) {
  constexpr std::uint64_t seed = 51;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("slope of a quadratic");
  for (const auto& [width, height] : sizes) {
    const vec3<double> a = random.vector3(); // s^2, s t, t^2
    const vec2<double> b = random.vector2();
    const auto h = [&](double s, double t) {
      return a.x * s * s + a.y * s * t + a.z * t * t + b.x * s + b.y * t;
    };
    const Map map = make_height_slopes(heights_of(width, height, h), 0, {Wrap::clamp, Wrap::clamp});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double s = (x + 0.5) / width;
        const double t = (y + 0.5) / height;
        // Two heights, at most 5 in size and half an eps of that off, half their difference times the
        // size; then half an ulp of a slope of at most 4.
        const auto bound = [](int size) { return float_eps * (2.5 * size + 2); };
        if (0 < x && x < width - 1)
          worst.add(slope_at(map, x, y).x, 2 * a.x * s + a.y * t + b.x, bound(width), 100 * y + x);
        if (0 < y && y < height - 1)
          worst.add(slope_at(map, x, y).y, 2 * a.z * t + a.y * s + b.y, bound(height), 100 * y + x);
      }
  }
}

TEST(HeightSlopes, OfAPeriodicWaveAreDampedBySincOverTheSeamToo) {
  test::Worst worst("slope of a wave");
  for (const int waves : {1, 3, 8}) {
    const int n = 32;
    const auto h = [&](double s, double t) {
      return std::sin(two_pi * waves * s + 0.3) + std::cos(two_pi * t);
    };
    const Map map = make_height_slopes(heights_of(n, n, h), 0, {});
    const auto damped = [&](int count) { // per map: 2 pi count * sin(w) / w with w = 2 pi count / n
      return n * std::sin(two_pi * count / n);
    };
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const double s = (x + 0.5) / n;
        const double t = (y + 0.5) / n;
        // As for quadratics, with heights of at most 2 and slopes of at most n.
        worst.add(slope_at(map, x, y),
                  {damped(waves) * std::cos(two_pi * waves * s + 0.3), -damped(1) * std::sin(two_pi * t)},
                  float_eps * 1.5 * n, 1000 * waves + n * y + x);
      }
  }
}

TEST(HeightSlopes, AtTheBorderSeeWhatTheWrapPutsThere) {
  Image image = make_image(4, 1, 1, Depth::float32);
  image.texels = {1, 3, 4, 9};
  const auto ends = [&](Wrap wrap) {
    const Map map = make_height_slopes(image, 0, {wrap, wrap});
    for (int x = 0; x < 4; ++x) EXPECT_EQ(slope_at(map, x, 0).y, 0); // one row is flat along t
    EXPECT_EQ(slope_at(map, 1, 0).x, 6);                             // (4 - 1) / 2 * 4
    return vec2<double>{slope_at(map, 0, 0).x, slope_at(map, 3, 0).x};
  };
  EXPECT_EQ(ends(Wrap::repeat).x, 2 * (3 - 9));
  EXPECT_EQ(ends(Wrap::repeat).y, 2 * (1 - 4));
  for (const Wrap wrap : {Wrap::mirror, Wrap::clamp}) {
    EXPECT_EQ(ends(wrap).x, 2 * (3 - 1));
    EXPECT_EQ(ends(wrap).y, 2 * (9 - 4));
  }
}

TEST(HeightSlopes, AverageToZeroOverAMapThatRepeats) {
  constexpr std::uint64_t seed = 52;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("mean slope of a repeating height map");
  for (const auto& [width, height] : sizes) {
    const Map map = make_height_slopes(test::random_image(random, width, height, 1), 0, {});
    // Differences telescope to 0; each level rounds slopes of at most size / 2 to half an eps of that.
    worst.add(slope_at(map, 0, 0, map.level_count - 1), {0, 0},
              0.25 * float_eps * std::max(width, height) * map.level_count, width);
  }
}

TEST(HeightSlopes, DoNotDependOnTheResolutionOfTheImage) {
  const auto ramp = [](double s, double t) { return s - 0.25 * t; };
  for (const int n : {4, 16, 128}) {
    const Map map = make_height_slopes(heights_of(n, 2 * n, ramp), 0, {Wrap::clamp, Wrap::clamp});
    EXPECT_EQ(slope_at(map, n / 2, n).x, 1);
    EXPECT_EQ(slope_at(map, n / 2, n).y, -0.25);
  }
}

TEST(HeightSlopes, SampledAnywhereAreThoseOfTheWrappedHeights) {
  constexpr std::uint64_t seed = 53;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  // Of a float file, so that heights are sampled as the very numbers that the slopes were made of.
  const Image image = test::random_image(random, 8, 8, 1, Depth::float32);
  for (const Wrap wrap_s : wraps)
    for (const Wrap wrap_t : wraps) {
      const Wraps both{wrap_s, wrap_t};
      const Map heights = make_height_map(image, 0);
      const Map slopes = make_height_slopes(image, 0, both);
      test::Worst worst("slope on any copy against differences of heights");
      for (int k = 0; k < 400; ++k) {
        const auto centre = [&] { return (random.integer(64) - 32 + 0.5) / 8; }; // of a texel, anywhere
        const vec2<double> st{centre(), centre()};
        const auto height_at = [&](double ds, double dt) {
          return sample<1, double>(heights, {st.x + ds, st.y + dt}, 0.0, both, Filter::nearest, true)[0];
        };
        const auto d = sample<2, double>(slopes, st, 0.0, both, Filter::nearest, true);
        // Nearest texels of the same heights: only the slope's own rounding, half an ulp of at most 4.
        worst.add(wrapped_slope(st, {d[0], d[1]}, both),
                  {4 * (height_at(0.125, 0) - height_at(-0.125, 0)),
                   4 * (height_at(0, 0.125) - height_at(0, -0.125))},
                  2 * float_eps, k);
      }
    }
}

} // namespace
} // namespace surfgrad::image
