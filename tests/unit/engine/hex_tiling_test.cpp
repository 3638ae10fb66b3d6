// Maps on hex tiles: slopes and heights agree with the tiles' geometry, nothing jumps, nothing repeats.

#include "engine/bump_map.hpp"
#include "lab.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdio>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Worst;
using test::composed;
using test::Random;

std::shared_ptr<const image::Map> shared(image::Map map) {
  return std::make_shared<const image::Map>(std::move(map));
}

std::shared_ptr<const image::Map> random_slopes(Random& random, int width, int height) {
  const image::Image image = surfgrad::test::random_normal_map(random, width, height, 0.8);
  return shared(image::make_slope_map(image, image::NormalChannels::xyz, true).map);
}

image::Image random_heights(Random& random, int width, int height) {
  return surfgrad::test::random_image(random, width, height, 1);
}

TiledMap hex(std::shared_ptr<const image::Map> map, double turn = 1) {
  TiledMap tiled{.map = std::move(map)};
  tiled.hex_turn = turn;
  return tiled;
}

constexpr vec2<double> no_footprint{0, 0};

vec2<double> slopes_at(const TiledMap& tiled, vec2<double> st) {
  return sample_slopes(tiled, st, no_footprint, no_footprint);
}

/// Whether two points lie in the same triangle of the grid, so that a slot holds the same tile at both.
bool same_tiles(TiledMap tiled, vec2<double> a, vec2<double> b) {
  tiled.hex_turn = 1; // tells tiles apart
  const HexTiles<double> at_a = hex_map_tiles(tiled, a).hex;
  const HexTiles<double> at_b = hex_map_tiles(tiled, b).hex;
  bool same = true;
  for (int k = 0; k < 3; ++k)
    same &= at_a.rotation[k].x == at_b.rotation[k].x && at_a.rotation[k].y == at_b.rotation[k].y;
  return same;
}

/// What the tile does to a small step, from where it reads the map: no use of its rotation.
struct Jacobian {
  vec2<double> of_s, of_t; // change of tile.st per change of st'
};
std::optional<Jacobian> jacobian(const TiledMap& tiled, vec2<double> st, int k) {
  constexpr double h = 1e-4;
  const vec2<double> right = st + vec2<double>{h, 0};
  const vec2<double> above = st + vec2<double>{0, h};
  if (!same_tiles(tiled, st, right) || !same_tiles(tiled, st, above)) return std::nullopt;
  const auto reads = [&](vec2<double> at) { return hex_map_tiles(tiled, at).tile[k].st; };
  return Jacobian{(1 / h) * (reads(right) - reads(st)), (1 / h) * (reads(above) - reads(st))};
}

TEST(HexTiling, TilesAreTurnedAndNotShearedWhereTexelsAreSquare) {
  Random random(511);
  Worst lengths("length of a step in texels");
  Worst steps("step in a tile");
  Worst levels("level of detail in a tile");
  long compared = 0;
  for (const vec2<double> size : {vec2<double>{16, 16}, {32, 8}, {6, 20}}) {
    const TiledMap tiled = hex(random_slopes(random, static_cast<int>(size.x), static_cast<int>(size.y)));
    for (long n = 0; n < 2000; ++n) {
      const vec2<double> st = random.vector2(-20, 20);
      const HexMapTiles<double> tiles = hex_map_tiles(tiled, st);
      for (int k = 0; k < 3; ++k) {
        const std::optional<Jacobian> j = jacobian(tiled, st, k);
        if (!j) continue;
        ++compared;
        const vec2<double> dx = 0.1 * random.vector2();
        const vec2<double> dy = 0.1 * random.vector2();
        const vec2<double> turned = in_tile(tiles.tile[k], dx);
        steps.add(turned, dx.x * j->of_s + dx.y * j->of_t, 1e-9, n); // positions of 20 over steps of 1e-4
        lengths.add(length(size * turned), length(size * dx), 1e-12, n);
        levels.add(texture_lod(turned, in_tile(tiles.tile[k], dy), size), texture_lod(dx, dy, size), 1e-12,
                   n);
      }
    }
  }
  EXPECT_GT(compared, 15000);
}

