// Rays over height fields, against the surface's definition cell by cell and against a dense linear search.

#include "image/height_march.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace surfgrad::image {
namespace {

using simd::emulated_width;
using simd::EmulatedFloat;
using simd::EmulatedMask;

constexpr Wrap wraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};
const std::vector<std::pair<int, int>> sizes{{1, 1}, {1, 2}, {2, 9},   {5, 1},
                                             {8, 8}, {7, 3}, {13, 32}, {33, 20}};

/// Texel that shows at index i of an endless row.
int folded(long long i, int n, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::clamp<long long>(i, 0, n - 1));
  const long long period = wrap == Wrap::repeat ? n : 2LL * n;
  const long long m = ((i % period) + period) % period;
  return static_cast<int>(m < n ? m : period - 1 - m);
}

/// A ray over one level's surface, in double, by the definition.
struct Truth {
  const Map& map;
  int level;
  Wraps wrap;
  vec2<double> st, dst;

  [[nodiscard]] vec2<double> texels_at(double h) const {
    return {(st.x + h * dst.x) * map.width(level) - 0.5, (st.y + h * dst.y) * map.height(level) - 0.5};
  }
  /// Height of the surface above the ray, on the patch of the cell that holds `inside`.
  [[nodiscard]] double above_ray(double h, vec2<double> inside) const {
    const vec2<double> p = texels_at(h);
    const double i = std::floor(inside.x), j = std::floor(inside.y);
    double sum = 0;
    for (const int dj : {0, 1})
      for (const int di : {0, 1}) {
        const double x = p.x - i, y = p.y - j;
        sum += (di == 0 ? 1 - x : x) * (dj == 0 ? 1 - y : y) *
               test::texel(map, level, folded(static_cast<long long>(i) + di, map.width(level), wrap.s),
                           folded(static_cast<long long>(j) + dj, map.height(level), wrap.t), 0);
      }
    return sum - h;
  }
  [[nodiscard]] double above_ray(double h) const { return above_ray(h, texels_at(h)); }

  /// Ray heights in [low, high] at which it crosses the lattice of texel centres, descending, with the ends.
  [[nodiscard]] std::vector<double> crossings(double low, double high) const {
    std::vector<double> result{low, high};
    const vec2<double> p = texels_at(low), q = texels_at(high);
    const auto along = [&](double a, double b) {
      if (a == b) return;
      for (double line = std::ceil(std::min(a, b)); line <= std::max(a, b); ++line)
        result.push_back(std::clamp(low + (high - low) * (line - a) / (b - a), low, high));
    };
    along(p.x, q.x);
    along(p.y, q.y);
    std::sort(result.begin(), result.end(), std::greater<>());
    return result;
  }

  /// The largest height of the surface above the ray for ray heights in [low, high].
  [[nodiscard]] double most_above(double low, double high) const {
    double most = -HUGE_VAL;
    const std::vector<double> at = crossings(low, high);
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      const double a = at[k], b = at[k + 1], middle = 0.5 * (a + b);
      const vec2<double> cell = texels_at(middle);
      const double at_a = above_ray(a, cell), at_b = above_ray(b, cell), between = above_ray(middle, cell);
      most = std::max({most, at_a, at_b});
      // The parabola through three points: at_a + s * u + c * u^2.
      const double c = 2 * (at_a + at_b) - 4 * between;
      const double s = at_b - at_a - c;
      if (c < 0 && 0 < s && s < -2 * c) most = std::max(most, at_a - s * s / (4 * c));
    }
    return most;
  }
};

/// Magnitude of a coordinate within its period, in texels.
double at_texels(double s, int n, Wrap wrap) {
  if (wrap == Wrap::repeat) s -= std::floor(s);
  if (wrap == Wrap::mirror) s -= 2 * std::floor(s / 2);
  return std::abs(s) * n;
}

