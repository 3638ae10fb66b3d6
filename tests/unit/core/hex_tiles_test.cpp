/// Hex tiles against their definition, across borders, and in statistics.

#include "support/random.hpp"
#include "support/worst.hpp"
#include <surfgrad/hex_tiles.hpp>

#include <array>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

namespace surfgrad::test {
namespace {

using Tiles = HexTiles<double>;

template <class T>
vec2<T> narrow(vec2<double> v) {
  return {static_cast<T>(v.x), static_cast<T>(v.y)};
}
template <class T>
vec2<double> widen(vec2<T> v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y)};
}

/// A periodic map of slopes that differs everywhere within its period.
vec2<double> slopes_of_map(vec2<double> st) {
  constexpr double turn = 2 * std::numbers::pi;
  return {std::sin(turn * st.x) + 0.5 * std::cos(turn * (2 * st.y - st.x)),
          0.8 * std::cos(turn * (st.y + st.x)) + 0.4 * std::sin(turn * 3 * st.y)};
}
/// Its slopes change by less than this per unit: 2 pi times the sum of amplitude * |wave vector|.
constexpr double steepest_change = 6.2832 * (1 + 0.5 * 2.24 + 0.8 * 1.42 + 0.4 * 3);

struct Blend {
  double rotation, edge, exponent, contrast;
};
constexpr std::array<Blend, 4> blends{
    {{1, 0.5, 7, 1.5}, {1, 0.5, 1, 0}, {0.3, 1.0 / 3, 14, 0.5}, {0, 2, 2, 4}}};

vec2<double> tiled_slope(vec2<double> st, const Blend& b) {
  const Tiles tiles = hex_tiles(st, b.rotation, b.edge);
  const vec2<double> deriv[3] = {slopes_of_map(tiles.st[0]), slopes_of_map(tiles.st[1]),
                                 slopes_of_map(tiles.st[2])};
  return hex_derivative(tiles, hex_weights(tiles, deriv, b.exponent, b.contrast), deriv);
}

using Real = long double;

/// A tile by its definition: the vertex's distance decides the weight, its hash the copy of the map.
struct DefinedTile {
  vec2<Real> st;
  Real weight;
  vec2<Real> rotation;
};
DefinedTile define_tile(vec2<Real> st, int i, int j, Real strength, Real edge, vec2<Real> period) {
  const Real height = std::sqrt(0.75L); // of a triangle of side 1
  const vec2<Real> centre{edge * (i + 0.5L * j), edge * height * j};
  const vec2<Real> d = st - centre;
  // The hexagon's sides face 30, 90 and 150 degrees; the weight falls linearly from the centre to them.
  Real farthest = 0;
  for (const vec2<Real> facing : {vec2<Real>{height, 0.5L}, {0, 1}, {-height, 0.5L}})
    farthest = std::max(farthest, std::abs(dot(d, facing)));
  const std::uint32_t shift = lattice_hash<double>(i, j, 0);
  const std::uint32_t turn = lattice_hash<double>(i, j, 1);
  const vec2<Real> offset{period.x * (shift & 0xffffu) / 65536.0L, period.y * (shift >> 16) / 65536.0L};
  const Real angle = strength * ((turn & 0xffffu) / 65536.0L - 0.5L) * 2 * std::numbers::pi_v<Real>;
  const vec2<Real> r{std::cos(angle), std::sin(angle)};
  const vec2<Real> turned{r.x * d.x - r.y * d.y, r.y * d.x + r.x * d.y};
  return {turned + centre + offset, 1 - farthest / (edge * height), r};
}

template <class T>
class HexTiling : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(HexTiling, Precisions);

