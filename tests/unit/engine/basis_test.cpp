// The vertex frame and the frame derived from the texture coordinate agree where both are right.

#include "lab.hpp"
#include "raster/visibility.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace surfgrad::engine {
namespace {

using test::composed;

/// Largest angle between the two bases' results over the texel centres of a mesh's first UV set.
double largest_difference(const mesh::TriangleMesh& mesh, const mat3<double>& linear) {
  test::Lab lab;
  test::Random random(121);
  lab.add("map", surfgrad::test::random_normal_map(random, 32, 32, 1));
  const Program vertex = lab.compile({test::normal_layer("map")});
  const Program derived = lab.compile({test::normal_layer("map", 0, stack::Basis::derived)});
  const std::vector<raster::Surface> surfaces{
      raster::place_mesh(mesh, surfgrad::test::affine(linear), {0, 0, 0}, {{0, true}})};
  constexpr int size = 60;
  const raster::VisibilityBuffer layout = raster::see(surfaces, raster::Projection::texture(0, size, size), size, size);
  double largest = 0;
  int compared = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      if (layout.at(x, y).surface == raster::Visible::none) continue;
      const auto t = layout.at(x, y).triangle;
      auto f = raster::make_fragment(surfaces[0], t, raster::Projection::texture(0, size, size).planes(surfaces[0], t),
                                     x + 0.5, y + 0.5);
      f.front_facing = true;
      const auto a = composed(vertex, f, BackFaces::same, linear);
      const auto b = composed(derived, f, BackFaces::same, linear);
      EXPECT_FALSE(a.degenerate || b.degenerate);
      largest = std::max(largest, std::asin(std::min(1.0, length(cross(a.normal, b.normal)))));
      ++compared;
    }
  EXPECT_GT(compared, 100);
  return largest;
}

TEST(Basis, VertexAndDerivedFramesAgreeOnAPlaneForEveryUnwrap) {
  test::Random random(122);
  double worst = 0;
  for (int k = 0; k < 40; ++k) {
    mesh::TriangleMesh mesh = surfgrad::test::plane(2);
    // Any affine unwrap: turned, sheared, mirrored; around the middle of the texture.
    const mat3<double> m = random.matrix3(-0.5, 0.5);
    for (vec2<float>& st : mesh.uv_sets[0]) {
      const vec2<double> p = surfgrad::test::widen(st) - vec2<double>{0.5, 0.5};
      st = surfgrad::test::narrow(
          vec2<double>{m.x.x * p.x + m.x.y * p.y + 0.5, m.y.x * p.x + m.y.y * p.y + 0.5});
    }
    const double area = m.x.x * m.y.y - m.x.y * m.y.x;
    if (std::abs(area) < 0.08) continue;
    const mat3<double> turn =
        k % 2 == 0 ? random.rotation() : random.rotation() * surfgrad::test::scaling({-2, 2, 2});
    worst = std::max(worst, largest_difference(mesh, turn));
  }
  std::printf("  largest angle on planes: %.3g\n", worst);
  EXPECT_LT(worst, 1e-5); // positions and tangents in float, magnified by slopes and shear
  EXPECT_GT(worst, 0);
}

TEST(Basis, VertexAndDerivedFramesAgreeOnASphereAsItsMeshGetsFiner) {
  for (const bool mirrored : {false, true}) {
    double last = HUGE_VAL;
    for (const int n : {12, 24, 48}) {
      mesh::TriangleMesh mesh = surfgrad::test::sphere_band(2 * n, n);
      if (mirrored)
        for (vec2<float>& st : mesh.uv_sets[0]) st.x = 1 - st.x;
      const double angle = largest_difference(mesh, surfgrad::test::scaling({1, 1, 1}));
      std::printf("  %s%d rows: largest angle %.4g\n", mirrored ? "mirrored, " : "", n, angle);
      // Flat triangles: their own direction of +s is off by half the angle between vertices.
      EXPECT_LT(angle, 3.2 / n);
      EXPECT_LT(angle, 0.65 * last);
      last = angle;
    }
  }
}

} // namespace
} // namespace surfgrad::engine
