// The B-spline of a height map against its definition, its own differences, and across every border.

#include "image/bicubic.hpp"
#include "image/height_map.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/dual.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace surfgrad::image {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
const std::vector<std::pair<int, int>> sizes{{1, 1}, {2, 3}, {1, 5}, {3, 2}, {8, 8}, {16, 5}};
constexpr Wrap wraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};

/// Texel that shows at index i of an endless row.
int folded(long long i, int n, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::clamp<long long>(i, 0, n - 1));
  const long long period = wrap == Wrap::repeat ? n : 2LL * n;
  const long long m = ((i % period) + period) % period;
  return static_cast<int>(m < n ? m : period - 1 - m);
}

/// The cubic B-spline's bump: its pieces by distance, and its derivative.
double bump(double x) {
  const double a = std::abs(x);
  if (a >= 2) return 0;
  return a >= 1 ? (2 - a) * (2 - a) * (2 - a) / 6 : 2.0 / 3 - a * a + a * a * a / 2;
}
double bump_slope(double x) {
  const double a = std::abs(x);
  if (a >= 2) return 0;
  const double d = a >= 1 ? -(2 - a) * (2 - a) / 2 : -2 * a + 1.5 * a * a;
  return x < 0 ? -d : d;
}

/// Sum of bumps centred on the texels of an endless plane.
BicubicSample<double> by_definition(const Map& map, vec2<double> st, Wraps wrap) {
  const double x = st.x * map.width() - 0.5;
  const double y = st.y * map.height() - 0.5;
  BicubicSample<double> sum{0, {0, 0}};
  for (long long j = std::llround(y) - 3; j <= std::llround(y) + 3; ++j)
    for (long long i = std::llround(x) - 3; i <= std::llround(x) + 3; ++i) {
      const double h =
          test::texel_value(map, 0, folded(i, map.width(), wrap.s), folded(j, map.height(), wrap.t));
      const double u = x - static_cast<double>(i);
      const double v = y - static_cast<double>(j);
      sum.value += h * bump(u) * bump(v);
      sum.derivative = sum.derivative + h * vec2<double>{bump_slope(u) * bump(v), bump(u) * bump_slope(v)};
    }
  return sum;
}

Map random_heights(test::Random& random, int width, int height) {
  return make_height_map(test::random_image(random, width, height, 1), 0);
}

TEST(Bicubic, IsTheSumOfBumpsOnTheTexelsOfAnEndlessPlane) {
  constexpr std::uint64_t seed = 61;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst value("bicubic value");
  test::Worst slope("bicubic derivative");
  for (const auto& [width, height] : sizes) {
    const Map map = random_heights(random, width, height);
    for (const Wrap wrap_s : wraps)
      for (const Wrap wrap_t : wraps)
        for (int k = 0; k < 500; ++k) {
          vec2<double> st = random.vector2(-3, 4);
          if (k % 5 == 0) st.x = random.integer(9) - 4;
          if (k % 7 == 0) st.y = (random.integer(40) - 20 + 0.5) / height;
          const auto got = sample_bicubic<double>(map, st, {wrap_s, wrap_t}, true);
          const auto expected = by_definition(map, st, {wrap_s, wrap_t});
          // 8 eps for texels in [0, 1], and the coordinate: 4 size eps off, on slopes of the value of at
          // most 1 and of the derivative of at most 4 a texel.
          const double moved = 4 * std::max(width, height) * eps;
          value.add(got.value, expected.value, 8 * eps + moved, k);
          slope.add(got.derivative, expected.derivative, 8 * eps + 4 * moved, k);
        }
  }
}

TEST(Bicubic, DerivativeIsThatOfTheValueByDualNumbers) {
  using D = test::Dual<2>;
  constexpr std::uint64_t seed = 62;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("bicubic derivative against dual numbers");
  for (int k = 0; k < 1000; ++k) {
    mat4<double> h;
    mat4<D> dual;
    for (const auto& row : {std::pair{&h.x, &dual.x}, std::pair{&h.y, &dual.y}, std::pair{&h.z, &dual.z},
                            std::pair{&h.w, &dual.w}}) {
      *row.first = {random.uniform(), random.uniform(), random.uniform(), random.uniform()};
      *row.second = {D(row.first->x), D(row.first->y), D(row.first->z), D(row.first->w)};
    }
    const vec2<double> f = random.vector2(0, 1);
    const D value = value_from_bicubic<D>(dual, {D::variable(f.x, 0), D::variable(f.y, 1)});
    worst.add(derivative_from_bicubic(h, f), {value.partial[0], value.partial[1]}, 16 * eps, k); // 8 each
  }
}

TEST(Bicubic, JoinsTwiceSmoothlyAcrossTexelsCopiesAndTheEndOfTheMap) {
  constexpr std::uint64_t seed = 63;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst value("step of the value over a joint");
  test::Worst slope("step of the derivative over a joint");
  const int n = 8;
  const Map map = random_heights(random, n, n);
  const double h = 1e-6; // texels
  for (const Wrap wrap : wraps)
    for (int joint = -3 * n; joint < 4 * n; ++joint)
      for (int k = 0; k < 10; ++k) {
        const double t = random.uniform(-2, 3);
        for (const double at : {joint + 0.5, static_cast<double>(joint)}) { // between pieces, and copies
          const auto below = sample_bicubic<double>(map, {(at - h) / n, t}, {wrap, wrap}, true);
          const auto above = sample_bicubic<double>(map, {(at + h) / n, t}, {wrap, wrap}, true);
          // The derivative's sides differ by at most 2 h times its own slope, which is below 4 for texels
          // in [0, 1]; the value's by at most 2 h times the derivative, below 1.
          value.add(above.value, below.value, 2 * h, joint);
          slope.add(above.derivative, below.derivative, 8 * h, joint);
        }
      }
}

