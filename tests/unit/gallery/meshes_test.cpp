// The built-in meshes: closed, facing outwards, with the texture coordinates they claim.

#include "gallery/meshes.hpp"
#include "gallery/morphs.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>
#include <utility>

namespace surfgrad::gallery {
namespace {

using test::widen;

std::array<std::uint32_t, 3> corners(const mesh::TriangleMesh& mesh, std::size_t triangle) {
  return mesh.triangles[triangle];
}

TEST(GalleryMeshes, NormalsAreUnitAndTrianglesFaceAlongThem) {
  for (const mesh::TriangleMesh& mesh :
       {rock_mesh(), closed_surface(8, ball_point), closed_surface(12, rounded_cube_point),
        closed_surface(12, pill_point), half_mirrored_torus(), barrel(), ground(), scroll(), sheet(3),
        sheet(6, 0.35), flat_sheet(4), morphed_sheet(32, MorphedTangents::recomputed)}) {
    for (const vec3<float>& n : mesh.normals) ASSERT_NEAR(length(widen(n)), 1, 1e-6);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto [a, b, c] = corners(mesh, i);
      const vec3<double> p = widen(mesh.positions[a]);
      const vec3<double> face = cross(widen(mesh.positions[b]) - p, widen(mesh.positions[c]) - p);
      ASSERT_GT(dot(face, widen(mesh.normals[a]) + widen(mesh.normals[b]) + widen(mesh.normals[c])), 0) << i;
    }
  }
}

TEST(GalleryMeshes, ClosedSurfacesHaveNoOpenEdge) {
  const mesh::TriangleMesh rock = rock_mesh();
  using Point = std::tuple<float, float, float>;
  std::map<std::pair<Point, Point>, int> edges;
  for (std::size_t i = 0; i < rock.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto point = [&](std::size_t corner) {
        const vec3<float> p = rock.positions[rock.triangles[i][corner % 3]];
        return Point{p.x, p.y, p.z};
      };
      ++edges[{point(k), point(k + 1)}];
    }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U);
  }
}

TEST(GalleryMeshes, RockNormalsAreThoseOfItsSurface) {
  // Central differences of the position along two directions of the unit sphere.
  double worst = 0;
  int kinks = 0;
  for (int i = 0; i < 500; ++i) {
    const double azimuth = 0.37 * i;
    const double y = -0.95 + 1.9 * i / 499;
    const double r = std::sqrt(1 - y * y);
    const vec3<double> d{r * std::sin(azimuth), y, r * std::cos(azimuth)};
    const vec3<double> a = normalize_or_zero(cross(vec3<double>{0, 1, 0.1}, d));
    const vec3<double> b = cross(d, a);
    const auto point = [&](vec3<double> step) {
      return rock_point(normalize_or_zero(d + step), rock_all_octaves).position;
    };
    const double h = 1e-5;
    const vec3<double> along_a = point(h * a) - point(-(h * a));
    const vec3<double> along_b = point(h * b) - point(-(h * b));
    const vec3<double> expected = normalize_or_zero(cross(along_a, along_b));
    const double error = length(rock_point(d, rock_all_octaves).normal - expected);
    // h^2 times the third derivative of the finest octave (60 cells a unit, amplitude 2e-3: 1e3), over the
    // radius, and 1e-16 / h of rounding.
    if (error < 3e-6)
      worst = std::max(worst, error);
    else
      ++kinks;
  }
  std::printf("  worst difference %.3g, %d samples on a ridge\n", worst, kinks);
  // A ridge line of one of the five finer octaves within h of a sample: there is about one a cell.
  EXPECT_LE(kinks, 5);
}

TEST(GalleryMeshes, SmoothBodiesHaveTheNormalsOfTheirSurface) {
  for (const auto body : {rounded_cube_point, pill_point}) {
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
      const double azimuth = 0.37 * i;
      const double y = -0.95 + 1.9 * i / 499;
      const double r = std::sqrt(1 - y * y);
      const vec3<double> d{r * std::sin(azimuth), y, r * std::cos(azimuth)};
      const vec3<double> a = normalize_or_zero(cross(vec3<double>{0, 1, 0.1}, d));
      const vec3<double> b = cross(d, a);
      const double h = 1e-5;
      const auto point = [&](vec3<double> step) { return body(normalize_or_zero(d + step)).position; };
      const vec3<double> expected =
          normalize_or_zero(cross(point(h * a) - point(-(h * a)), point(h * b) - point(-(h * b))));
      worst = std::max(worst, length(body(d).normal - expected));
    }
    // Rounding, 1e-16 / h; at the joints of the pill, whose curvature jumps from 0 to 1 / 0.55, up to
    // h / 0.55.
    EXPECT_LT(worst, 3e-5);
  }
}

