// Several samples a texel.

#include "bake/bake.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;

scene::Scene bumped() {
  Random random(1731);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(24, 12));
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, 64, 64));
  scene.materials[0].layers = {surfgrad::test::normal_layer("a")};
  return scene;
}

vec3<double> vector_at(const image::Image& map, int x, int y) {
  return {2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1};
}

TEST(Samples, AreTheMeanOfAFinerBakesSlopesOrNormals) {
  const scene::Scene scene = bumped();
  constexpr int width = 50;
  constexpr int height = 37;
  for (const Space space : {Space::tangent, Space::object, Space::world})
    for (const int samples : {2, 3, 7}) {
      const Baked coarse =
          bake(scene, {.width = width, .height = height, .space = space, .samples = samples});
      const Baked fine = bake(scene, {.width = samples * width, .height = samples * height, .space = space});
      EXPECT_EQ(coarse.covered, width * height);
      EXPECT_EQ(coarse.samples, fine.covered);
      double worst = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          vec3<double> sum{0, 0, 0};
          for (int j = 0; j < samples; ++j)
            for (int i = 0; i < samples; ++i) {
              const vec3<double> n = vector_at(fine.map, samples * x + i, samples * y + j);
              sum = sum + (space == Space::tangent ? vec3<double>{n.x / n.z, n.y / n.z, 1.0} : n);
            }
          worst = std::max(worst, max_abs(vector_at(coarse.map, x, y) - normalize_or_zero(sum)));
        }
      std::printf("  space %d, %d samples a side: worst difference %.2g\n", static_cast<int>(space), samples,
                  worst);
      // Codes of floats are off by 2^-25, twice in a vector; slopes by a few of these, as n_z > 1/2. Object
      // and world: the sums are a good part as long as their terms. Tiles of another size interpolate from
      // other pixels: a few roundings of texture coordinates among 64 texels whose slopes differ by up to 2.
      EXPECT_LT(worst, 3 * 0x1p-16);
    }
}

TEST(Samples, CoverTheTexelsThatTrianglesReachIntoAndNoOthers) {
  // A sliver a fifth of a texel wide, along a border of columns: no centre lies in it. And a triangle with
  // one, which reaches into two neighbours.
  scene::Scene scene = surfgrad::test::scene_of({});
  mesh::TriangleMesh& mesh = scene.meshes[0];
  for (int i = 0; i < 2; ++i) surfgrad::test::append_triangle(mesh, {0, 0, 0}, {0, 1, 0}, {0, 0, 1});
  mesh.uv_sets[0] = {{0.5f, 0}, {0.55f, 0}, {0.5f, 1}, {0.01f, 0.01f}, {0.3f, 0.01f}, {0.01f, 0.3f}};
  for (const int samples : {1, 3, 8}) {
    const Baked baked = bake(scene, {.width = 4, .height = 4, .space = Space::world, .samples = samples});
    EXPECT_EQ(baked.covered, 7) << samples;
    if (samples == 1) {
      EXPECT_EQ(baked.touched, 6);
    } else {
      EXPECT_GT(baked.samples, baked.covered);
      EXPECT_LT(baked.touched, baked.samples);
    }
    for (int y = 0; y < 4; ++y) {
      EXPECT_EQ(vector_at(baked.map, 2, y).x, 1.0) << y; // the sliver's normal
      EXPECT_EQ(vector_at(baked.map, 3, y).z, 1.0) << y; // nothing
    }
  }
}

TEST(Samples, GiveTheSameBytesForAnyNumberOfThreads) {
  const scene::Scene scene = bumped();
  const Options options{.width = 90, .height = 70, .samples = 5, .padding = 3};
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  const Baked one = bake(scene, options);
  const Baked many = [&] {
    const tbb::global_control more(tbb::global_control::max_allowed_parallelism, 4);
    return bake(scene, options);
  }();
  EXPECT_EQ(one.map.texels, many.map.texels);
  EXPECT_EQ(one.samples, many.samples);
}

} // namespace
} // namespace surfgrad::bake