TYPED_TEST(HexTiling, TilesAreThoseOfTheDefinition) {
  using T = TypeParam;
  constexpr double eps = epsilon_v<T>;
  Random random(87);
  Worst weight("weight");
  Worst coordinate("coordinate");
  Worst rotation("rotation");
  for (long n = 0; n < 100000; ++n) {
    const T strength = static_cast<T>(random.uniform(0, 1));
    const T edge = static_cast<T>(random.magnitude(0.1, 10));
    const double extent = random.magnitude(0.1, 1000);
    const vec2<T> st = narrow<T>(random.vector2(-extent, extent));
    const vec2<T> period{static_cast<T>(random.uniform(0.1, 3)), static_cast<T>(random.uniform(0.1, 3))};
    const HexTiles<T> tiles = hex_tiles(st, strength, edge, period);
    const vec2<Real> p{st.x, st.y};
    const double size = length(widen(st));
    const double weight_bound = 4 * eps * (1 + size / double(edge));
    // Every vertex whose tile reaches the point is among these.
    const int middle_j = static_cast<int>(std::round(p.y / (edge * std::sqrt(0.75L))));
    for (int j = middle_j - 2; j <= middle_j + 2; ++j) {
      const int middle_i = static_cast<int>(std::round(p.x / edge - 0.5L * j));
      for (int i = middle_i - 2; i <= middle_i + 2; ++i) {
        const DefinedTile defined = define_tile(p, i, j, strength, edge, {period.x, period.y});
        if (defined.weight <= weight_bound) continue; // rounding may choose the triangle beyond
        const vec2<double> expected = widen(defined.st);
        const vec2<double> turn = widen(defined.rotation);
        // The slot is the function's choice; neighbours differ in offset and turn.
        const auto distance = [&](int k) {
          return length(widen(tiles.st[k]) - expected) + length(widen(tiles.rotation[k]) - turn);
        };
        int slot = distance(1) < distance(0) ? 1 : 0;
        if (distance(2) < distance(slot)) slot = 2;
        weight.add(double(tiles.weight[slot]), double(defined.weight), weight_bound, n);
        coordinate.add(widen(tiles.st[slot]), expected,
                       4 * eps * (size + double(edge) + length(widen(period))), n);
        rotation.add(widen(tiles.rotation[slot]), turn, 2 * eps, n);
      }
    }
  }
}

TYPED_TEST(HexTiling, WeightsSumToOneEverywhere) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  Random random(88);
  double worst = 0;
  std::vector<vec2<T>> points;
  for (int n = 0; n < 100000; ++n) {
    const double extent = random.magnitude(1e-12, 1e12);
    points.push_back(narrow<T>(random.vector2(-extent, extent)));
  }
  for (const T x : {T(0), -T(0), T(0.25), T(0.5), T(-1e-20), Limits::max(), Limits::lowest(),
                    Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), Limits::denorm_min()})
    for (const T y :
         {T(0), T(0.5), T(-3), T(-1e-20), Limits::infinity(), Limits::quiet_NaN(), Limits::lowest()}) {
      points.push_back({x, y});
      points.push_back({y, x});
    }
  for (const vec2<T>& st : points)
    for (const T edge : {T(0.5), T(1e-12), T(1e12), T(0), T(-1), Limits::quiet_NaN(), Limits::infinity()}) {
      const HexTiles<T> tiles = hex_tiles(st, T(0.7), edge);
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(std::isfinite(tiles.st[k].x) && std::isfinite(tiles.st[k].y)) << st.x << ", " << st.y;
        ASSERT_GE(tiles.weight[k], T(0)) << st.x << ", " << st.y;
        ASSERT_LE(tiles.weight[k], T(1)) << st.x << ", " << st.y;
        const vec2<double> r = widen(tiles.rotation[k]);
        ASSERT_NEAR(dot(r, r), 1, 4 * double(epsilon_v<T>)); // 1.5 ulp of cosine and sine
        sum += static_cast<double>(tiles.weight[k]);
      }
      worst = std::max(worst, std::abs(sum - 1));
    }
  std::printf("  worst |sum - 1|: %.2f eps (seed 88)\n", worst / double(epsilon_v<T>));
  EXPECT_LE(worst, 1.5 * double(epsilon_v<T>)); // one sum and three differences of numbers below 2
}