TEST(GalleryMeshes, LedgesRunAroundTheRockWhereItsMeshIsSteep) {
  int level_on_the_mesh = 0;
  int level = 0;
  int overhanging = 0;
  constexpr int samples = 2000;
  for (int i = 0; i < samples; ++i) {
    const double azimuth = 0.37 * i;
    const double y = -0.5 + 1.0 * i / (samples - 1);
    const double r = std::sqrt(1 - y * y);
    const vec3<double> d{r * std::sin(azimuth), y, r * std::cos(azimuth)};
    const vec3<double> n = ledged_rock_normal(d);
    ASSERT_NEAR(length(n), 1, 1e-12);
    ASSERT_GT(dot(n, d), 0); // outwards
    if (n.y > 0.8) ++level;
    if (rock_point(d, rock_mesh_octaves).normal.y > 0.8) ++level_on_the_mesh;
    if (n.y < 0) ++overhanging;
  }
  std::printf("  level %d of %d, on the mesh %d; overhanging %d\n", level, samples, level_on_the_mesh,
              overhanging);
  EXPECT_LT(level_on_the_mesh, samples / 20);
  EXPECT_GT(level, samples / 10);
  EXPECT_GT(overhanging, samples / 4);
}

TEST(GalleryMeshes, UnwrapLeadsBackToTheSurface) {
  const mesh::TriangleMesh ball = closed_surface(6, ball_point);
  for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
    vec2<double> uv{0, 0};
    vec3<double> sum{0, 0, 0};
    for (const std::uint32_t v : corners(ball, i)) {
      uv = uv + (1.0 / 3) * widen(ball.uv_sets[0][v]);
      sum = sum + widen(ball.positions[v]);
    }
    // The middle of a triangle of a sixth of a side: directions are bent by the projection.
    EXPECT_GT(dot(unwrapped_direction(uv), normalize_or_zero(sum)), 0.995) << i;
    EXPECT_EQ(nearest_in_chart(uv, 0.02).x, uv.x);
  }
  for (const vec2<float>& uv : ball.uv_sets[0]) EXPECT_NEAR(length(unwrapped_direction(widen(uv))), 1, 1e-9);
}

TEST(GalleryMeshes, NearestInChartStaysInItsCell) {
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) {
      const vec2<double> uv{(x + 0.5) / 60, (y + 0.5) / 40};
      const vec2<double> near = nearest_in_chart(uv, 0.02);
      EXPECT_EQ(std::floor(3 * uv.x), std::floor(3 * near.x));
      EXPECT_EQ(std::floor(2 * uv.y), std::floor(2 * near.y));
      // At most from the cell's corner to the chart's: the gutter and the inset, in cells.
      EXPECT_LE(std::abs(3 * (uv.x - near.x)), 0.041);
      EXPECT_LE(std::abs(2 * (uv.y - near.y)), 0.041);
    }
}

TEST(GalleryMeshes, TilingSetIsUnbrokenOverEveryTriangle) {
  const mesh::TriangleMesh ball = closed_surface(8, ball_point);
  for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
    const auto v = corners(ball, i);
    for (std::size_t k = 0; k < 3; ++k) {
      const vec2<double> step = widen(ball.uv_sets[1][v[k]]) - widen(ball.uv_sets[1][v[(k + 1) % 3]]);
      // Around the poles a triangle sees an eighth of the longitude and more, never the way round.
      EXPECT_LE(std::abs(step.x), 0.26) << i;
      EXPECT_LE(std::abs(step.y), 0.1) << i;
    }
  }
}

TEST(GalleryMeshes, HalfOfTheTorusAndOneChartAreMirrored) {
  const auto counts = [](const mesh::TriangleMesh& mesh) {
    std::pair<int, int> sides{0, 0}; // as they are, mirrored
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const auto [a, b, c] = corners(mesh, i);
      const vec2<double> p = widen(mesh.uv_sets[0][a]);
      const double area = cross(widen(mesh.uv_sets[0][b]) - p, widen(mesh.uv_sets[0][c]) - p);
      ++(area > 0 ? sides.first : sides.second);
    }
    return sides;
  };
  const auto torus = counts(half_mirrored_torus());
  EXPECT_EQ(torus.first, torus.second);
  const auto ball = counts(closed_surface(8, ball_point));
  EXPECT_EQ(ball.first, 5 * ball.second);
}

} // namespace
} // namespace surfgrad::gallery
