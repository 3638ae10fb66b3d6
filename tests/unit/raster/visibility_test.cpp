// What the camera sees: nearest first, nothing behind it, the same for any number of threads.

#include "raster/visibility.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <optional>

namespace surfgrad::raster {
namespace {

constexpr int width = 70;
constexpr int height = 150; // more than two bands of rows
/// Looks along -z; 100 pixels per unit of tangent.
const mat4<double> projection{
    {100, 0, -width / 2.0, 0}, {0, 100, -height / 2.0, 0}, {0, 0, 0, 0}, {0, 0, -1, 0}};

Surface placed(const mesh::TriangleMesh& mesh) {
  return place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {});
}

struct Hit {
  Visible what;
  double distance;
};

/// First triangle that the ray through a pixel centre meets beyond `near`, by intersecting all.
std::optional<Hit> traced(const std::vector<Surface>& surfaces, int x, int y, double near) {
  const vec3<double> d{(x + 0.5 - width / 2.0) / 100, (y + 0.5 - height / 2.0) / 100, -1};
  std::optional<Hit> best;
  for (std::uint32_t s = 0; s < surfaces.size(); ++s)
    for (std::uint32_t t = 0; t < surfaces[s].mesh->triangles.size(); ++t) {
      const auto& v = surfaces[s].mesh->triangles[t];
      const vec3<double> a = surfaces[s].positions[v[0]];
      const vec3<double> e1 = surfaces[s].positions[v[1]] - a;
      const vec3<double> e2 = surfaces[s].positions[v[2]] - a;
      const double det = dot(e1, cross(d, e2));
      const double u = dot(-a, cross(d, e2)) / det;
      const double w = dot(d, cross(-a, e1)) / det;
      const double distance = dot(e2, cross(-a, e1)) / det;
      if (!(u >= 0 && w >= 0 && u + w <= 1 && distance > near)) continue;
      if (!best || distance < best->distance) best = Hit{{s, t}, distance};
    }
  return best;
}

mesh::TriangleMesh soup(test::Random& random, int count) {
  mesh::TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const vec3<double> c{random.uniform(-1, 1), random.uniform(-2, 2), random.uniform(-4, 1)};
    const mat3<double> offsets = random.matrix3();
    test::append_triangle(mesh, c + offsets.x, c + offsets.y, c + offsets.z);
  }
  return mesh;
}

TEST(Visibility, IsTheNearestTriangleOnTheRayBeyondTheNearLimit) {
  constexpr std::uint64_t seed = 71;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const mesh::TriangleMesh one = soup(random, 40);
  const mesh::TriangleMesh two = soup(random, 40);
  const std::vector<Surface> surfaces{placed(one), placed(two)};
  for (const double near : {1e-6, 0.5, 2.0}) {
    const VisibilityBuffer seen = see(surfaces, Projection::camera(projection, near), width, height);
    int compared = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto hit = traced(surfaces, x, y, near);
        ASSERT_EQ(seen.at(x, y).surface, hit ? hit->what.surface : Visible::none) << x << ", " << y;
        if (!hit) continue;
        ASSERT_EQ(seen.at(x, y).triangle, hit->what.triangle) << x << ", " << y;
        ++compared;
      }
    EXPECT_GT(compared, 1000);
  }
}

TEST(Visibility, AtEqualDepthGoesToTheEarlierSurfaceAndTriangle) {
  mesh::TriangleMesh twice;
  for (int i = 0; i < 2; ++i) test::append_triangle(twice, {-1, -1, -2}, {1, -1, -2}, {0, 1, -2});
  const std::vector<Surface> surfaces{placed(twice), placed(twice)};
  const VisibilityBuffer seen = see(surfaces, Projection::camera(projection, 1e-3), width, height);
  int covered = 0;
  for (const Visible& v : seen.pixels) {
    if (v.surface == Visible::none) continue;
    ++covered;
    EXPECT_EQ(v.surface, 0u);
    EXPECT_EQ(v.triangle, 0u);
  }
  EXPECT_GT(covered, 1000);
}

TEST(Visibility, LeavesOutWhatIsSkippedAndTellsSides) {
  mesh::TriangleMesh mesh;
  test::append_triangle(mesh, {-1, -1, -2}, {1, -1, -2}, {0, 1, -2}); // faces the eye
  test::append_triangle(mesh, {-1, -1, -1}, {0, 1, -1}, {1, -1, -1}); // nearer, shows its back
  const std::vector<Surface> surfaces{placed(mesh)};
  const auto seen = see(surfaces, Projection::camera(projection, 1e-3), width, height, [](const TriangleId&, bool front) { return !front; });
  EXPECT_EQ(seen.at(width / 2, height / 2).triangle, 0u);
  const auto other = see(surfaces, Projection::camera(projection, 1e-3), width, height, [](const TriangleId&, bool front) { return front; });
  EXPECT_EQ(other.at(width / 2, height / 2).triangle, 1u);
}

TEST(Visibility, DoesNotDependOnThreads) {
  test::Random random(72);
  const mesh::TriangleMesh mesh = soup(random, 200);
  const std::vector<Surface> surfaces{placed(mesh)};
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return see(surfaces, Projection::camera(projection, 1e-3), width, height);
  };
  const VisibilityBuffer one = run(1);
  const VisibilityBuffer many = run(4);
  for (std::size_t i = 0; i < one.pixels.size(); ++i) {
    ASSERT_EQ(one.pixels[i].surface, many.pixels[i].surface);
    ASSERT_EQ(one.pixels[i].triangle, many.pixels[i].triangle);
  }
}

} // namespace
} // namespace surfgrad::raster