TEST(Bicubic, AtTexelCentresHasTheSlopesOfTheSlopeMap) {
  constexpr std::uint64_t seed = 64;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const int n = 8;
  Image image = make_image(n, n, 1, Depth::float32);
  for (int x = 0; x < n; ++x) { // constant along t, where the spline would smooth
    const auto h = static_cast<float>(random.uniform());
    for (int y = 0; y < n; ++y) image.at(x, y, 0) = h;
  }
  test::Worst worst("bicubic derivative against slope map");
  for (const Wrap wrap : wraps) {
    const Map heights = make_height_map(image, 0);
    const Map slopes = make_height_slopes(image, 0, {wrap, wrap});
    for (int x = 0; x < n; ++x) {
      const auto d = sample_bicubic<double>(heights, {(x + 0.5) / n, 0.37}, {wrap, wrap}, true).derivative;
      // The slope map is rounded to float: half an eps of at most n.
      worst.add(static_cast<double>(n) * d, {test::texel(slopes, 0, x, 3, 0), 0},
                0.5 * n * std::numeric_limits<float>::epsilon(), x);
    }
  }
}

TEST(Bicubic, KeepsARampsSlopeAndAPlateausFlatness) {
  const int n = 16;
  Image ramp = make_image(n, n, 1, Depth::float32);
  Image plateau = make_image(n, n, 1, Depth::float32);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      ramp.at(x, y, 0) = static_cast<float>(5000 + 2 * x - 3 * y);
      plateau.at(x, y, 0) = 5000.1f;
    }
  const Map slope = make_height_map(ramp, 0);
  const Map flat = make_height_map(plateau, 0);
  test::Random random(65);
  test::Worst worst("derivative of a high ramp in float");
  for (int k = 0; k < 1000; ++k) {
    const vec2<float> st{static_cast<float>(random.uniform(0.2, 0.8)),
                         static_cast<float>(random.uniform(0.2, 0.8))};
    const auto got = sample_bicubic<float>(slope, st, {}, true);
    // Texels differ from the one left and below by at most 10: 8 eps of that, whatever the altitude.
    worst.add(vec2<double>{got.derivative.x, got.derivative.y}, {2, -3},
              80 * std::numeric_limits<float>::epsilon(), k);
    const auto level = sample_bicubic<float>(flat, st, {}, true);
    EXPECT_EQ(level.derivative.x, 0);
    EXPECT_EQ(level.derivative.y, 0);
    EXPECT_EQ(level.value, 5000.1f);
  }
}

TEST(Bicubic, BeyondAClampedMapIsLevel) {
  test::Random random(66);
  const Map map = random_heights(random, 5, 5);
  for (const double s : {-1e30, -7.0, -0.31, 1.31, 9.0, 1e30}) {
    const auto got = sample_bicubic<double>(map, {s, 0.5}, {Wrap::clamp, Wrap::clamp}, true);
    EXPECT_NEAR(got.derivative.x, 0, 8 * eps) << s;
    EXPECT_NE(got.derivative.y, 0);
  }
}

TEST(Bicubic, IsFiniteForAnyCoordinateAndEqualForEveryLane) {
  using simd::EmulatedFloat;
  using simd::EmulatedMask;
  constexpr float odd[] = {std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           1e30f,
                           -3.0f,
                           1.0f};
  constexpr std::uint64_t seed = 67;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (const auto& [width, height] : sizes) {
    const Map map = random_heights(random, width, height);
    for (const Wrap wrap : wraps)
      for (int k = 0; k < 200; ++k) {
        vec2<EmulatedFloat> st{};
        EmulatedMask active{};
        const auto coordinate = [&] {
          return random.integer(3) == 0 ? odd[random.integer(6)] : static_cast<float>(random.uniform(-3, 4));
        };
        for (int i = 0; i < simd::emulated_width; ++i) {
          st.x.lane[i] = coordinate();
          st.y.lane[i] = coordinate();
          active.lane[i] = random.integer(4) != 0;
        }
        const auto pack = sample_bicubic<EmulatedFloat>(map, st, {wrap, wrap}, active);
        for (int i = 0; i < simd::emulated_width; ++i) {
          const auto one =
              sample_bicubic<float>(map, {st.x.lane[i], st.y.lane[i]}, {wrap, wrap}, active.lane[i]);
          const auto same = [&](float a, float b) {
            EXPECT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b)) << k;
            EXPECT_TRUE(std::isfinite(a) && (active.lane[i] || a == 0)) << a;
          };
          same(pack.value.lane[i], one.value);
          same(pack.derivative.x.lane[i], one.derivative.x);
          same(pack.derivative.y.lane[i], one.derivative.y);
        }
      }
  }
}

} // namespace
} // namespace surfgrad::image
