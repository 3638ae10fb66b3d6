// Triangles thinner than a texel are in the map.

#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>

namespace surfgrad::bake {
namespace {

constexpr int side = 64;

/// A strip of triangles a quarter of a texel wide that slopes over the map, bent around a cylinder along its
/// length: normals turn from one end to the other by a right angle.
scene::Scene strip(double width_texels) {
  constexpr int segments = 40;
  mesh::TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  for (int k = 0; k <= segments; ++k) {
    const double t = static_cast<double>(k) / segments;
    const double angle = t * 3.14159265358979324 / 2;
    for (const double across : {0.0, 1.0}) {
      mesh.positions.push_back({static_cast<float>(std::sin(angle)), static_cast<float>(0.01 * across),
                                static_cast<float>(std::cos(angle))});
      mesh.normals.push_back({static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))});
      mesh.uv_sets[0].push_back(
          {static_cast<float>(0.1 + 0.8 * t),
           static_cast<float>((10.37 + 0.31 * t * side + across * width_texels) / side)});
    }
  }
  for (std::uint32_t k = 0; k < segments; ++k) {
    const std::uint32_t a = 2 * k;
    mesh.triangles.push_back({a, a + 2, a + 1});
    mesh.triangles.push_back({a + 1, a + 2, a + 3});
  }
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return surfgrad::test::scene_of(mesh);
}

TEST(Slivers, AQuarterOfATexelWideHaveAllTheirTexels) {
  for (const double width : {0.25, 1e-3}) {
    const scene::Scene scene = strip(width);
    const Baked baked =
        bake(scene, {.width = side, .height = side, .space = Space::world, .depth = image::Depth::float32});
    double worst = 0;
    int unbroken = 0;
    for (int x = 0; x < side; ++x) {
      // The strip lies over the whole width of these columns.
      const double left = std::max((static_cast<double>(x) / side - 0.1) / 0.8, 0.0);
      const double right = std::min((static_cast<double>(x + 1) / side - 0.1) / 0.8, 1.0);
      if (!(left < right)) continue;
      const auto row_of = [&](double t, double across) {
        return static_cast<int>(std::floor(10.37 + 0.31 * t * side + across * width));
      };
      for (int y = row_of(left, 0); y <= row_of(right, 1); ++y) {
        const vec3<double> n{2.0 * baked.map.at(x, y, 0) - 1, 2.0 * baked.map.at(x, y, 1) - 1,
                             2.0 * baked.map.at(x, y, 2) - 1};
        // The strip's point nearest to the centre: along its middle, or where it ends.
        const double slope = 0.31 / 0.8;
        const double along =
            x + 0.5 + slope * (y + 0.5 - (10.37 + 0.31 * (x + 0.5 - 0.1 * side) / 0.8)) / (1 + slope * slope);
        const double t = std::clamp((along / side - 0.1) / 0.8, 0.0, 1.0);
        const double angle = t * 3.14159265358979324 / 2;
        worst = std::max(worst, surfgrad::test::unit_angle(n, {std::sin(angle), 0, std::cos(angle)}));
        ++unbroken;
      }
    }
    std::printf("  %g texels wide: %d texels, %lld of %lld by touch alone, worst %.3f degrees\n", width,
                unbroken, static_cast<long long>(baked.touched), static_cast<long long>(baked.covered),
                worst);
    EXPECT_EQ(baked.covered, unbroken);
    EXPECT_GT(baked.touched, unbroken / 2);
    // The nearest point may lie on either side of the strip: half its width along, of 51 texels for 90
    // degrees; normals between vertices 2.25 degrees apart are off by 0.001.
    EXPECT_LT(worst, 0.5 * width * 90 / 51 + 0.01);
  }
}

TEST(Slivers, AreDecodedAsTheyWereBakedAndTheSameForAnyTilesAndThreads) {
  surfgrad::test::Random random(1761);
  scene::Scene scene = strip(0.25);
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, 64, 64));
  scene.materials[0].layers = {surfgrad::test::normal_layer("a")};
  for (const Space space : {Space::tangent, Space::object}) {
    const Options options{
        .width = side, .height = side, .space = space, .padding = 3, .depth = image::Depth::float32};
    const Baked many = bake(scene, options);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(bake(scene, options).map.texels, many.map.texels);
    const Deviation off = verify(scene, options, many.map).texels;
    EXPECT_EQ(off.compared, many.covered);
    EXPECT_LT(off.most_deg, 1e-4); // what float normals are rounded by
  }
}

TEST(Slivers, WithoutAnAreaAreNotInTheMap) {
  scene::Scene scene = strip(0.25);
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st.y = 0.5f * st.x;
  EXPECT_THROW((void)bake(scene, {.width = side, .height = side}), std::exception);
}

} // namespace
} // namespace surfgrad::bake