TEST(HexTiling, SlopesOfAPlaneInEveryTileComeBackTurned) {
  // Each tile shows the same tilted plane, turned: equally steep, so that contrast does not count.
  const vec2<double> slope{0.75, -0.25};
  Random random(512);
  Worst worst("slope");
  for (const int height : {8, 24}) {
    image::Image image = image::make_image(8, height, 2, image::Depth::float32);
    for (std::size_t i = 0; i < image.texels.size(); i += 2) {
      image.texels[i] = static_cast<float>(slope.x);
      image.texels[i + 1] = static_cast<float>(slope.y);
    }
    const auto map = shared(image::make_derivative_map(image, 1, true));
    const vec2<double> side{1, height / 8.0};
    for (const double turn : {0.0, 0.2, 1.0})
      for (long n = 0; n < 2000; ++n) {
        const TiledMap tiled = hex(map, turn);
        const vec2<double> st = random.vector2(-20, 20);
        const HexMapTiles<double> tiles = hex_map_tiles(tiled, st);
        const vec3<double> w = weights_by_place(tiles.hex);
        const double weight[3] = {w.x, w.y, w.z};
        vec2<double> expected{0, 0};
        bool complete = true;
        for (int k = 0; k < 3; ++k) {
          const std::optional<Jacobian> j = jacobian(tiled, st, k);
          complete &= j.has_value();
          // The chain rule where texels are square.
          if (j)
            expected = expected + weight[k] * vec2<double>{dot(slope, side * j->of_s) / side.x,
                                                           dot(slope, side * j->of_t) / side.y};
        }
        if (!complete) continue;
        worst.add(slopes_at(tiled, st), expected, 1e-9, n); // differences over 1e-4 of coordinates of 20
        if (turn == 0) {
          EXPECT_NEAR(slopes_at(tiled, st).x, slope.x, 1e-15);
          EXPECT_NEAR(slopes_at(tiled, st).y, slope.y, 1e-15);
        }
      }
  }
}

/// Any way to lay a map.
TiledMap laid_anyhow(Random& random, TiledMap tiled) {
  tiled.tile = {random.sign() * random.uniform(0.5, 3), random.sign() * random.uniform(0.5, 3)};
  const double angle = random.uniform(-3, 3);
  tiled.rotation = {std::cos(angle), std::sin(angle)};
  tiled.offset = random.vector2();
  tiled.hex_turn = random.uniform(0, 1);
  return tiled;
}

struct HeightCase {
  HeightMap layer;
  raster::Fragment<double> fragment;
  HexMapTiles<double> here, right, above; ///< tiles at the pixel and its two neighbours
  vec3<double> weights;                   ///< of the pixel
};

/// A pixel of a hex-tiled height map whose neighbours show the same tiles.
HeightCase random_height_case(Random& random, double pixel) {
  HeightCase c;
  const int width = 4 + 2 * random.integer(6);
  const auto heights = shared(image::make_height_map(random_heights(random, width, 12), 0));
  for (;;) {
    c.layer.texture.tiled = laid_anyhow(random, hex(heights));
    c.fragment = test::random_fragment(random);
    raster::UvFragment<double>& uv = c.fragment.uvs[0];
    uv.dst_dx = pixel * uv.dst_dx;
    uv.dst_dy = pixel * uv.dst_dy;
    uv.footprint_dx = uv.dst_dx;
    uv.footprint_dy = uv.dst_dy;
    const TiledMap& tiled = c.layer.texture.tiled;
    const vec2<double> here = map_coordinate(tiled, uv.st);
    const vec2<double> right = map_coordinate(tiled, uv.st + uv.dst_dx);
    const vec2<double> above = map_coordinate(tiled, uv.st + uv.dst_dy);
    if (!same_tiles(tiled, here, right) || !same_tiles(tiled, here, above)) continue;
    c.here = hex_map_tiles(tiled, here);
    c.right = hex_map_tiles(tiled, right);
    c.above = hex_map_tiles(tiled, above);
    c.weights = weights_by_place(c.here.hex);
    return c;
  }
}