TYPED_TEST(HexTiling, SharpenedWeightsSumToOneForAnySlopesAndSettings) {
  using T = TypeParam;
  using Limits = std::numeric_limits<T>;
  Random random(89);
  const std::array<T, 9> values{T(0),
                                T(-1),
                                T(1),
                                T(3),
                                T(1000),
                                Limits::max(),
                                Limits::infinity(),
                                -Limits::infinity(),
                                Limits::quiet_NaN()};
  const auto any_of = [&] { return values[static_cast<std::size_t>(random.integer(int(values.size())))]; };
  for (int n = 0; n < 200000; ++n) {
    const HexTiles<T> tiles = hex_tiles(narrow<T>(random.vector2(-20, 20)));
    const vec2<T> deriv[3] = {{any_of(), any_of()}, {any_of(), any_of()}, {any_of(), any_of()}};
    const T exponent = any_of();
    const T contrast = any_of();
    const vec3<T> w = hex_weights(tiles, deriv, exponent, contrast);
    for (const T one : {w.x, w.y, w.z}) ASSERT_TRUE(one >= T(0) && one <= T(1) + epsilon_v<T>) << one;
    ASSERT_NEAR(static_cast<double>(w.x + w.y + w.z), 1, 4 * double(epsilon_v<T>))
        << "case " << n << ", exponent " << exponent << ", contrast " << contrast;
  }
}

/// weight^exponent * (1 + contrast * sine), as printed in the comment.
std::array<double, 3> defined_weights(const std::array<double, 3>& weight, const std::array<double, 3>& slope,
                                      double exponent, double contrast) {
  std::array<double, 3> w{};
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += w[k] = std::pow(weight[k], exponent) * (1 + contrast * std::sin(std::atan(slope[k])));
  for (double& one : w) one /= sum;
  return w;
}

TYPED_TEST(HexTiling, SharpenedWeightsAreThePrintedFormula) {
  using T = TypeParam;
  Random random(90);
  Worst worst("sharpened weight");
  for (long n = 0; n < 100000; ++n) {
    const HexTiles<T> tiles = hex_tiles(narrow<T>(random.vector2(-20, 20)));
    vec2<T> deriv[3];
    std::array<double, 3> slope{};
    std::array<double, 3> weight{};
    for (int k = 0; k < 3; ++k) {
      deriv[k] = narrow<T>(random.magnitude(1e-3, 1e3) * random.vector2());
      slope[k] = length(widen(deriv[k]));
      weight[k] = static_cast<double>(tiles.weight[k]);
    }
    const T exponent = static_cast<T>(random.uniform(1, 20));
    const T contrast = static_cast<T>(random.uniform(0, 5));
    const std::array<double, 3> expected = defined_weights(weight, slope, exponent, contrast);
    const vec3<T> got = hex_weights(tiles, deriv, exponent, contrast);
    const std::array<T, 3> w{got.x, got.y, got.z};
    for (int k = 0; k < 3; ++k) {
      if (expected[k] < 1e-30) continue;
      const double bound = (16 + 2 * double(exponent) * (1 - std::log2(weight[k]))) * double(epsilon_v<T>);
      worst.add(static_cast<double>(w[k]), expected[k], bound * expected[k], n);
    }
  }
}