/// The bound of march: roundings of heights, and of the position in texels where slopes are at most 1.
template <class T>
double bound(const Truth& truth) {
  const int width = truth.map.width(truth.level), height = truth.map.height(truth.level);
  return epsilon_v<T> *
         (8 + 4 * (at_texels(truth.st.x, width, truth.wrap.s) + std::abs(truth.dst.x) * width +
                   at_texels(truth.st.y, height, truth.wrap.t) + std::abs(truth.dst.y) * height));
}

/// Rough everywhere, a plain with a few spikes one texel wide, or steps of a few heights (flat cells).
Map heights(test::Random& random, int width, int height) {
  Image image = test::random_image(random, width, height, 1);
  const int kind = random.integer(3);
  const float plain = static_cast<float>(random.uniform(0, 0.3));
  for (float& t : image.texels.floats()) {
    if (kind == 1) t = random.integer(20) == 0 ? t : plain;
    if (kind == 2) t = std::floor(t * 4) / 4;
  }
  return make_channel_map(image, 0);
}

/// Ways from steep to grazing, along the axes, the diagonals or anywhere.
vec2<double> way(test::Random& random, double most) {
  const double length = random.magnitude(1e-4, most);
  switch (random.integer(6)) {
  case 0:
    return {random.sign() * length, 0};
  case 1:
    return {0, random.sign() * length};
  case 2:
    return {random.sign() * length, random.sign() * length};
  default:
    const double angle = random.uniform(-3.2, 3.2);
    return {length * std::cos(angle), length * std::sin(angle)};
  }
}

/// Anywhere, on a texel centre or on a border between texels.
double coordinate(test::Random& random, int n) {
  switch (random.integer(4)) {
  case 0:
    return (random.integer(4 * n) - n + 0.5) / n;
  case 1:
    return (random.integer(4 * n) - n) / static_cast<double>(n);
  default:
    return random.uniform(-2, 3);
  }
}

template <class T>
detail::Crossing<T> crossing(const HeightField& field, Wraps wrap, vec2<T> st, vec2<T> dst) {
  const auto leveled = detail::leveled_ray<T>(field, wrap, st, dst, T(0), true);
  return detail::first_crossing<T>(field, leveled.ray, T(0), true);
}