TEST(HexTiling, ThreeTapsAreDifferencesOfTheTiledHeight) {
  Random random(513);
  Worst worst("change of the height per pixel");
  for (long n = 0; n < 2000; ++n) {
    const HeightCase c = random_height_case(random, random.magnitude(0.1, 10));
    const TiledMap& tiled = c.layer.texture.tiled;
    const double lod = level_of_detail(tiled, c.fragment.uvs[0].footprint_dx, c.fragment.uvs[0].footprint_dy);
    const auto height = [&](const HexMapTiles<double>& tiles) {
      const auto at = [&](int k) { return sample_at<1>(tiled, tiles.tile[k].st, lod)[0]; };
      return c.weights.x * at(0) + c.weights.y * at(1) + c.weights.z * at(2);
    };
    const vec2<double> expected{height(c.right) - height(c.here), height(c.above) - height(c.here)};
    worst.add(height_per_pixel(c.layer, c.fragment), expected, 1e-12, n); // coordinates of 10, 16 texels
    // The value that a displacement would use is the blend of the same tiles.
    EXPECT_NEAR(sample<1>(c.layer.texture, c.fragment)[0], height(c.here), 1e-12);
  }
}

TEST(HexTiling, SmoothHeightsHaveTheSlopeOfTheTiledSpline) {
  Random random(514);
  Worst worst("slope of the spline per pixel");
  for (long n = 0; n < 2000; ++n) {
    constexpr double pixel = 1e-4; // of footprints of 0.02
    HeightCase c = random_height_case(random, pixel);
    const TiledMap& tiled = c.layer.texture.tiled;
    c.layer.smooth = tiled.map;
    const auto height = [&](const HexMapTiles<double>& tiles) {
      const auto at = [&](int k) {
        return image::sample_bicubic(*tiled.map, tiles.tile[k].st, tiled.wrap, true).value;
      };
      return c.weights.x * at(0) + c.weights.y * at(1) + c.weights.z * at(2);
    };
    const vec2<double> expected{height(c.right) - height(c.here), height(c.above) - height(c.here)};
    // A step of 2e-6 is one of 9.6e-5 texels for a tile of 3 and 16 texels; half its square times the
    // spline's second derivative, below 4 per texel^2.
    worst.add(height_per_pixel(c.layer, c.fragment), expected, 2 * 9.2e-9, n);
  }
}

TEST(HexTiling, ProjectedHeightsHaveTheSlopeOfTheTiledHeights) {
  // A wave of 64 texels: three taps and central differences see about the same slope.
  Random random(515);
  image::Image image = image::make_image(64, 128, 1, image::Depth::float32);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 64; ++x)
      image.at(x, y, 0) = static_cast<float>(std::sin(2 * 3.14159265358979324 * (x + 0.5) / 64) +
                                             std::cos(2 * 3.14159265358979324 * (y + 0.5) / 128));
  const auto heights = shared(image::make_height_map(image, 0));
  const auto slopes = shared(image::make_height_slopes(image, 0, {}));
  Worst worst("slope");
  for (long n = 0; n < 2000; ++n) {
    HeightMap taps;
    taps.texture.tiled = laid_anyhow(random, hex(heights));
    BumpMap bumps{taps.texture.tiled, true, 1};
    bumps.tiled.map = slopes;
    raster::Fragment<double> f = test::random_fragment(random);
    raster::UvFragment<double>& uv = f.uvs[0];
    uv.dst_dx = uv.footprint_dx = {0.002, 0};
    uv.dst_dy = uv.footprint_dy = {0, 0.002};
    const vec2<double> got = derivative(bumps, uv.st, no_footprint, no_footprint);
    const vec2<double> expected = (1 / 0.002) * height_per_pixel(taps, f);
    // The wave's slope by the map changes by 4 pi^2 / 64 a texel. The taps see a chord within a texel, half a
    // texel away at most, or across two, over a step of 0.4: within 1.5 texels, times a tile of 3.
    worst.add(got, expected, 3 * 1.5 * 6.3 * 6.3 / 64, n);
    // The scale-free layer sees the same slopes; its tile's size does not count.
    HeightMap scale_free = taps;
    scale_free.texture.tiled.map = bumps.tiled.map;
    scale_free.kind = HeightMap::Kind::scale_free;
    TiledMap unit = bumps.tiled;
    const vec2<double> by_map = sample_height_slopes(unit, uv.st, uv.footprint_dx, uv.footprint_dy);
    const vec2<double> square{by_map.x, by_map.y / 2};
    const vec2<double> along = along_coordinate(unit, square);
    EXPECT_NEAR(scale_free_slope(scale_free, f).x, along.x, 1e-12);
    EXPECT_NEAR(scale_free_slope(scale_free, f).y, along.y, 1e-12);
  }
}

