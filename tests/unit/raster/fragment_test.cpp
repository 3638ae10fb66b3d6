// Attributes at a raster position, and how they change from one position to the next.

#include "raster/visibility.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

#include <cmath>

namespace surfgrad::raster {
namespace {

const mat4<double> identity = test::affine(test::scaling({1, 1, 1}));

TEST(Fragment, LiesOnTheRayAndChangesAsItsNeighbours) {
  constexpr std::uint64_t seed = 91;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const mat4<double> projection{{100, 0, -32, 0}, {0, 100, -32, 0}, {0, 0, 0, 0}, {0, 0, -1, 0}};
  test::Worst ray("position on the ray");
  test::Worst rate("rates against differences");
  for (long k = 0; k < 500; ++k) {
    mesh::TriangleMesh mesh;
    const vec3<double> c{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), -2};
    const mat3<double> offsets = random.matrix3();
    test::append_triangle(mesh, c + offsets.x, c + offsets.y, c + offsets.z);
    for (vec2<float>& st : mesh.uv_sets[0]) st = test::narrow(random.vector2(-3, 3));
    const Surface s = place_mesh(mesh, identity, {0, 0, 0}, {{0, false}});
    const TrianglePlanes planes = Projection::camera(projection, 1e-3).planes(s, 0);
    const double x = random.uniform(20, 44);
    const double y = random.uniform(20, 44);
    if (!planes.covers(x, y)) continue;
    const Fragment<double> f = make_fragment(s, 0, planes, x, y);
    const double w = -f.position.z;
    ray.add(vec2<double>{100 * f.position.x / w + 32, 100 * f.position.y / w + 32}, {x, y}, 1e-9, k);
    constexpr double h = 1e-4;
    const Fragment<double> right = make_fragment(s, 0, planes, x + h, y);
    const Fragment<double> left = make_fragment(s, 0, planes, x - h, y);
    const Fragment<double> above = make_fragment(s, 0, planes, x, y + h);
    const Fragment<double> below = make_fragment(s, 0, planes, x, y - h);
    // Central differences: rounding eps / h of the value, and h^2 times a bend seen edge-on.
    const double bound = 1e-6 * (1 + max_abs(f.dp_dx) + max_abs(f.dp_dy));
    rate.add(f.dp_dx, (0.5 / h) * (right.position - left.position), bound, k);
    rate.add(f.dp_dy, (0.5 / h) * (above.position - below.position), bound, k);
    const double st_bound = 1e-6 * (1 + max_abs(f.uvs[0].dst_dx) + max_abs(f.uvs[0].dst_dy));
    rate.add(f.uvs[0].dst_dx, (0.5 / h) * (right.uvs[0].st - left.uvs[0].st), st_bound, k);
    rate.add(f.uvs[0].dst_dy, (0.5 / h) * (above.uvs[0].st - below.uvs[0].st), st_bound, k);
  }
}

TEST(Fragment, OfATextureHasTheCoordinateOfItsTexel) {
  const mesh::TriangleMesh mesh = test::half_mirrored_torus(12, 7);
  const std::vector<Surface> surfaces{place_mesh(mesh, identity, {0, 0, 0}, {{0, true}})};
  constexpr int width = 50;
  constexpr int height = 30;
  const VisibilityBuffer layout = see(surfaces, Projection::texture(0, width, height), width, height);
  test::Worst worst("coordinate and rates at texel centres");
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint32_t triangle = layout.at(x, y).triangle;
      const Fragment<double> f = make_fragment(
          surfaces[0], triangle, Projection::texture(0, width, height).planes(surfaces[0], triangle), x + 0.5, y + 0.5);
      const auto& uv = f.uvs[0];
      worst.add(uv.st, {(x + 0.5) / width, (y + 0.5) / height}, 1e-13,
                y * width + x); // rounding of UVs of order 1
      worst.add(uv.dst_dx, {1.0 / width, 0}, 1e-13, y * width + x);
      worst.add(uv.dst_dy, {0, 1.0 / height}, 1e-13, y * width + x);
      EXPECT_EQ(uv.sign, x < width / 2 ? 1 : -1);
    }
}

TEST(Fragment, WithoutAnInterpolatedNormalTakesTheTrianglesOutwardOne) {
  test::Random random(92);
  for (const mat3<double>& linear : {test::scaling({1, 1, 1}), test::scaling({-1, 2, 1}) * random.rotation()})
    for (const bool cancelling : {false, true}) {
      mesh::TriangleMesh mesh = test::plane(1);
      const Surface whole = place_mesh(mesh, test::affine(linear), {0, 0, 0}, {{0, false}});
      for (vec3<float>& n : mesh.normals) n = {0, 0, 0};
      if (cancelling) { // corners 0 and 2 of the first triangle oppose each other; the middle between them
        mesh.normals[mesh.triangles[0][0]] = {0.6f, 0.8f, 0};
        mesh.normals[mesh.triangles[0][2]] = {-0.6f, -0.8f, 0};
      }
      const Surface bare = place_mesh(mesh, test::affine(linear), {0, 0, 0}, {{0, false}});
      const TrianglePlanes planes = Projection::texture(0, 10, 10).planes(bare, 0);
      const Fragment<double> f = make_fragment(bare, 0, planes, 5, 5);
      EXPECT_TRUE(f.normal_is_absent);
      EXPECT_LT(max_abs(normalize_or_zero(f.normal) - whole.normals[0]), 1e-12);
      EXPECT_FALSE(make_fragment(whole, 0, planes, 5, 5).normal_is_absent);
    }
}

TEST(Fragment, WithoutAnInterpolatedNormalIsBumpedAlikeAtEveryScale) {
  const vec2<double> deriv{0.3, -0.4};
  const auto perturbed = [&](double scale) {
    mesh::TriangleMesh mesh = test::plane(1);
    const mat4<double> placement = test::affine(test::scaling({scale, scale, scale}));
    const Surface whole = place_mesh(mesh, placement, {0, 0, 0}, {{0, true}});
    for (vec3<float>& n : mesh.normals) n = {0, 0, 0};
    const Surface bare = place_mesh(mesh, placement, {0, 0, 0}, {{0, false}});
    const TrianglePlanes planes = Projection::texture(0, 10, 10).planes(bare, 0);
    const UvFragment<double> uv = make_fragment(whole, 0, planes, 5, 5).uvs[0];
    const Fragment<double> f = make_fragment(bare, 0, planes, 5, 5);
    EXPECT_TRUE(f.normal_is_absent);
    const TangentFrame<double> basis = mikktspace_basis(f.normal, uv.tangent, uv.sign);
    return resolve_normal(make_frame(f.normal, f.dp_dx, f.dp_dy),
                          from_tbn(deriv, basis.tangent, basis.bitangent));
  };
  // Unit tangents and normal: the length of the gradient is that of the slope. 1e-7 for tangents in
  // float, which the three scales share.
  EXPECT_NEAR(perturbed(1).z, 1 / std::sqrt(1 + dot(deriv, deriv)), 1e-7);
  for (const double scale : {0.01, 100.0}) // 1e-14: dozens of roundings of double
    EXPECT_LT(max_abs(perturbed(scale) - perturbed(1)), 1e-14) << scale;
}

} // namespace
} // namespace surfgrad::raster