TEST(HexTiles, NothingJumpsAtABorder) {
  Random random(91);
  for (const Blend& b : blends) {
    // The grid's lines in the coordinates (i, j) are i, j and i + j whole: step across each of them, and
    // across the lines where tiles weigh the same, by `step` to both sides.
    constexpr double step = 1e-9;
    double worst = 0;
    for (int n = 0; n < 60000; ++n) {
      double i = random.uniform(-30, 30);
      double j = random.uniform(-30, 30);
      if (n % 3 == 0) i = std::round(i);
      if (n % 3 == 1) j = std::round(j);
      if (n % 3 == 2) i = std::round(i + j) - j;
      if (n % 7 == 0) i = std::round(i), j = std::round(j); // vertices, where six triangles meet
      const vec2<double> at{b.edge * (i + 0.5 * j), b.edge * std::sqrt(0.75) * j};
      const double angle = random.uniform(-3.15, 3.15);
      const vec2<double> d{b.edge * step * std::cos(angle), b.edge * step * std::sin(angle)};
      worst = std::max(worst, length(tiled_slope(at + d, b) - tiled_slope(at - d, b)));
    }
    // Slopes of the map turn with the tiles. A weight changes by 2 / (sqrt(3) edge) per unit, its power by
    // at most `exponent` times that (times 1 + contrast, and three of them, against slopes below 3); the
    // steeper tile's gain adds contrast times the change of the slope.
    const double change = (1 + 3 * 3 * b.contrast) * steepest_change +
                          3 * 3 * 3 * (1 + b.contrast) * b.exponent * 2 / (std::sqrt(3.0) * b.edge);
    std::printf("  rotation %g, edge %.2f, exponent %g, contrast %g: largest difference across a border %.2g "
                "of %.2g that smoothness allows\n",
                b.rotation, b.edge, b.exponent, b.contrast, worst, change * 2 * step * b.edge);
    EXPECT_LE(worst, change * 2 * step * b.edge);
  }
}

TEST(HexTiles, RotationIsOneAboutTheTile) {
  Random random(92);
  int compared = 0;
  for (int n = 0; n < 20000; ++n) {
    const vec2<double> st = random.vector2(-50, 50);
    const vec2<double> near = st + 0.05 * random.vector2();
    const double strength = random.uniform(0, 1);
    const Tiles a = hex_tiles(st, strength);
    const Tiles b = hex_tiles(near, strength);
    const Tiles still = hex_tiles(st, 0);
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(still.rotation[k].x, 1);
      EXPECT_EQ(still.rotation[k].y, 0);
      // Without a turn only an offset of the map is left, to the bit.
      const vec2<double> offset = still.st[k] - st;
      EXPECT_LT(std::abs(offset.x * 65536 - std::round(offset.x * 65536)), 1e-8);
      // By at most half of `strength` turns.
      EXPECT_GE(a.rotation[k].x, std::cos(std::numbers::pi * strength) - 1e-15);
      // A turn about the tile's centre moves no point farther than its distance from the centre allows.
      EXPECT_LE(length(a.st[k] - still.st[k]), 2 * 0.5 + 1e-9);
      if (a.rotation[k].y != b.rotation[k].y) continue; // another triangle
      ++compared;
      const vec2<double> moved = rotate(near - st, a.rotation[k]);
      EXPECT_NEAR(b.st[k].x - a.st[k].x, moved.x, 1e-13);
      EXPECT_NEAR(b.st[k].y - a.st[k].y, moved.y, 1e-13);
      EXPECT_NEAR(length(rotate_back(moved, a.rotation[k]) - (near - st)), 0, 1e-15);
    }
  }
  EXPECT_GT(compared, 40000);
  // Beyond its range, a strength is its nearest end.
  for (const double strength : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(hex_tiles(vec2<double>{0.3, 0.2}, strength).rotation[0].y, 0);
  EXPECT_EQ(hex_tiles(vec2<double>{0.3, 0.2}, 5.0).rotation[1].y,
            hex_tiles(vec2<double>{0.3, 0.2}, 1.0).rotation[1].y);
}