TEST(HexTiling, NothingJumpsWhereTilesMeet) {
  Random random(516);
  test::Lab lab;
  lab.add("normals", surfgrad::test::random_normal_map(random, 8, 8, 0.5));
  lab.add("mask", surfgrad::test::random_image(random, 8, 8, 1));
  lab.add("heights", random_heights(random, 8, 8));
  stack::NormalMapLayer normals = test::normal_layer("normals");
  normals.map.tiling = stack::Tiling::hex;
  stack::NormalMapLayer masked = test::normal_layer("normals", 0, stack::Basis::derived);
  masked.common.mask = test::mask_of("mask");
  masked.common.mask->tiling = stack::Tiling::hex;
  stack::HeightMapLayer bicubic = test::height_layer("heights", 0.02);
  bicubic.taps = stack::Taps::bicubic;
  bicubic.map.tiling = stack::Tiling::hex;
  stack::HeightMapLayer taps = test::height_layer("heights", 0.02);
  taps.map.tiling = stack::Tiling::hex;
  stack::HeightMapLayer scale_free = test::height_layer("heights", 0.1, stack::HeightMode::scale_free);
  scale_free.map.tiling = stack::Tiling::hex;
  const std::vector<std::pair<const char*, stack::Layer>> kinds{{"normal_map", normals},
                                                                {"mask", masked},
                                                                {"bicubic heights", bicubic},
                                                                {"three taps", taps},
                                                                {"scale-free heights", scale_free}};
  for (const auto& [name, layer] : kinds) {
    const Program program = lab.compile({layer});
    constexpr double step = 1e-9;
    double worst = 0;
    double typical = 0;
    constexpr int points = 3000;
    for (int n = 0; n < points; ++n) {
      // The grid's lines have i, j or i + j whole in units of half a period.
      double i = random.uniform(-30, 30);
      double j = random.uniform(-30, 30);
      if (n % 3 == 0) i = std::round(i);
      if (n % 3 == 1) j = std::round(j);
      if (n % 3 == 2) i = std::round(i + j) - j;
      if (n % 7 == 0) i = std::round(i), j = std::round(j);
      raster::Fragment<double> f = test::random_fragment(random);
      // A surface as steep for every fragment: a pixel is 0.02 of the coordinate.
      f.normal = {0, 0, 1};
      f.dp_dx = {0.02, 0, 0};
      f.dp_dy = {0, 0.02, 0};
      raster::UvFragment<double>& uv = f.uvs[0];
      uv.dst_dx = uv.footprint_dx = {0.02, 0};
      uv.dst_dy = uv.footprint_dy = {0, 0.02};
      uv.tangent = {1, 0, 0};
      uv.sign = 1;
      const vec2<double> at{0.5 * (i + 0.5 * j), 0.5 * std::sqrt(0.75) * j};
      const vec2<double> d = step * random.vector2();
      uv.st = at + d;
      const vec3<double> there = composed(program, f).surfgrad;
      uv.st = at - d;
      const vec3<double> here = composed(program, f).surfgrad;
      worst = std::max(worst, length(there - here));
      typical += length(here) / points;
    }
    // Within 8 texels slopes of +-0.5 change by less than 16 per unit, three tiles' weights by less than
    // 3 * 7 * 2.31 (the exponent times the slope of a weight); a contrast of 1.5 multiplies both by 2.5 at
    // most, and gradients are longer than slopes are steep by less than 4.
    std::printf("  %s: largest change across a border %.2g of slopes of %.2g\n", name, worst, typical);
    EXPECT_GT(typical, 0.01) << name;
    EXPECT_LE(worst, 600 * 2 * step) << name;
  }
}

