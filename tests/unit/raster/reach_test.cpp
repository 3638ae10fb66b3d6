// Triangles that reach into pixels beside their centres, against polygons cut in double.

#include "raster/tile_scan.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace surfgrad::raster {
namespace {

constexpr int width = 61;
constexpr int height = 47;

/// Area of a triangle within the unit square around a point, by cutting the polygon at its four sides.
double area_in_square(const std::array<vec3<double>, 3>& corners, double x, double y) {
  std::vector<vec2<double>> polygon;
  for (const vec3<double>& c : corners) polygon.push_back({c.x - x, c.y - y});
  for (const vec2<double> n : {vec2<double>{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    std::vector<vec2<double>> cut;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const vec2<double> a = polygon[i];
      const vec2<double> b = polygon[(i + 1) % polygon.size()];
      const double from = 0.5 - dot(n, a);
      const double to = 0.5 - dot(n, b);
      if (from >= 0) cut.push_back(a);
      if ((from > 0 && to < 0) || (from < 0 && to > 0)) cut.push_back(a + (from / (from - to)) * (b - a));
    }
    polygon = cut;
  }
  double area = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += 0.5 * cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return std::abs(area);
}

/// The least distance to many points of a triangle: never less than the true one, and hardly more.
double distance_by_trial(const std::array<vec3<double>, 3>& c, double x, double y) {
  double least = INFINITY;
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k <= 512; ++k) { // the point lies outside: a side is nearest
      const double t = k / 512.0;
      const auto& a = c[i];
      const auto& b = c[(i + 1) % 3];
      least = std::min(least, std::hypot((1 - t) * a.x + t * b.x - x, (1 - t) * a.y + t * b.y - y));
    }
  return least;
}

/// Of every size and mostly thin.
mesh::TriangleMesh slivers(test::Random& random, int count) {
  mesh::TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const vec3<double> c{random.uniform(0, 1), random.uniform(0, 1), 0};
    const double size = random.magnitude(1e-3, 0.3);
    const vec3<double> along{random.uniform(-size, size), random.uniform(-size, size), 0};
    const double thin = random.magnitude(1e-3, 1);
    const vec3<double> across =
        thin * vec3<double>{random.uniform(-size, size), random.uniform(-size, size), 0};
    test::append_triangle(mesh, c, c + along, c + across);
  }
  return mesh;
}