TEST(HeightField, EveryNodeHoldsTheLargestHeightOfItsCells) {
  constexpr std::uint64_t seed = 51;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  long compared = 0;
  for (const auto& [width, height] : sizes) {
    const HeightField field =
        make_height_field(make_channel_map(test::random_image(random, width, height, 1), 0));
    const Map& map = field.map;
    for (int level = 0; level < map.level_count; ++level) {
      const auto* row = &field.node_table[static_cast<std::size_t>(level * field.row_words)];
      const int w = map.width(level), h = map.height(level);
      ASSERT_GE(1 << row[0], std::max(w, h));
      for (int order = 1; order <= static_cast<int>(row[0]); ++order) {
        const int size = 1 << order;
        const int columns = (w + size - 1) / size, rows = (h + size - 1) / size;
        for (int y = 0; y < rows; ++y)
          for (int x = 0; x < columns; ++x, ++compared) {
            float most = 0;
            for (int j = y * size; j <= std::min((y + 1) * size, h); ++j)
              for (int i = x * size; i <= std::min((x + 1) * size, w); ++i)
                most = std::max(most, test::texel(map, level, i % w, j % h, 0));
            const auto word = row[order] + static_cast<std::uint32_t>(y * columns + x);
            ASSERT_EQ(std::bit_cast<float>(field.maxima[word]), most);
          }
      }
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(HeightField, TakesTheMemoryItStates) {
  const HeightField field = make_height_field(make_channel_map(make_image(1024, 1024, 1, Depth::float32), 0));
  const double words = static_cast<double>(field.map.words.size() + field.maxima.size());
  EXPECT_NEAR(4 * words / (1024 * 1024), 7.1, 0.05);
}

template <class T>
class HeightMarch : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HeightMarch, Scalars);

TYPED_TEST(HeightMarch, MeetsTheSurfaceAndNothingBeforeIt) {
  using T = TypeParam;
  constexpr std::uint64_t seed = 52;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst on_surface("height against the surface"), before("surface above the ray before it");
  double visits = 0, cells = 0;
  for (int m = 0; m < 400; ++m) {
    const auto [width, height] = sizes[static_cast<std::size_t>(m) % sizes.size()];
    const HeightField field = make_height_field(heights(random, width, height));
    const Wraps wrap{wraps[random.integer(3)], wraps[random.integer(3)]};
    for (int k = 0; k < 100; ++k) {
      const int level = random.integer(field.map.level_count);
      const T lod = static_cast<T>(level + random.uniform(-0.49, 0.49));
      const vec2<double> d = way(random, 30);
      vec2<double> at{coordinate(random, width), coordinate(random, height)};
      if (random.integer(3) == 0) {
        // Enters a cell just above the surface, which may fall away from there and rise again.
        const double over = random.magnitude(1e-8, 1e-3);
        at.x = (random.integer(width) + 0.5) / width;
        at = at - (Truth{field.map, 0, wrap, at, {0, 0}}.above_ray(0) + over) * d;
      }
      const vec2<T> st{static_cast<T>(at.x), static_cast<T>(at.y)};
      const vec2<T> dst{static_cast<T>(d.x), static_cast<T>(d.y)};
      const ParallaxHit<T> hit = march<T>(field, wrap, st, dst, lod, true);
      ASSERT_TRUE(hit.hit);
      ASSERT_EQ(hit.texture_coordinate.x, st.x + hit.height * dst.x);
      ASSERT_EQ(hit.texture_coordinate.y, st.y + hit.height * dst.y);
      const Truth truth{field.map, level, wrap, {st.x, st.y}, {dst.x, dst.y}};
      const double limit = bound<T>(truth);
      // A ray under the surface from the start, at a peak of height 1, meets it at the top.
      const double off = truth.above_ray(double{hit.height});
      if (hit.height < 1)
        on_surface.add(off, 0, limit, m * 100 + k);
      else
        ASSERT_GE(off, -limit);
      before.add(std::max(truth.most_above(double{hit.height}, 1), 0.0), 0, limit, m * 100 + k);
      if (level == 0) {
        visits += crossing<T>(field, wrap, st, dst).visits;
        cells += static_cast<double>(truth.crossings(double{hit.height}, 1).size() - 1);
      }
    }
  }
  std::printf("  visits %.0f, cells on the way to the crossing %.0f\n", visits, cells);
}

TYPED_TEST(HeightMarch, AgreesWithALinearSearchThatResolvesEverything) {
  using T = TypeParam;
  constexpr std::uint64_t seed = 53;
  constexpr int steps = 1 << 16;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("height against 2^16 steps");
  int grazes = 0;
  for (int k = 0; k < 300; ++k) {
    const auto [width, height] = sizes[static_cast<std::size_t>(k) % sizes.size()];
    const HeightField field = make_height_field(heights(random, width, height));
    const Wraps wrap{wraps[random.integer(3)], wraps[random.integer(3)]};
    const vec2<double> d = way(random, 2);
    const vec2<T> st{static_cast<T>(random.uniform(0, 1)), static_cast<T>(random.uniform(0, 1))};
    const vec2<T> dst{static_cast<T>(d.x), static_cast<T>(d.y)};
    const ParallaxHit<T> hit = march<T>(field, wrap, st, dst, T(0), true);
    const auto sampled = [&](vec2<T> uv, T, bool active) {
      return sample<1, T>(field.map, uv, T(0), wrap, Filter::bilinear, active)[0];
    };
    const ParallaxHit<T> searched = march_parallax(sampled, st, dst, steps);
    ASSERT_TRUE(searched.hit);
    const Truth truth{field.map, 0, wrap, {st.x, st.y}, {dst.x, dst.y}};
    const double at = double{hit.height};
    // Height a unit of ray height at which ray and surface approach, over the search's last step.
    const double rate = (truth.above_ray(std::max(at - 1.0 / steps, 0.0)) - truth.above_ray(at)) * steps;
    if (hit.height == 1 || rate > 0.05) {
      // The step is halved parallax_refinements times; both methods' roundings, over the rate.
      worst.add(at, double{searched.height}, 1.0 / (64.0 * steps) + 2 * bound<T>(truth) / std::min(rate, 1.0),
                k);
    } else {
      // The ray grazes: the search meets the crest anywhere over it, or steps over it and goes on.
      ++grazes;
      EXPECT_LT(double{searched.height}, at + 1.0 / steps + bound<T>(truth));
    }
  }
  std::printf("  %d grazes of 300\n", grazes);
  EXPECT_LE(grazes, 15);
}

TYPED_TEST(HeightMarch, FindsAPeakOneTexelWideThatALinearSearchStepsOver) {
  using T = TypeParam;
  Image image = make_image(512, 512, 1, Depth::float32);
  image.at(200, 256, 0) = 1;
  const HeightField field = make_height_field(make_channel_map(image, 0));
  const T row = T(256.5 / 512);
  int stepped_over = 0;
  for (int k = 0; k < 64; ++k) {
    // Over the peak's centre at height 0.7, at a grazing angle.
    const vec2<T> dst{static_cast<T>(0.3 + 0.005 * k), T(0)};
    const vec2<T> st{T(200.5 / 512) - T(0.7) * dst.x, row};
    const ParallaxHit<T> hit = march<T>(field, {}, st, dst, T(0), true);
    // The ray meets the slope towards it, less than a texel from the centre.
    EXPECT_GT(hit.height, T(0.7));
    EXPECT_LT(hit.height, T(0.7) + T(1) / (512 * dst.x));
    const auto sampled = [&](vec2<T> uv, T, bool active) {
      return sample<1, T>(field.map, uv, T(0), {}, Filter::bilinear, active)[0];
    };
    if (march_parallax(sampled, st, dst, 32).height < T(0.1)) ++stepped_over;
    EXPECT_LT(crossing<T>(field, {}, st, dst).visits, 60); // of up to 160 cells
  }
  std::printf("  32 steps pass over %d of 64 peaks\n", stepped_over);
  EXPECT_GT(stepped_over, 32);
}

TYPED_TEST(HeightMarch, WithoutAWayGivesTheHeightInPlace) {
  using T = TypeParam;
  test::Random random(54);
  test::Worst worst("height in place");
  for (const auto& [width, height] : sizes) {
    const HeightField field = make_height_field(heights(random, width, height));
    for (const Wrap wrap : wraps)
      for (int k = 0; k < 100; ++k) {
        const vec2<T> st{static_cast<T>(random.uniform(-1, 2)), static_cast<T>(random.uniform(-1, 2))};
        const auto hit = march<T>(field, {wrap, wrap}, st, {T(0), T(0)}, T(0), true);
        const Truth truth{field.map, 0, {wrap, wrap}, {st.x, st.y}, {0, 0}};
        worst.add(double{hit.height}, truth.above_ray(0), bound<T>(truth), k);
        EXPECT_EQ(hit.texture_coordinate.x, st.x);
        EXPECT_EQ(hit.texture_coordinate.y, st.y);
      }
  }
}

TYPED_TEST(HeightMarch, MeetsTheTopAndTheGroundExactly) {
  using T = TypeParam;
  for (const float level : {0.0f, 1.0f}) {
    Image image = make_image(9, 4, 1, Depth::float32);
    std::fill(image.texels.floats().begin(), image.texels.floats().end(), level);
    const HeightField field = make_height_field(make_channel_map(image, 0));
    for (const Wrap wrap : wraps)
      for (const T d : {T(0), T(0.01), T(-0.7), T(55)}) {
        const auto hit = march<T>(field, {wrap, wrap}, {T(0.3), T(0.8)}, {d, T(0.5) * d}, T(0), true);
        EXPECT_TRUE(hit.hit);
        EXPECT_EQ(hit.height, T(level));
      }
  }
}

TYPED_TEST(HeightMarch, EndsWithinItsBoundForAnyInput) {
  using T = TypeParam;
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  constexpr T inf = std::numeric_limits<T>::infinity();
  constexpr T least = std::numeric_limits<T>::denorm_min();
  constexpr T most = std::numeric_limits<T>::max();
  const std::vector<T> coordinates{T(0), T(0.37), T(-1e5), T(3e9), least, most, -most, inf, nan};
  const std::vector<T> ways{T(0),     -T(0),  T(1),     T(-40), least, -std::numeric_limits<T>::min(),
                            T(1e-20), T(3e4), T(-1e12), most,   inf,   -inf,
                            nan};
  test::Random random(55);
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1}, {3, 8}, {64, 64}}) {
    // A plain with walls, so that many rays go a long way.
    Image image = test::random_image(random, width, height, 1);
    for (float& t : image.texels.floats()) t *= t < 0.1f ? 1.0f : 0.0f;
    image.texels.floats().back() = 1;
    const HeightField field = make_height_field(make_channel_map(image, 0));
    for (const Wrap wrap : wraps)
      for (const T s : coordinates)
        for (const T x : ways)
          for (const T y : ways) {
            if (random.integer(20) != 0) continue; // they are long
            const vec2<T> st{s, T(0.4)}, dst{x, y};
            const auto hit = march<T>(field, {wrap, wrap}, st, dst, s, true);
            ASSERT_TRUE(hit.hit);
            ASSERT_TRUE(0 <= hit.height && hit.height <= 1);
            if (std::isfinite(s)) {
              ASSERT_TRUE(hit.texture_coordinate.x == hit.texture_coordinate.x);
            }
            const auto leveled = detail::leveled_ray<T>(field, {wrap, wrap}, st, dst, T(0), true);
            const double way_x = std::abs(static_cast<double>(leveled.ray.x.way));
            const double way_y = std::abs(static_cast<double>(leveled.ray.y.way));
            ASSERT_LE(std::max(way_x, way_y), march_most_texels * (1 + 1e-6));
            const int visits = detail::first_crossing<T>(field, leveled.ray, T(0), true).visits;
            ASSERT_LE(visits, detail::most_visits(way_x, way_y)) << "st " << s << ", way " << x << ", " << y;
            const T light = visible<T>(field, {wrap, wrap}, st, hit.height, dst, T(0), true);
            ASSERT_TRUE(light == 0 || light == 1);
          }
  }
}