/// Correlation of the slopes with themselves a shift further, over many periods; 1 where they repeat.
double correlation(const TiledMap& tiled, vec2<double> shift, Random& random) {
  double product = 0;
  double power = 0;
  for (int n = 0; n < 40000; ++n) {
    const vec2<double> st = random.vector2(-40, 40);
    const vec2<double> a = slopes_at(tiled, st);
    const vec2<double> b = slopes_at(tiled, st + shift);
    product += dot(a, b);
    power += 0.5 * (dot(a, a) + dot(b, b));
  }
  return product / power;
}

TEST(HexTiling, HidesThePeriod) {
  Random random(517);
  const auto map = random_slopes(random, 32, 32);
  for (const vec2<double> shift : {vec2<double>{1, 0}, {0, 1}, {2, 0}, {3, 1}, {0.5, 0}}) {
    const double plain = correlation({.map = map}, shift, random);
    const double turned = correlation(hex(map), shift, random);
    const double shifted = correlation(hex(map, 0), shift, random);
    std::printf("  correlation %g, %g periods further: plain %.3f, hex %.3f, hex without turns %.3f\n",
                shift.x, shift.y, plain, turned, shifted);
    if (shift.x != 0.5) {
      EXPECT_NEAR(plain, 1, 1e-9); // whole periods
    }
    // A tile is one period across: nothing is left but chance, 4 / sqrt(tiles of 1600 periods * 4).
    EXPECT_LE(std::abs(turned), 0.05);
    EXPECT_LE(std::abs(shifted), 0.05);
  }
}

TEST(HexTiling, KeepsTheSurfaceLevelAndItsReliefStrong) {
  Random random(518);
  const auto map = shared(image::make_height_slopes(random_heights(random, 32, 32), 0, {}));
  const auto statistics = [&](const TiledMap& tiled) {
    vec2<double> mean{0, 0};
    double square = 0;
    constexpr int points = 60000;
    for (int n = 0; n < points; ++n) {
      const vec2<double> slope = slopes_at(tiled, random.vector2(-40, 40));
      mean = mean + (1.0 / points) * slope;
      square += dot(slope, slope) / points;
    }
    return std::pair{length(mean), std::sqrt(square)};
  };
  const auto [plain_mean, plain_size] = statistics({.map = map});
  const auto [hex_mean, hex_size] = statistics(hex(map));
  std::printf("  mean slope of a level map over its size: plain %.2g, hex %.2g; size against plain: %.3f\n",
              plain_mean / plain_size, hex_mean / hex_size, hex_size / plain_size);
  // 60000 samples leave 1 / sqrt(60000) = 0.004 of chance.
  EXPECT_LE(hex_mean / hex_size, 0.016);
  // The core documents 0.88 of the variance; the steeper tiles prevail besides.
  EXPECT_GE(hex_size / plain_size, std::sqrt(0.88) - 0.01);
  EXPECT_LE(hex_size / plain_size, 1.1);
}

