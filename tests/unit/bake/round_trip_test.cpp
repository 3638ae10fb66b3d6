// A mesh whose stack is only its own normal map bakes to that map, normalised.

#include "bake/bake.hpp"

#include "source_codes.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include "simd/isa.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// Largest difference of a slope from that of the texels around it, within the slope limit of maps.
double steps_around(const image::Image& source, bool two_channels, int x, int y) {
  const auto slope = [&](int i, int j) {
    const int column = (i + source.width) % source.width;
    const int row = (j + source.height) % source.height;
    const auto n = test::normal_of_texel(source, two_channels, column, row);
    if (!n) return vec2<double>{128, 128}; // as steep as can be, or unlike any
    return vec2<double>{n->x / n->z, n->y / n->z};
  };
  double most = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) most = std::max(most, max_abs(slope(x + i, y + j) - slope(x, y)));
  return most;
}

/// How many codes of 16 bits a float bake may be off. Texture coordinates of the last place 2^-24 are rounded
/// a few times on their way to a position among the texels, where a slope changes by `steps` from one to the
/// next; slopes of 8-bit maps lie in steps of 2^-13; and unlike in double, the result of some dozen roundings
/// is near the border of a code now and then.
double float_bound(const image::Image& source, double steps) {
  const double texels = 4 * 0x1p-24 * std::max(source.width, source.height);
  return 1 + 0.5 * 65535 * (steps * texels + 0x1p-14 + 8 * 0x1p-24);
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
  const Baked in_double = [&] {
    const simd::ForcedIsa forced(simd::Isa::reference);
    return bake(scene, {width, height, Space::tangent});
  }();
  const bool two_channels = channels == 2 || constant_blue;
  int worst = 0;
  int worst_in_double = 0;
  int more = 0;
  int compared = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto n = test::normal_of_texel(source, two_channels, x, y);
      if (!n) continue;
      const int difference = test::code_difference(baked.map, x, y, *n);
      EXPECT_LE(difference, float_bound(source, steps_around(source, two_channels, x, y))) << x << ", " << y;
      worst = std::max(worst, difference);
      more += difference > 1;
      worst_in_double = std::max(worst_in_double, test::code_difference(in_double.map, x, y, *n));
      ++compared;
    }
  const int left_out = width * height - compared;
  std::printf("  %s: worst difference %d codes at 16 bits (%d in double), %d of %d texels more than one, %d "
              "left out\n",
              name, worst, worst_in_double, more, compared, left_out);
  EXPECT_LE(worst_in_double, 1);
  EXPECT_LT(more, compared / 50);
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