TYPED_TEST(HeightMarch, PassesALongPlainInFewSteps) {
  using T = TypeParam;
  // One row of peaks in a wide plain, and a ray beside it over 25 repetitions.
  Image image = make_image(1024, 1024, 1, Depth::float32);
  for (int x = 0; x < 256; x += 16) image.at(x, 0, 0) = 1;
  const HeightField field = make_height_field(make_channel_map(image, 0));
  const auto found = crossing<T>(field, {}, {T(0.2), T(128.5 / 256)}, {T(25), T(0)});
  std::printf("  %d visits for 6400 cells\n", found.visits);
  EXPECT_EQ(found.height, 0);
  EXPECT_LT(found.visits, 6400 / 8);
}

TYPED_TEST(HeightMarch, SeesTheLightExactlyWhereTheWayIsFree) {
  using T = TypeParam;
  constexpr std::uint64_t seed = 56;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  long lit = 0, dark = 0, undecided = 0;
  for (int m = 0; m < 200; ++m) {
    const auto [width, height] = sizes[static_cast<std::size_t>(m) % sizes.size()];
    const HeightField field = make_height_field(heights(random, width, height));
    const Wraps wrap{wraps[random.integer(3)], wraps[random.integer(3)]};
    for (int k = 0; k < 100; ++k) {
      const vec2<double> to_viewer = way(random, 1), to_light = way(random, 3);
      const vec2<T> st{static_cast<T>(random.uniform(0, 1)), static_cast<T>(random.uniform(0, 1))};
      const vec2<T> dst{static_cast<T>(to_viewer.x), static_cast<T>(to_viewer.y)};
      const vec2<T> light{static_cast<T>(to_light.x), static_cast<T>(to_light.y)};
      const ParallaxHit<T> hit = march<T>(field, wrap, st, dst, T(0), true);
      const T height_over = random.integer(2) == 0 ? T(0) : static_cast<T>(random.uniform(0, 0.2));
      const T from = min(hit.height + height_over, T(1));
      const T got = visible<T>(field, wrap, hit.texture_coordinate, from, light, T(0), true);
      // The way as a ray over the ground, lifted by half of the stated bias and by twice as much: what the
      // roundings may take from it and add.
      const vec2<double> at{hit.texture_coordinate.x, hit.texture_coordinate.y}, toward{light.x, light.y};
      const double bias = 8 * epsilon_v<T> *
                          (1 + std::max(at_texels(at.x, width, wrap.s) + std::abs(toward.x) * width,
                                        at_texels(at.y, height, wrap.t) + std::abs(toward.y) * height));
      const auto blocked = [&](double lift) {
        const double start = double{from} + lift;
        const Truth truth{field.map, 0, wrap, at - start * toward, toward};
        return start < 1 && truth.most_above(start, 1) >= 0;
      };
      if (!blocked(0.5 * bias)) {
        ++lit;
        ASSERT_EQ(got, T(1)) << "map " << m << " case " << k;
      } else if (blocked(2 * bias)) {
        ++dark;
        ASSERT_EQ(got, T(0)) << "map " << m << " case " << k;
      } else {
        ++undecided;
      }
    }
  }
  std::printf("  lit %ld, dark %ld, within rounding %ld\n", lit, dark, undecided);
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 1000);
}