TEST(HexTiles, ASlopeComesBackAsItIs) {
  Random random(93);
  const vec2<double> slope{0.7, -1.3};
  Worst unturned("slope without rotation");
  Worst turned("slope of a plane that the tiles turn");
  for (long n = 0; n < 20000; ++n) {
    const vec2<double> st = random.vector2(-40, 40);
    for (const Blend& b : blends) {
      // A map of constant slope, tiles only shifted: the slope, whatever the weights.
      const vec2<double> same[3] = {slope, slope, slope};
      const Tiles still = hex_tiles(st, 0, b.edge);
      const vec2<double> got = hex_derivative(still, hex_weights(still, same, b.exponent, b.contrast), same);
      unturned.add(got, slope, 8 * epsilon_v<double> * 2, n);
      // The surface has one slope; each tile sees it in its own, turned coordinates.
      const Tiles tiles = hex_tiles(st, b.rotation, b.edge);
      const vec2<double> seen[3] = {rotate(slope, tiles.rotation[0]), rotate(slope, tiles.rotation[1]),
                                    rotate(slope, tiles.rotation[2])};
      turned.add(hex_derivative(tiles, hex_weights(tiles, seen, b.exponent, b.contrast), seen), slope,
                 16 * epsilon_v<double> * 2, n); // the unit length of the rotations besides
    }
  }
}

TEST(HexTiles, TurnedBackDerivativeIsThatOfTheTiledHeight) {
  Random random(94);
  Worst worst("derivative through a tile");
  const auto height = [](vec2<double> st) {
    return std::sin(5 * st.x) * std::cos(3 * st.y) + 0.4 * st.x * st.y;
  };
  const auto derivative = [](vec2<double> st) {
    return vec2<double>{5 * std::cos(5 * st.x) * std::cos(3 * st.y) + 0.4 * st.y,
                        -3 * std::sin(5 * st.x) * std::sin(3 * st.y) + 0.4 * st.x};
  };
  for (long n = 0; n < 20000; ++n) {
    const vec2<double> st = random.vector2(-3, 3);
    constexpr double h = 1e-5;
    const Tiles at = hex_tiles(st);
    const Tiles right = hex_tiles(st + vec2<double>{h, 0});
    const Tiles left = hex_tiles(st - vec2<double>{h, 0});
    const Tiles above = hex_tiles(st + vec2<double>{0, h});
    const Tiles below = hex_tiles(st - vec2<double>{0, h});
    for (int k = 0; k < 3; ++k) {
      bool same = true; // the slot holds the same tile at every tap
      for (const Tiles* tap : {&right, &left, &above, &below}) same &= tap->rotation[k].y == at.rotation[k].y;
      if (!same) continue;
      const vec2<double> difference{(height(right.st[k]) - height(left.st[k])) / (2 * h),
                                    (height(above.st[k]) - height(below.st[k])) / (2 * h)};
      // h^2 / 6 of third derivatives below 250, and rounding of heights below 10 over h.
      worst.add(rotate_back(derivative(at.st[k]), at.rotation[k]), difference, 2e-8, n);
    }
  }
}

TEST(HexTiles, SteeperTilesPrevail) {
  const vec2<double> st{0.2, 0.2};
  const Tiles tiles = hex_tiles(st);
  double before = -1;
  for (const double slope : {0.0, 0.1, 0.5, 1.0, 10.0, 100.0}) {
    const vec2<double> deriv[3] = {{0.2, 0}, {0, slope}, {0.1, 0.1}};
    const vec3<double> w = hex_weights(tiles, deriv, 4, 1.5);
    EXPECT_GT(w.y, before);
    before = w.y;
    // Without contrast only the place counts; the length of a slope does, not its direction.
    EXPECT_EQ(hex_weights(tiles, deriv, 4, 0).y, hex_weights(tiles, {{0, 0}, {0, 0}, {0, 0}}, 4, 3).y);
    const vec2<double> other[3] = {{0, -0.2}, {-slope, 0}, {0.1, -0.1}};
    EXPECT_EQ(hex_weights(tiles, other, 4, 1.5).y, w.y);
  }
}

