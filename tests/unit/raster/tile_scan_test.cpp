// Tiles are scanned for what their pixels show, against every triangle asked at every pixel.

#include "raster/tile_scan.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace surfgrad::raster {
namespace {

constexpr int width = 61;
constexpr int height = 47;
constexpr int tile_side = 13;

mat4<double> random_projection(test::Random& random) {
  const double focal_px = random.magnitude(10, 300);
  return {{focal_px, 0, -width / 2.0, 0}, {0, focal_px, -height / 2.0, 0}, {0, 0, 0, 0}, {0, 0, -1, 0}};
}

/// Triangles from far smaller than a pixel to far larger than the raster, a third of them through the plane
/// of the eye, some without area, some with corners on pixel centres.
mesh::TriangleMesh triangles(test::Random& random, int count, bool flat) {
  mesh::TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const double z = flat ? 0 : random.uniform(-6, 0.5);
    const vec3<double> c{random.uniform(-1, 1), random.uniform(-1, 1), z};
    const double size = random.magnitude(1e-4, 30);
    const mat3<double> offsets = random.matrix3(-size, size);
    vec3<double> a = c + offsets.x;
    vec3<double> b = c + offsets.y;
    const vec3<double> d = i % 16 == 0 ? 0.5 * (a + b) : c + offsets.z; // without area but for rounding
    if (i % 5 == 0) a = {(random.integer(width) + 0.5) / width, (random.integer(height) + 0.5) / height, a.z};
    test::append_triangle(mesh, a, b, d);
  }
  return mesh;
}

struct Shown {
  TriangleId id{~0u, 0};
  int overlaps = 0;
};

/// What a pixel shows by the definitions of covers() and inverse_w().
Shown asked_of_all(const std::vector<Surface>& surfaces, const Projection& projection, const Skip& skip,
                   double x, double y) {
  Shown shown;
  double nearest = 0;
  int hits = 0;
  for (std::uint32_t s = 0; s < surfaces.size(); ++s)
    for (std::uint32_t t = 0; t < surfaces[s].mesh->triangles.size(); ++t) {
      const TrianglePlanes planes = projection.planes(surfaces[s], t);
      if (!planes.covers(x, y)) continue;
      if (skip && skip({s, t}, planes.counter_clockwise() != surfaces[s].mirrored)) continue;
      ++hits;
      if (projection.has_depth()) {
        const double inverse_w = planes.inverse_w(x, y);
        if (inverse_w * projection.near() > 1 || !(inverse_w > nearest)) continue;
        nearest = inverse_w;
        shown.id = {s, t};
      } else if (hits == 1) {
        shown.id = {s, t};
      }
    }
  shown.overlaps = !projection.has_depth() && hits > 1;
  return shown;
}

void expect_as_asked(const std::vector<Surface>& surfaces, const Projection& projection, const Skip& skip,
                     int& seen) {
  const TileGrid grid(surfaces, projection, width, height, tile_side, tile_side);
  TileScan scan; // reused from tile to tile, as a thread does
  for (int row = 0; row < grid.rows(); ++row)
    for (int column = 0; column < grid.columns(); ++column) {
      const Tile tile = grid.tile(column, row);
      scan.scan(surfaces, projection, tile, grid.candidates(column, row), skip);
      ASSERT_EQ(scan.owners().size(), static_cast<std::size_t>(tile.width * tile.height));
      std::vector<int> pixels(scan.shown().size(), 0);
      int overlapping = 0;
      for (int i = 0; i < tile.width * tile.height; ++i) {
        const int x = tile.x + i % tile.width;
        const int y = tile.y + i / tile.width;
        const Shown expected = asked_of_all(surfaces, projection, skip, x + 0.5, y + 0.5);
        overlapping += expected.overlaps;
        const int owner = scan.owners()[static_cast<std::size_t>(i)];
        ASSERT_EQ(owner != TileScan::nothing, expected.id.surface != ~0u) << x << ", " << y;
        if (owner == TileScan::nothing) continue;
        const TileScan::Shown& shown = scan.shown()[static_cast<std::size_t>(owner)];
        ASSERT_EQ(shown.id, expected.id) << x << ", " << y;
        if (pixels[static_cast<std::size_t>(owner)]++ == 0) {
          ASSERT_EQ(shown.first_pixel, i);
        }
        ++seen;
      }
      EXPECT_EQ(scan.overlapping(), overlapping);
      for (std::size_t k = 0; k < pixels.size(); ++k) {
        EXPECT_EQ(scan.shown()[k].pixels, pixels[k]);
        EXPECT_GT(pixels[k], 0) << "listed, but hidden";
        if (k > 0) {
          EXPECT_LT(scan.shown()[k - 1].id, scan.shown()[k].id);
        }
      }
    }
}