TYPED_TEST(HeightMarch, FarOutsideAClampedMapOnlyTheBorderCounts) {
  using T = TypeParam;
  Image image = make_image(4, 4, 1, Depth::float32);
  for (int x = 0; x < 4; ++x) image.at(x, 2, 0) = x == 3 ? 0.75f : 1.0f;
  const HeightField field = make_height_field(make_channel_map(image, 0));
  const Wraps wrap{Wrap::clamp, Wrap::repeat};
  for (const T s : {T(1.5), T(1e3), T(1e9)}) {
    // Along t, below the border's ridge of 0.75 at t = 0.625.
    const vec2<T> st{s, T(0.125)}, dst{T(0), T(0.5)};
    const auto hit = march<T>(field, wrap, st, {T(0), T(1)}, T(0), true);
    // 0.75 * (1 - (0.125 + h - 0.625) / 0.25) = h; all but exact in these numbers.
    EXPECT_NEAR(hit.height, 0.5625, 1e-6);
    EXPECT_EQ(visible<T>(field, wrap, st, T(0), dst, T(0), true), T(1));
    EXPECT_EQ(visible<T>(field, wrap, st, T(0), {T(0), T(1)}, T(0), true), T(0));
  }
}

TYPED_TEST(HeightMarch, ASurfaceDoesNotShadeItself) {
  using T = TypeParam;
  // A plain, and pyramids: the light is steeper than any of their slopes, of which the steepest, at the edges
  // between two sides, is slope * n * sqrt(2).
  constexpr int n = 64;
  test::Random random(57);
  for (const double slope : {0.0, 0.4 / n, 0.9 / n}) {
    Image image = make_image(n, n, 1, Depth::float32);
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x)
        image.at(x, y, 0) =
            static_cast<float>(0.05 + slope * std::min(std::min(x, n - 1 - x), std::min(y, n - 1 - y)));
    const HeightField field = make_height_field(make_channel_map(image, 0));
    for (int k = 0; k < 2000; ++k) {
      const vec2<double> d = way(random, 0.5);
      const vec2<T> st{static_cast<T>(random.uniform(0, 1)), static_cast<T>(random.uniform(0, 1))};
      const auto hit = march<T>(field, {}, st, {static_cast<T>(d.x), static_cast<T>(d.y)}, T(0), true);
      // Length of the way while the light's ray rises by 1.
      const double reach = slope == 0 ? 100 : 0.7 / (slope * n);
      const double angle = random.uniform(-3.2, 3.2);
      const vec2<T> light{static_cast<T>(reach * std::cos(angle)), static_cast<T>(reach * std::sin(angle))};
      ASSERT_EQ(visible<T>(field, {}, hit.texture_coordinate, hit.height, light, T(0), true), T(1))
          << "slope " << slope << " case " << k;
    }
  }
}