TEST(HexTiles, SettingsBeyondTheirRangesAreTheNearestEnd) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Tiles tiles = hex_tiles(vec2<double>{0.2, 0.15});
  const vec2<double> deriv[3] = {{0.2, 0}, {0, 1}, {0.1, 0.1}};
  const auto weight = [&](double exponent, double contrast) {
    return hex_weights(tiles, deriv, exponent, contrast).y;
  };
  for (const double exponent : {0.0, 0.5, -3.0, nan}) EXPECT_EQ(weight(exponent, 1), weight(1, 1));
  EXPECT_EQ(weight(5000, 1), weight(1000, 1));
  for (const double contrast : {-1.0, nan}) EXPECT_EQ(weight(2, contrast), weight(2, 0));
  EXPECT_EQ(weight(2, 1e6), weight(2, 1000));
  EXPECT_NE(weight(2, 1), weight(3, 1));
}

TEST(HexTiles, MixtureKeepsTheDocumentedVariance) {
  // Independent maps of variance 1 mix to the sum of the squared weights.
  constexpr std::array<std::array<double, 2>, 5> documented{
      {{1, 0.50}, {2, 0.66}, {4, 0.80}, {7, 0.88}, {14, 0.94}}};
  for (const auto& [exponent, kept] : documented) {
    Random random(95);
    double sum = 0;
    constexpr int points = 200000;
    for (int n = 0; n < points; ++n) {
      const vec3<double> w =
          hex_weights(hex_tiles(random.vector2(-20, 20)), {{0, 0}, {0, 0}, {0, 0}}, exponent, 0);
      sum += dot(w, w);
    }
    EXPECT_NEAR(sum / points, kept, 0.006) << "exponent " << exponent; // two printed digits
  }
}

TEST(HexTiles, OffsetsAndTurnsAreUniformAndIndependentOfTheNeighbours) {
  constexpr int edge_cells = 300;
  constexpr int bins = 16;
  std::vector<int> offsets(bins * bins);
  std::vector<int> turns(bins * bins);
  std::vector<int> neighbours(bins * bins);
  const auto bin = [](double v) { return static_cast<int>(std::floor((v - std::floor(v)) * bins)); };
  const auto angle = [](vec2<double> r) { return std::atan2(r.y, r.x) / (2 * std::numbers::pi); };
  for (int j = 0; j < edge_cells; ++j)
    for (int i = 0; i < edge_cells; ++i) {
      // Inside the lower triangle of a cell; the first slot is the cell's own vertex.
      const double u = i + 0.3;
      const double v = j + 0.3;
      const vec2<double> st{0.5 * (u + 0.5 * v), 0.5 * std::sqrt(0.75) * v};
      const Tiles still = hex_tiles(st, 0);
      const Tiles tiles = hex_tiles(st);
      const vec2<double> offset = still.st[0] - st + vec2<double>{1e-9, 1e-9}; // not just below a bin
      ++offsets[static_cast<std::size_t>(bin(offset.x) * bins + bin(offset.y))];
      ++turns[static_cast<std::size_t>(bin(angle(tiles.rotation[0]) + 1e-9) * bins + bin(offset.x))];
      const vec2<double> next = still.st[1] - st + vec2<double>{1e-9, 1e-9};
      ++neighbours[static_cast<std::size_t>(bin(offset.x) * bins + bin(next.x))];
    }
  const double expected = edge_cells * edge_cells / double(bins * bins);
  for (const auto* counts : {&offsets, &turns, &neighbours}) {
    double chi_square = 0;
    for (const int n : *counts) chi_square += (n - expected) * (n - expected) / expected;
    std::printf("  chi square of 255 degrees of freedom: %.0f\n", chi_square);
    EXPECT_LT(chi_square, 255 + 5 * 22.6); // five standard deviations, sqrt(2 * 255) each
    EXPECT_GT(chi_square, 255 - 5 * 22.6); // too even is not random either
  }
}

} // namespace
} // namespace surfgrad::test
