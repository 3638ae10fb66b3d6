// Filters of laid maps: probes lie where the footprint does, and encoded normals are filtered as such.

#include "engine/bump_map.hpp"
#include "lab.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Worst;
using test::Random;

std::shared_ptr<const image::Map> shared(image::Map map) {
  return std::make_shared<const image::Map>(std::move(map));
}

image::Image normals(Random& random) { return surfgrad::test::random_normal_map(random, 64, 32, 1.5); }

TEST(Filters, AnisotropicProbesLieAlongTheFootprintHoweverTheMapLies) {
  constexpr std::uint64_t seed = 611;
  SCOPED_TRACE(seed);
  Random random(seed);
  TiledMap tiled{.map = shared(image::make_slope_map(normals(random), image::NormalChannels::xyz, true).map)};
  const auto weights = shared(image::make_channel_map(surfgrad::test::random_image(random, 64, 32, 1), 0));
  Worst slopes("anisotropic slopes"), values("anisotropic weights"), of_heights("anisotropic height slopes");
  for (long k = 0; k < 500; ++k) {
    const double turn = random.uniform(-3, 3);
    tiled.rotation = {std::cos(turn), std::sin(turn)};
    tiled.tile = {random.sign() * random.uniform(0.5, 4), random.sign() * random.uniform(0.5, 4)};
    tiled.offset = random.vector2(-1, 1);
    tiled.wrap = k % 2 == 0 ? image::Wraps{} : image::Wraps{image::Wrap::mirror, image::Wrap::clamp};
    tiled.anisotropy = 8;
    TiledMap trilinear = tiled;
    trilinear.anisotropy = 1;
    // A footprint eight times as long as it is wide where texels are square, wherever it points: the steps of
    // the plane that become those of the map.
    const double length = random.uniform(8, 40), angle = random.uniform(-3, 3);
    const vec2<double> texels{std::cos(angle), std::sin(angle)};
    const auto step = [&](vec2<double> in_texels) {
      const vec2<double> s{in_texels.x / 64, in_texels.y / 32};
      const vec2<double> r = tiled.rotation;
      return vec2<double>{(r.x * s.x + r.y * s.y) / tiled.tile.x, (r.x * s.y - r.y * s.x) / tiled.tile.y};
    };
    const vec2<double> along = step(length * texels);
    const vec2<double> across = step((length / 8) * vec2<double>{-texels.y, texels.x});
    vec2<double> slope{0, 0}, rise{0, 0};
    double value = 0;
    const vec2<double> st = random.vector2(-1, 1);
    TiledMap mask = tiled, plain_mask = trilinear;
    mask.map = plain_mask.map = weights;
    for (int probe = 0; probe < 8; ++probe) {
      const vec2<double> at = st + ((probe + 0.5) / 8 - 0.5) * along;
      slope = slope + 0.125 * sample_slopes(trilinear, at, across, across);
      rise = rise + 0.125 * sample_height_slopes(trilinear, at, across, across);
      value += 0.125 * sample<1>(plain_mask, at, across, across)[0];
    }
    // Rounding of coordinates of size 10 in texels, 64 * 20 eps, over texels that differ by up to 3.
    slopes.add(sample_slopes(tiled, st, along, across), slope, 1e-11, k);
    of_heights.add(sample_height_slopes(tiled, st, along, across), rise, 1e-11, k);
    values.add(sample<1>(mask, st, along, across)[0], value, 1e-11, k);
  }
}

TEST(Filters, AnisotropicHexTilesTurnTheFootprintWithThem) {
  constexpr std::uint64_t seed = 612;
  SCOPED_TRACE(seed);
  Random random(seed);
  TiledMap tiled{.map = shared(image::make_channel_map(surfgrad::test::random_image(random, 64, 32, 1), 0))};
  tiled.hex_turn = 1;
  tiled.anisotropy = 16;
  TiledMap trilinear = tiled;
  trilinear.anisotropy = 1;
  Worst worst("anisotropic hex tiles");
  for (long k = 0; k < 500; ++k) {
    const double length = random.uniform(8, 20), angle = random.uniform(-3, 3);
    const vec2<double> along{length / 64 * std::cos(angle), length / 32 * std::sin(angle)};
    const vec2<double> across{-length / 256 * std::sin(angle), length / 128 * std::cos(angle)};
    const vec2<double> st = random.vector2(-3, 3);
    // The same tiles all over the footprint: it is small, and their corners are rare.
    const HexMapTiles<double> tiles = hex_map_tiles(tiled, st);
    const vec3<double> w = weights_by_place(tiles.hex);
    double expected = 0;
    for (int t = 0; t < 3; ++t) {
      double sum = 0;
      for (int probe = 0; probe < 4; ++probe) {
        const vec2<double> at = tiles.tile[t].st + in_tile(tiles.tile[t], ((probe + 0.5) / 4 - 0.5) * along);
        sum += 0.25 * sample_at<1>(trilinear, at, level_of_detail(tiled, across, across))[0];
      }
      expected += (t == 0 ? w.x : t == 1 ? w.y : w.z) * sum;
    }
    worst.add(sample<1>(tiled, st, along, across)[0], expected, 1e-11, k);
  }
}

