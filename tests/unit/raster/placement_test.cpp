// A mesh under an object transform: normals stay outward and perpendicular, tangents keep their sign
// convention.

#include "mesh/mikktspace.hpp"
#include "raster/surface.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::raster {
namespace {

struct Transform {
  const char* name;
  mat3<double> linear;
};

std::vector<Transform> transforms() {
  test::Random random(81);
  const mat3<double> r = random.rotation();
  return {{"rotation", r},
          {"uniform scale", r * test::scaling({3, 3, 3})},
          {"non-uniform scale", r * test::scaling({0.5, 2, 1}) * random.rotation()},
          {"mirror", r * test::scaling({-1, 1, 1})},
          {"point reflection", test::scaling({-2, -2, -2})},
          {"two axes negated", test::scaling({-1, 1, -3})}};
}

TEST(Placement, KeepsNormalsUnitOutwardAndPerpendicular) {
  const mesh::TriangleMesh mesh = test::plane(1);
  // The plane's normal must stay perpendicular to its transformed edges, on the side that the solid
  // below it does not have.
  for (const Transform& t : transforms()) {
    SCOPED_TRACE(t.name);
    const Surface s = place_mesh(mesh, test::affine(t.linear, {1, 2, 3}), {0.5, 0, 0}, {});
    EXPECT_EQ(s.mirrored, determinant(t.linear) < 0);
    const vec3<double> inside = t.linear * vec3<double>{0, 0, -1};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const vec3<double> expected = t.linear * test::widen(mesh.positions[v]) + vec3<double>{0.5, 2, 3};
      EXPECT_LT(max_abs(s.positions[v] - expected), 1e-14);
      EXPECT_NEAR(length(s.normals[v]), 1, 1e-14);
      EXPECT_LT(dot(s.normals[v], inside), 0);
      EXPECT_NEAR(dot(s.normals[v], s.positions[1] - s.positions[0]), 0, 1e-13);
      EXPECT_NEAR(dot(s.normals[v], s.positions[2] - s.positions[0]), 0, 1e-13);
    }
  }
}

TEST(Placement, KeepsTheBitangentAlongT) {
  // On a plane sign * cross(n, t) is where the texture's t grows, whatever the transform does.
  const mesh::TriangleMesh mesh = test::plane(1);
  for (const Transform& t : transforms()) {
    SCOPED_TRACE(t.name);
    const Surface s = place_mesh(mesh, test::affine(t.linear), {0, 0, 0}, {{0, true}});
    ASSERT_EQ(s.slots[0].tangents.size(), 6u);
    const vec3<double> along_s = t.linear * vec3<double>{1, 0, 0};
    const vec3<double> along_t = t.linear * vec3<double>{0, 1, 0};
    for (const vec4<double>& tangent : s.slots[0].tangents) {
      const vec3<double> direction{tangent.x, tangent.y, tangent.z};
      EXPECT_NEAR(length(direction), 1, 1e-14);
      EXPECT_LT(max_abs(direction - normalize_or_zero(along_s)), 1e-7); // float tangents
      EXPECT_GT(dot(tangent.w * cross(s.normals[0], direction), along_t), 0);
    }
  }
}

TEST(Placement, TellsTheSideOfMirroredObjectsByTheirNormal) {
  const mesh::TriangleMesh mesh = test::plane(1);
  test::Random random(82);
  for (const Transform& t : transforms()) {
    SCOPED_TRACE(t.name);
    for (int k = 0; k < 20; ++k) {
      // Seen in parallel along a random direction: screen x, y, towards the viewer.
      const mat3<double> view = random.rotation();
      const Surface s = place_mesh(mesh, test::affine(t.linear), {0, 0, 0}, {});
      std::array<vec3<double>, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const vec3<double> p = view * s.positions[mesh.triangles[0][i]];
        corners[i] = {p.x, p.y, 1};
      }
      const TrianglePlanes planes(corners);
      const Fragment<double> f = make_fragment(s, 0, planes, 0, 0);
      EXPECT_EQ(f.front_facing, dot(s.normals[0], view.z) > 0);
    }
  }
}

TEST(Placement, UsesTheTangentsOfTheFileWhereGiven) {
  mesh::TriangleMesh mesh = test::plane(1);
  mesh.tangent_spaces.resize(1);
  mesh.tangent_spaces[0].corners.assign(6, {0, 1, 0, -1});
  const Surface given =
      place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, true}, {3, true}});
  EXPECT_EQ(given.slots[0].tangents[4].y, 1);
  EXPECT_EQ(given.slots[0].tangents[4].w, -1);
  EXPECT_FALSE(given.slots[1].present);
  mesh.tangent_spaces[0].corners.clear();
  const Surface made = place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, true}});
  EXPECT_EQ(made.slots[0].tangents[4].x, 1);
  EXPECT_TRUE(place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, false}})
                  .slots[0]
                  .tangents.empty());
}

TEST(Placement, MakesTangentsForEveryUvSetThatLayersUse) {
  mesh::TriangleMesh mesh = test::plane(2);
  mesh.uv_sets.resize(3);
  for (const vec2<float>& uv : mesh.uv_sets[0]) {
    mesh.uv_sets[1].push_back({uv.y, uv.x});
    mesh.uv_sets[2].push_back({-uv.x, uv.y});
  }
  // The file has tangents for the first set alone: the others must not take them.
  mesh.tangent_spaces.resize(1);
  mesh.tangent_spaces[0].corners.assign(3 * mesh.triangles.size(), {0.6f, 0.8f, 0, 1});
  const Surface s = place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0},
                               {{2, true}, {0, true}, {1, true}, {1, false}});
  const vec4<double> expected[] = {{-1, 0, 0, -1}, {0.6f, 0.8f, 0, 1}, {0, 1, 0, -1}};
  for (std::size_t slot = 0; slot < 3; ++slot) {
    ASSERT_EQ(s.slots[slot].tangents.size(), 3 * mesh.triangles.size());
    for (const vec4<double>& t : s.slots[slot].tangents) {
      EXPECT_LT(max_abs(vec3<double>{t.x - expected[slot].x, t.y - expected[slot].y, t.z}), 1e-7); // of float
      EXPECT_EQ(t.w, expected[slot].w) << slot;
    }
  }
  EXPECT_TRUE(s.slots[3].tangents.empty());
}

TEST(Placement, SurvivesATransformThatFlattens) {
  const mesh::TriangleMesh mesh = test::torus(8, 6);
  const Surface s = place_mesh(mesh, test::affine(test::scaling({1, 1, 0})), {0, 0, 0}, {{0, true}});
  for (const vec3<double>& n : s.normals) EXPECT_TRUE(max_abs(n) <= 1);
  for (const vec4<double>& t : s.slots[0].tangents) EXPECT_TRUE(max_abs(vec3<double>{t.x, t.y, t.z}) <= 1);
}

} // namespace
} // namespace surfgrad::raster
