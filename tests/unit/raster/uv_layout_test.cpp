// Who owns the texels of a UV set: mirrored islands too, overlaps counted once.

#include "raster/visibility.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

namespace surfgrad::raster {
namespace {

const mat4<double> identity = test::affine(test::scaling({1, 1, 1}));

/// A square of two triangles at the given place of the texture.
void add_island(mesh::TriangleMesh& mesh, vec2<double> from, vec2<double> to) {
  test::append_patch(
      mesh, 1, 1,
      [](double s, double t) {
        return test::SurfacePoint{{s, t, 0}, {0, 0, 1}};
      },
      [&](double s, double t) {
        return vec2<double>{from.x + s * (to.x - from.x), from.y + t * (to.y - from.y)};
      });
}

TEST(UvLayout, CoversMirroredIslandsLikeOthers) {
  mesh::TriangleMesh mesh;
  add_island(mesh, {0, 0}, {0.5, 1});
  add_island(mesh, {1, 0}, {0.5, 1}); // mirrored, meets the first at s = 1/2
  const std::vector<Surface> surfaces{place_mesh(mesh, identity, {0, 0, 0}, {{0, false}})};
  for (const int size : {8, 9, 31}) { // with 9 and 31 texel centres lie on the seam
    const VisibilityBuffer layout = see(surfaces, Projection::texture(0, size, size), size, size);
    EXPECT_EQ(layout.overlapping, 0);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        ASSERT_EQ(layout.at(x, y).surface, 0u) << x << ", " << y << " of " << size;
        if (2 * x + 1 == size) continue; // on the seam either will do
        EXPECT_EQ(layout.at(x, y).triangle < 2, 2 * x + 1 < size) << x << ", " << y << " of " << size;
      }
  }
}

TEST(UvLayout, CountsATexelUnderSeveralTrianglesOnceAndKeepsTheFirst) {
  mesh::TriangleMesh first;
  add_island(first, {0, 0}, {0.5, 0.5});
  add_island(first, {0.25, 0}, {0.5, 0.5}); // over the right half of the first
  mesh::TriangleMesh second;
  add_island(second, {0.5, 0}, {0.25, 0.5}); // again, mirrored
  const std::vector<Surface> surfaces{place_mesh(first, identity, {0, 0, 0}, {{0, false}}),
                                      place_mesh(second, identity, {0, 0, 0}, {{0, false}})};
  const VisibilityBuffer layout = see(surfaces, Projection::texture(0, 16, 16), 16, 16);
  EXPECT_EQ(layout.overlapping, 4 * 8);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const bool inside = x < 8 && y < 8;
      EXPECT_EQ(layout.at(x, y).surface, inside ? 0u : Visible::none);
      EXPECT_LT(layout.at(x, y).triangle, 2u);
    }
}

TEST(UvLayout, IgnoresWhatLiesOutsideTheUnitSquareAndHasNoArea) {
  mesh::TriangleMesh mesh;
  add_island(mesh, {1, 1}, {2, 2});
  add_island(mesh, {-3, 0}, {0, 1});
  add_island(mesh, {0.5, 0}, {0.5, 1}); // collapsed
  const std::vector<Surface> surfaces{place_mesh(mesh, identity, {0, 0, 0}, {{0, false}})};
  for (const Visible& v : see(surfaces, Projection::texture(0, 9, 9), 9, 9).pixels)
    EXPECT_EQ(v.surface, Visible::none);
}

} // namespace
} // namespace surfgrad::raster