TEST(Reach, GivesPixelsWithoutACentreTheNearestTriangleThatReachesIntoThem) {
  constexpr std::uint64_t seed = 1741;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  int touched = 0;
  int ambiguous = 0;
  int empty = 0;
  double farthest = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const mesh::TriangleMesh mesh = slivers(random, 100);
    const std::vector<Surface> surfaces{
        place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, false}})};
    const Projection projection = Projection::texture(0, width, height);
    const int side = 1 + random.integer(30);
    const TileGrid grid(surfaces, projection, width, height, side, side);
    TileScan centres;
    TileScan scan;
    for (int row = 0; row < grid.rows(); ++row)
      for (int column = 0; column < grid.columns(); ++column) {
        const Tile tile = grid.tile(column, row);
        centres.scan(surfaces, projection, tile, grid.candidates(column, row), {});
        scan.scan(surfaces, projection, tile, grid.candidates(column, row), {}, Coverage::squares);
        int here = 0;
        for (int i = 0; i < tile.width * tile.height; ++i) {
          const double x = tile.x + i % tile.width + 0.5;
          const double y = tile.y + i / tile.width + 0.5;
          const int owner = scan.owners()[static_cast<std::size_t>(i)];
          if (const int covering = centres.owners()[static_cast<std::size_t>(i)];
              covering != TileScan::nothing) {
            ASSERT_NE(owner, TileScan::nothing);
            const TileScan::Shown& shown = scan.shown()[static_cast<std::size_t>(owner)];
            ASSERT_EQ(shown.id, centres.shown()[static_cast<std::size_t>(covering)].id);
            ASSERT_FALSE(shown.nearest);
            continue;
          }
          double least = INFINITY;
          bool sure = true; // the cut polygon's area is clearly something, or nothing
          std::uint32_t nearest = ~0u;
          for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto corners = projection.corners(surfaces[0], t);
            const double area = area_in_square(corners, x, y);
            sure = sure && (area == 0 || area > 1e-9);
            if (area == 0) continue;
            if (const double distance = distance_by_trial(corners, x, y); distance < least) {
              least = distance;
              nearest = t;
            }
          }
          if (!sure) {
            ++ambiguous;
            here += owner == TileScan::nothing ? 0 : 1;
            continue;
          }
          ASSERT_EQ(owner != TileScan::nothing, nearest != ~0u) << x << ", " << y;
          if (nearest == ~0u) {
            ++empty;
            continue;
          }
          ++here;
          const TileScan::Shown& shown = scan.shown()[static_cast<std::size_t>(owner)];
          ASSERT_TRUE(shown.nearest);
          ASSERT_EQ(shown.first_pixel, i);
          ASSERT_EQ(shown.pixels, 1);
          // It lies on its triangle, to rounding, and no tried point of any triangle is nearer.
          const auto weights = shown.planes.barycentrics(shown.nearest->x, shown.nearest->y).value;
          ASSERT_GE(std::min({weights[0], weights[1], weights[2]}), -1e-6);
          const double distance = std::hypot(shown.nearest->x - x, shown.nearest->y - y);
          ASSERT_LE(distance, least + 1e-12) << x << ", " << y;
          farthest = std::max(farthest, distance);
          ++touched;
        }
        EXPECT_EQ(scan.touched(), here);
      }
  }
  std::printf("  %d pixels touched, %d empty, %d ambiguous, farthest %.3f pixels, seed %llu\n", touched,
              empty, ambiguous, farthest, static_cast<unsigned long long>(seed));
  EXPECT_GT(touched, 5000);
  EXPECT_GT(empty, 5000);
  EXPECT_LT(ambiguous, 100);
  EXPECT_LT(farthest, std::sqrt(0.5)); // what reaches into a square is no farther than its corners
}

TEST(Reach, TakesTheFirstOfEquallyNearTrianglesAndNoBorderThatOnlyMeetsASquare) {
  // Two mirror images to the left and to the right of the centre of pixel (1, 1), which neither covers.
  mesh::TriangleMesh mesh;
  test::append_triangle(mesh, {1.25, 1.0, 0}, {1.375, 1.5, 0}, {1.25, 2.0, 0});
  test::append_triangle(mesh, {1.75, 1.0, 0}, {1.625, 1.5, 0}, {1.75, 2.0, 0});
  // A square that ends where pixel (5, 1) begins.
  test::append_triangle(mesh, {4, 1, 0}, {5, 1, 0}, {4, 2, 0});
  test::append_triangle(mesh, {5, 1, 0}, {5, 2, 0}, {4, 2, 0});
  for (vec2<float>& st : mesh.uv_sets[0]) st = 0.125f * st;
  const std::vector<Surface> surfaces{
      place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, false}})};
  const Projection projection = Projection::texture(0, 8, 8);
  const TileGrid grid(surfaces, projection, 8, 8, 8, 8);
  TileScan scan;
  scan.scan(surfaces, projection, grid.tile(0, 0), grid.candidates(0, 0), {}, Coverage::squares);
  int shown = 0;
  for (const int owner : scan.owners()) shown += owner != TileScan::nothing;
  EXPECT_EQ(shown, 2);
  const int owner = scan.owners()[8 + 1];
  ASSERT_NE(owner, TileScan::nothing);
  EXPECT_EQ(scan.shown()[static_cast<std::size_t>(owner)].id, (TriangleId{0, 0}));
  EXPECT_EQ(scan.shown()[static_cast<std::size_t>(owner)].nearest->x, 1.375);
  EXPECT_EQ(scan.owners()[8 + 5], TileScan::nothing);
}

} // namespace
} // namespace surfgrad::raster