TEST(HeightMarchLanes, EqualOneLaneBitForBit) {
  constexpr std::uint64_t seed = 58;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const auto any_number = [&](double value) {
    switch (random.integer(200)) {
    case 0:
      return std::numeric_limits<float>::quiet_NaN();
    case 1:
      return random.sign() < 0 ? -1e30f : std::numeric_limits<float>::infinity();
    case 2:
      return 0.0f;
    default:
      return static_cast<float>(value);
    }
  };
  const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
  for (int m = 0; m < 100; ++m) {
    const auto [width, height] = sizes[static_cast<std::size_t>(m) % sizes.size()];
    const HeightField field = make_height_field(heights(random, width, height));
    const Wraps wrap{wraps[random.integer(3)], wraps[random.integer(3)]};
    for (int k = 0; k < 20; ++k) {
      vec2<EmulatedFloat> st{}, dst{};
      EmulatedFloat lod{}, from{};
      EmulatedMask active{};
      for (int i = 0; i < emulated_width; ++i) {
        const vec2<double> d = way(random, 3);
        st.x.lane[i] = any_number(random.uniform(-2, 3));
        st.y.lane[i] = any_number(random.uniform(-2, 3));
        dst.x.lane[i] = any_number(d.x);
        dst.y.lane[i] = any_number(d.y);
        lod.lane[i] = any_number(random.uniform(-1, 5));
        from.lane[i] = any_number(random.uniform(0, 1));
        active.lane[i] = random.integer(4) != 0;
      }
      const auto pack = march<EmulatedFloat>(field, wrap, st, dst, lod, active);
      const auto lights = visible<EmulatedFloat>(field, wrap, st, from, dst, lod, active);
      for (int i = 0; i < emulated_width; ++i) {
        const vec2<float> one_st{st.x.lane[i], st.y.lane[i]}, one_dst{dst.x.lane[i], dst.y.lane[i]};
        const auto one = march<float>(field, wrap, one_st, one_dst, lod.lane[i], active.lane[i]);
        ASSERT_EQ(bits(pack.height.lane[i]), bits(one.height)) << "lane " << i;
        ASSERT_EQ(bits(pack.texture_coordinate.x.lane[i]), bits(one.texture_coordinate.x));
        ASSERT_EQ(bits(pack.texture_coordinate.y.lane[i]), bits(one.texture_coordinate.y));
        ASSERT_EQ(pack.hit.lane[i], one.hit);
        ASSERT_EQ(one.hit, active.lane[i]);
        ASSERT_EQ(bits(lights.lane[i]), bits(visible<float>(field, wrap, one_st, from.lane[i], one_dst,
                                                            lod.lane[i], active.lane[i])));
      }
    }
  }
}

} // namespace
} // namespace surfgrad::image