TEST(Filters, OfEncodedNormalsAverageTheCodesAndThenTakeTheSlope) {
  constexpr std::uint64_t seed = 613;
  SCOPED_TRACE(seed);
  Random random(seed);
  const image::Image image = normals(random);
  // The codes as a map of values: one channel at a time.
  std::vector<std::shared_ptr<const image::Map>> channels;
  for (int c = 0; c < 3; ++c) channels.push_back(shared(image::make_channel_map(image, c)));
  for (const auto kind : {image::NormalChannels::xyz, image::NormalChannels::xy})
    for (const bool green_up : {true, false}) {
      Worst worst("slope of filtered normals");
      TiledMap tiled{.map = shared(image::make_encoded_map(image, kind, green_up).map)};
      ASSERT_EQ(tiled.map->components, kind == image::NormalChannels::xyz ? 3 : 2);
      for (long k = 0; k < 500; ++k) {
        const vec2<double> st = random.vector2(-2, 2), dx = random.vector2(-0.1, 0.1);
        double n[3];
        for (std::size_t c = 0; c < 3; ++c) {
          TiledMap channel = tiled;
          channel.map = channels[c];
          n[c] = 2 * sample<1>(channel, st, dx, dx)[0] - 1;
        }
        if (!green_up) n[1] = -n[1];
        const vec2<double> expected = kind == image::NormalChannels::xyz
                                          ? derivative_from_normal(vec3<double>{n[0], n[1], n[2]})
                                          : derivative_from_normal(vec2<double>{n[0], n[1]});
        // Weights are rounded to 2^-17 on coarser levels, components to twice that; z is at least 0.4, slopes
        // at most 1.5 each: (1 + 1.5) / 0.4 times it, and as much again for a reconstructed z.
        worst.add(sample_slopes(tiled, st, dx, dx), expected, 2 * 2.5 / 0.4 * 0x1p-16, k);
      }
    }
}

TEST(Filters, OfEncodedNormalsFlattenWhatSlopesKeep) {
  // Half the texels lean by 60 degrees, half are flat: slopes average to half of the slope, normals to less.
  image::Image image = image::make_image(2, 1, 3, image::Depth::float32);
  const double lean = std::sqrt(3.0) / 2;
  image.texels = {static_cast<float>(0.5 - 0.5 * lean), 0.5f, 0.75f, 0.5f, 0.5f, 1.0f};
  const vec2<double> far{4, 4};
  const TiledMap slopes{.map = shared(image::make_slope_map(image, image::NormalChannels::xyz, true).map)};
  const TiledMap codes{.map = shared(image::make_encoded_map(image, image::NormalChannels::xyz, true).map)};
  EXPECT_NEAR(sample_slopes(slopes, vec2<double>{0.5, 0.5}, far, far).x, std::sqrt(3.0) / 2, 1e-6);
  EXPECT_NEAR(sample_slopes(codes, vec2<double>{0.5, 0.5}, far, far).x, lean / 1.5, 1e-6);
}

TEST(Filters, OfADocumentReachTheLayers) {
  Random random(614);
  test::Lab lab;
  lab.add("n", normals(random));
  stack::NormalMapLayer layer = test::normal_layer("n", 0, stack::Basis::derived);
  const auto map_of = [&] {
    const Program program = lab.compile({layer});
    return std::get<NormalMap>(program.layers.front()).texture.tiled;
  };
  EXPECT_EQ(map_of().anisotropy, 1);
  EXPECT_FALSE(map_of().map->encoded);
  layer.map.filter = stack::Filter::anisotropic;
  layer.map.anisotropy = 5;
  EXPECT_EQ(map_of().anisotropy, 5);
  layer.map.filter = stack::Filter::normal;
  EXPECT_EQ(map_of().anisotropy, 1);
  EXPECT_TRUE(map_of().map->encoded);
}

} // namespace
} // namespace surfgrad::engine