TEST(HexTiling, PacksEqualOneLaneBitForBit) {
  using simd::emulated_width;
  using simd::EmulatedFloat;
  Random random(519);
  const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
  const auto slopes = random_slopes(random, 16, 8);
  const auto heights = shared(image::make_height_map(random_heights(random, 8, 16), 0));
  for (int n = 0; n < 500; ++n) {
    const TiledMap of_slopes = laid_anyhow(random, hex(slopes));
    TiledMap of_heights = of_slopes;
    of_heights.map = heights;
    vec2<EmulatedFloat> st{}, dx{}, dy{};
    std::array<vec2<float>, emulated_width> one_st{}, one_dx{}, one_dy{};
    const auto fill = [&](vec2<EmulatedFloat>& pack, auto& one, double size) {
      for (int i = 0; i < emulated_width; ++i) {
        const vec2<double> v = size * random.vector2();
        auto& lane = one[static_cast<std::size_t>(i)];
        lane = {static_cast<float>(v.x), static_cast<float>(v.y)};
        pack.x.lane[i] = lane.x;
        pack.y.lane[i] = lane.y;
      }
    };
    fill(st, one_st, n % 50 == 0 ? 1e8 : 10);
    fill(dx, one_dx, 0.1);
    fill(dy, one_dy, 0.1);
    const vec2<EmulatedFloat> slope = sample_slopes(of_slopes, st, dx, dy);
    const vec2<EmulatedFloat> derivatives = sample_height_slopes(of_slopes, st, dx, dy);
    const EmulatedFloat value = sample<1>(of_heights, st, dx, dy)[0];
    for (int i = 0; i < emulated_width; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const vec2<float> one = sample_slopes(of_slopes, one_st[k], one_dx[k], one_dy[k]);
      const vec2<float> derivative = sample_height_slopes(of_slopes, one_st[k], one_dx[k], one_dy[k]);
      EXPECT_EQ(bits(slope.x.lane[i]), bits(one.x));
      EXPECT_EQ(bits(slope.y.lane[i]), bits(one.y));
      EXPECT_EQ(bits(derivatives.x.lane[i]), bits(derivative.x));
      EXPECT_EQ(bits(derivatives.y.lane[i]), bits(derivative.y));
      EXPECT_EQ(bits(value.lane[i]), bits(sample<1>(of_heights, one_st[k], one_dx[k], one_dy[k])[0]));
    }
  }
}

TEST(HexTiling, PlainMapsAreReadAsTheyLie) {
  Random random(520);
  const TiledMap tiled{.map = random_slopes(random, 16, 8)};
  for (int n = 0; n < 500; ++n) {
    const vec2<float> st{static_cast<float>(random.uniform(-9, 9)),
                         static_cast<float>(random.uniform(-9, 9))};
    const vec2<float> dx{static_cast<float>(random.uniform(-1, 1)), 0};
    const float lod = level_of_detail(tiled, dx, dx);
    const auto texel = image::sample<2>(*tiled.map, st, lod, tiled.wrap, tiled.filter, true);
    EXPECT_EQ(sample_slopes(tiled, st, dx, dx).x, texel[0]);
    EXPECT_EQ(sample_height_slopes(tiled, st, dx, dx).y, texel[1]);
    EXPECT_EQ((sample<2>(tiled, st, dx, dx)), texel);
  }
}

TEST(HexTiling, AnyCoordinateGivesAFiniteSlope) {
  Random random(521);
  const TiledMap tiled = hex(random_slopes(random, 16, 8));
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const double x : {0.0, -0.0, 0.25, 1e9, -1e300, inf, -inf, std::nan("")})
    for (const double y : {0.0, 0.5, 1e300, -inf, std::nan("")}) {
      const vec2<double> slope = slopes_at(tiled, {x, y});
      EXPECT_TRUE(std::isfinite(slope.x) && std::isfinite(slope.y)) << x << ", " << y;
      const double nan = std::nan("");
      const vec2<double> far = sample_slopes<double>(tiled, vec2<double>{x, y}, {nan, inf}, {0, nan});
      EXPECT_TRUE(std::isfinite(far.x) && std::isfinite(far.y)) << x << ", " << y;
    }
}

} // namespace
} // namespace surfgrad::engine