TEST(TileScan, OfAScreenIsWhatEveryTriangleSaysAtEveryPixel) {
  constexpr std::uint64_t seed = 1501;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  int seen = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const mesh::TriangleMesh one = triangles(random, 30, false);
    const mesh::TriangleMesh two = triangles(random, 30, false);
    const std::vector<Surface> surfaces{
        place_mesh(one, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {}),
        place_mesh(two, test::affine(test::scaling({-1, 1, 1})), {0, 0, 0}, {})};
    Skip skip;
    if (trial % 2 == 1)
      skip = [](const TriangleId& id, bool front) { return id.triangle % 3 == 0 && !front; };
    expect_as_asked(surfaces, Projection::camera(random_projection(random), random.magnitude(1e-4, 1)), skip,
                    seen);
  }
  std::printf("  %d pixels shown, seed %llu\n", seen, static_cast<unsigned long long>(seed));
  EXPECT_GT(seen, 10000);
}

TEST(TileScan, OfATextureIsTheFirstTriangleOverEveryPixel) {
  constexpr std::uint64_t seed = 1502;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  int seen = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const mesh::TriangleMesh mesh = triangles(random, 30, true);
    const std::vector<Surface> surfaces{
        place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, false}})};
    expect_as_asked(surfaces, Projection::texture(0, width, height), {}, seen);
  }
  std::printf("  %d pixels shown, seed %llu\n", seen, static_cast<unsigned long long>(seed));
  EXPECT_GT(seen, 10000);
}

TEST(TileGrid, ListsEveryTriangleThatCoversAPixelOfATile) {
  constexpr std::uint64_t seed = 1503;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  int covered = 0;
  std::size_t listed = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const bool flat = trial % 2 == 1;
    const mesh::TriangleMesh mesh = triangles(random, 60, flat);
    const std::vector<Surface> surfaces{
        place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, false}})};
    const Projection projection =
        flat ? Projection::texture(0, width, height) : Projection::camera(random_projection(random), 1e-3);
    const int side = 1 + random.integer(20);
    const TileGrid grid(surfaces, projection, width, height, side, side + 3);
    int pixels = 0;
    for (int row = 0; row < grid.rows(); ++row)
      for (int column = 0; column < grid.columns(); ++column) {
        const Tile tile = grid.tile(column, row);
        pixels += tile.width * tile.height;
        const auto candidates = grid.candidates(column, row);
        listed += candidates.size();
        ASSERT_TRUE(std::is_sorted(candidates.begin(), candidates.end()));
        ASSERT_EQ(std::adjacent_find(candidates.begin(), candidates.end()), candidates.end());
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
          const TrianglePlanes planes = projection.planes(surfaces[0], t);
          bool covers = false;
          for (int i = 0; i < tile.width * tile.height && !covers; ++i)
            covers = planes.covers(tile.x + i % tile.width + 0.5, tile.y + i / tile.width + 0.5);
          if (!covers) continue;
          ++covered;
          ASSERT_TRUE(std::binary_search(candidates.begin(), candidates.end(), TriangleId{0, t}))
              << "triangle " << t << " of trial " << trial << " in tile " << column << ", " << row;
        }
      }
    EXPECT_EQ(pixels, width * height);
  }
  std::printf("  %d triangles over tiles, %zu listed, seed %llu\n", covered, listed,
              static_cast<unsigned long long>(seed));
  EXPECT_GT(covered, 1000);
}

} // namespace
} // namespace surfgrad::raster
