#include "mesh/normals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

namespace surfgrad::mesh {
namespace {

using Positions = std::vector<vec3<float>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// The sum is taken in double: what is left is the rounding of each component to float, half an
// epsilon of at most 1.
constexpr float rounding = 0.5f * std::numeric_limits<float>::epsilon();

void expect_near(const vec3<float>& actual, const vec3<float>& expected, float tolerance) {
  EXPECT_LE(max_abs(actual - expected), tolerance)
      << actual.x << ' ' << actual.y << ' ' << actual.z << " instead of " << expected.x << ' ' << expected.y
      << ' ' << expected.z;
}

/// Corners of the cube [-1, 1]^3, numbered by the bits x, y, z; two triangles a face.
Positions cube_positions() {
  Positions positions;
  for (int i = 0; i < 8; ++i)
    positions.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  return positions;
}
const Triangles cube_triangles{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

TEST(GenerateNormals, of_a_cube_point_along_the_diagonals_however_faces_are_split) {
  const Positions positions = cube_positions();
  const std::vector<vec3<float>> normals = generate_normals(positions, cube_triangles);
  const float d = 1 / std::numbers::sqrt3_v<float>;
  ASSERT_EQ(normals.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) expect_near(normals[i], d * positions[i], 2 * rounding);
}

TEST(GenerateNormals, of_a_sphere_point_outward) {
  const int columns = 64;
  const int rows = 32;
  Positions positions;
  Triangles triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const float a = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / columns;
      // The rows stop short of the poles, where a row would collapse to a point.
      const float b = 0.9f * std::numbers::pi_v<float> * (static_cast<float>(j) / rows - 0.5f);
      positions.push_back({3 * std::cos(b) * std::cos(a), 3 * std::cos(b) * std::sin(a), 3 * std::sin(b)});
      if (j == rows) continue;
      const auto p = static_cast<std::uint32_t>(j * columns + i);
      const auto q = static_cast<std::uint32_t>(j * columns + (i + 1) % columns);
      triangles.push_back({p, q, q + columns});
      triangles.push_back({p, q + columns, p + columns});
    }
  const std::vector<vec3<float>> normals = generate_normals(positions, triangles);
  float worst = 0;
  for (std::size_t i = columns; i < positions.size() - columns; ++i)
    worst = std::max(worst, length(normals[i] - (1.0f / 3) * positions[i]));
  std::printf("worst distance from the sphere's normal %.3g\n", static_cast<double>(worst));
  // A chord of a step of 0.1 turns by 0.05 from the tangent at its ends; the six around a vertex
  // cancel but for the square of it.
  EXPECT_LT(worst, 0.05f * 0.05f);
  EXPECT_GT(worst, 0);
}

TEST(GenerateNormals, ignore_triangles_without_area) {
  Positions positions = cube_positions();
  Triangles triangles = cube_triangles;
  const std::vector<vec3<float>> expected = generate_normals(positions, triangles);
  positions.push_back({0, -1, -1}); // on the edge from vertex 0 to vertex 1
  triangles.push_back({0, 0, 5});
  triangles.push_back({0, 8, 1});
  triangles.push_back({3, 3, 3});
  const std::vector<vec3<float>> normals = generate_normals(positions, triangles);
  for (std::size_t i = 0; i < 8; ++i) expect_near(normals[i], expected[i], 0);
  expect_near(normals[8], {0, 0, 0}, 0);
}

TEST(GenerateNormals, are_zero_at_isolated_vertices_and_where_they_cancel) {
  const Positions positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}};
  const std::vector<vec3<float>> normals = generate_normals(positions, Triangles{{0, 1, 2}, {0, 2, 1}});
  for (const vec3<float>& n : normals) expect_near(n, {0, 0, 0}, 0);
  EXPECT_TRUE(generate_normals({}, {}).empty());
}

TEST(GenerateNormals, do_not_depend_on_size) {
  for (const float size : {1e-42f, 1e-30f, 1.0f, 1e30f, 3e38f}) {
    SCOPED_TRACE(size);
    const Positions positions{{0, 0, 0}, {size, 0, 0}, {0, size, 0}};
    for (const vec3<float>& n : generate_normals(positions, Triangles{{0, 1, 2}}))
      expect_near(n, {0, 0, 1}, 0);
  }
}

TEST(GenerateNormals, are_not_poisoned_by_a_neighbour_that_is_not_finite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    const Positions positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {bad, 1, 1}};
    const std::vector<vec3<float>> normals = generate_normals(positions, Triangles{{0, 1, 2}, {1, 3, 2}});
    for (std::size_t i = 0; i < 3; ++i) expect_near(normals[i], {0, 0, 1}, 0);
    expect_near(normals[3], {0, 0, 0}, 0);
  }
}

TEST(WithFlatNormals, gives_every_corner_the_normal_of_its_triangle) {
  TriangleMesh mesh;
  mesh.positions = cube_positions();
  mesh.triangles = cube_triangles;
  mesh.uv_sets.resize(2);
  for (std::size_t i = 0; i < 8; ++i) {
    mesh.uv_sets[0].push_back({static_cast<float>(i), 0});
    mesh.uv_sets[1].push_back({0, -static_cast<float>(i)});
  }
  mesh.material_of_triangle = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
  mesh.tangent_spaces.resize(2);
  mesh.tangent_spaces[1].corners.resize(36);

  const TriangleMesh flat = with_flat_normals(mesh);
  ASSERT_EQ(flat.triangles.size(), 12u);
  ASSERT_EQ(flat.positions.size(), 36u);
  ASSERT_EQ(flat.normals.size(), 36u);
  ASSERT_EQ(flat.uv_sets.size(), 2u);
  ASSERT_EQ(flat.uv_sets[1].size(), 36u);
  EXPECT_EQ(flat.material_of_triangle, mesh.material_of_triangle);
  EXPECT_TRUE(flat.tangent_spaces.empty());
  const std::array<vec3<float>, 6> outward{
      {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}}};
  for (std::size_t c = 0; c < 36; ++c) {
    SCOPED_TRACE(c);
    EXPECT_EQ(flat.triangles[c / 3][c % 3], c);
    const std::uint32_t index = mesh.triangles[c / 3][c % 3];
    expect_near(flat.positions[c], mesh.positions[index], 0);
    expect_near(flat.normals[c], outward[c / 6], 0);
    EXPECT_EQ(flat.uv_sets[0][c].x, static_cast<float>(index));
    EXPECT_EQ(flat.uv_sets[1][c].y, -static_cast<float>(index));
  }
}

TEST(WithFlatNormals, is_zero_on_triangles_without_area_and_empty_for_an_empty_mesh) {
  TriangleMesh mesh;
  EXPECT_TRUE(with_flat_normals(mesh).positions.empty());
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 1}};
  for (const vec3<float>& n : with_flat_normals(mesh).normals) expect_near(n, {0, 0, 0}, 0);
}

} // namespace
} // namespace surfgrad::mesh
