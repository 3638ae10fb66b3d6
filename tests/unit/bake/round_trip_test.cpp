// A mesh whose stack is only its own normal map bakes to that map, normalised.

#include "bake/bake.hpp"

#include "source_codes.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;

constexpr std::uint64_t seed = 191;

/// Texels of every direction and length: x and y anywhere, a few of them with z <= 0 or steeper than
/// the slope limit.
image::Image random_source(Random& random, int width, int height, int channels, image::Depth depth) {
  image::Image source = surfgrad::test::random_image(random, width, height, channels, depth);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (channels == 3 && random.integer(20) != 0)
        source.at(x, y, 2) = surfgrad::test::stored(random.uniform(0.51, 1), depth);
      const vec2<double> m{2.0 * source.at(x, y, 0) - 1, 2.0 * source.at(x, y, 1) - 1};
      if (channels == 2 && dot(m, m) > 0.9) // within the unit disc but for a few
        source.at(x, y, 0) = surfgrad::test::stored(0.5, depth);
    }
  return source;
}

void expect_round_trip(const char* name, const mesh::TriangleMesh& mesh, const mat3<double>& linear,
                       int channels, image::Depth depth, bool constant_blue = false) {
  SCOPED_TRACE(name);
  SCOPED_TRACE(seed);
  Random random(seed);
  constexpr int width = 96;
  constexpr int height = 80;
  image::Image source = random_source(random, width, height, constant_blue ? 2 : channels, depth);
  if (constant_blue) {
    image::Image blue = image::make_image(width, height, 3, depth);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        blue.at(x, y, 0) = source.at(x, y, 0);
        blue.at(x, y, 1) = source.at(x, y, 1);
        blue.at(x, y, 2) = 1;
      }
    source = blue;
  }
  scene::Scene scene = surfgrad::test::scene_of(mesh, linear, {3, -2, 5});
  surfgrad::test::add_image(scene, "own", source);
  scene.materials[0].layers = {surfgrad::test::normal_layer("own")};
  const Baked baked = bake(scene, {width, height, Space::tangent});
  int worst = 0;
  int compared = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto n = test::normal_of_texel(source, channels == 2 || constant_blue, x, y);
      if (!n) continue;
      worst = std::max(worst, test::code_difference(baked.map, x, y, *n));
      ++compared;
    }
  const int left_out = width * height - compared;
  std::printf("  %s: worst difference %d code at 16 bits, %d texels compared, %d left out\n", name, worst,
              compared, left_out);
  EXPECT_LE(worst, 1);
  EXPECT_EQ(baked.covered, width * height);
  EXPECT_EQ(baked.overlapping, 0);
  EXPECT_EQ(baked.singular, 0);
  EXPECT_EQ(baked.degenerate, 0);
  EXPECT_GT(compared, width * height * 8 / 10);
  if (channels == 3 && !constant_blue) {
    EXPECT_GT(left_out, 0) << "the source should hold texels below the surface";
  }
}

const mat3<double> upright = surfgrad::test::scaling({1, 1, 1});

TEST(RoundTrip, OfThreeChannelsAt8And16Bits) {
  const mesh::TriangleMesh torus = surfgrad::test::torus(48, 24);
  expect_round_trip("torus, xyz, 16 bits", torus, upright, 3, image::Depth::unorm16);
  expect_round_trip("torus, xyz, 8 bits", torus, upright, 3, image::Depth::unorm8);
  expect_round_trip("sphere, xyz, 16 bits", surfgrad::test::sphere_band(24, 16), upright, 3,
                    image::Depth::unorm16);
}

TEST(RoundTrip, OfTwoChannelsAt8And16Bits) {
  const mesh::TriangleMesh torus = surfgrad::test::torus(48, 24);
  expect_round_trip("torus, xy, 16 bits", torus, upright, 2, image::Depth::unorm16);
  expect_round_trip("torus, xy, 8 bits", torus, upright, 2, image::Depth::unorm8);
  expect_round_trip("torus, xy and constant blue, 8 bits", torus, upright, 3, image::Depth::unorm8, true);
}

TEST(RoundTrip, OfMirroredTextureCoordinates) {
  mesh::TriangleMesh mirrored = surfgrad::test::torus(48, 24);
  for (vec2<float>& st : mirrored.uv_sets[0]) st.x = 1 - st.x;
  expect_round_trip("mirrored torus", mirrored, upright, 3, image::Depth::unorm16);
  expect_round_trip("half mirrored torus", surfgrad::test::half_mirrored_torus(48, 24), upright, 3,
                    image::Depth::unorm16);
}

TEST(RoundTrip, UnderTransformsThatTurnStretchAndMirror) {
  Random random(192);
  const mat3<double> turn = random.rotation();
  const mesh::TriangleMesh torus = surfgrad::test::half_mirrored_torus(48, 24);
  expect_round_trip("turned and stretched", torus, turn * surfgrad::test::scaling({2, 0.5, 1}), 3,
                    image::Depth::unorm16);
  expect_round_trip("mirrored object", torus, turn * surfgrad::test::scaling({-1, 1, 1}), 3,
                    image::Depth::unorm16);
  expect_round_trip("tiny", torus, surfgrad::test::scaling({1e-6, 1e-6, 1e-6}), 3, image::Depth::unorm16);
}

} // namespace
} // namespace surfgrad::bake
