#include "mesh/mikktspace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace surfgrad::mesh {
namespace {

using float3 = vec3<float>;

constexpr float pi = std::numbers::pi_v<float>;

// Tangents are the normalised float sum of a few unit vectors: each of the some ten operations on
// the way rounds by half an epsilon of 1.2e-7, mostly in different directions.
constexpr float float_rounding = 1e-6f;

/// Position, normal and texture coordinate.
struct Vertex {
  float3 position, normal;
  vec2<float> uv;
};

TriangleMesh make_mesh(const std::vector<Vertex>& vertices,
                       std::vector<std::array<std::uint32_t, 3>> triangles) {
  TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  for (const Vertex& v : vertices) {
    mesh.positions.push_back(v.position);
    mesh.normals.push_back(v.normal);
    mesh.uv_sets[0].push_back(v.uv);
  }
  mesh.triangles = std::move(triangles);
  return mesh;
}

/// surface(u, v) -> Vertex over the unit square; counter-clockwise where it keeps orientation.
template <class Surface>
TriangleMesh make_grid(std::uint32_t columns, std::uint32_t rows, Surface surface) {
  std::vector<Vertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) {
      vertices.push_back(surface(static_cast<float>(i) / static_cast<float>(columns),
                                 static_cast<float>(j) / static_cast<float>(rows)));
      if (i == columns || j == rows) continue;
      const std::uint32_t a = j * (columns + 1) + i;
      const std::uint32_t c = a + columns + 2;
      triangles.push_back({a, a + 1, c});
      triangles.push_back({a, c, c - 1});
    }
  return make_mesh(vertices, triangles);
}

Vertex on_torus(float u, float v) {
  const float a = 2 * pi * u;
  const float b = 2 * pi * v;
  const float3 n{std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b)};
  return {{(2 + std::cos(b)) * std::cos(a), (2 + std::cos(b)) * std::sin(a), std::sin(b)}, n, {u, v}};
}

/// A bumpy torus whose second half mirrors the texture of the first.
TriangleMesh make_mirrored_torus(unsigned seed) {
  std::printf("seed %u\n", seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> noise(-0.02f, 0.02f);
  return make_grid(40, 24, [&](float u, float v) {
    Vertex vertex = on_torus(u, v);
    vertex.position = vertex.position + float3{noise(random), noise(random), noise(random)};
    vertex.uv.x = u < 0.5f ? u : 1 - u;
    return vertex;
  });
}

float3 xyz(const vec4<float>& v) { return {v.x, v.y, v.z}; }

float distance(const vec4<float>& a, const vec4<float>& b) {
  return std::max(max_abs(xyz(a) - xyz(b)), std::abs(a.w - b.w));
}

void expect_corner(const vec4<float>& actual, const vec4<float>& expected, float tolerance) {
  EXPECT_LE(distance(actual, expected), tolerance)
      << actual.x << ' ' << actual.y << ' ' << actual.z << ' ' << actual.w << " instead of " << expected.x
      << ' ' << expected.y << ' ' << expected.z << ' ' << expected.w;
}

float worst_distance(const TangentSpace& a, const TangentSpace& b) {
  EXPECT_EQ(a.corners.size(), b.corners.size());
  float worst = 0;
  for (std::size_t i = 0; i < std::min(a.corners.size(), b.corners.size()); ++i)
    worst = std::max(worst, distance(a.corners[i], b.corners[i]));
  return worst;
}

float texture_area(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  const std::vector<vec2<float>>& uv = mesh.uv_sets[0];
  return cross(uv[j] - uv[i], uv[k] - uv[i]);
}

TEST(GenerateTangents, equals_the_reference_on_a_mesh_with_every_kind_of_triangle) {
  const TriangleMesh mesh = make_mesh({{{0, 0, 0}, {0, 0, 1}, {0, 0}},
                                       {{1, 0, 0.25f}, {0, -0.6f, 0.8f}, {0.5f, 0}},
                                       {{2, 0, 0}, {0.6f, 0, 0.8f}, {0, 0}},
                                       {{0, 1, 0}, {0, 0, 1}, {0, 0.5f}},
                                       {{1, 1, 0.5f}, {0, 0, 1}, {0.5f, 0.625f}},
                                       {{2, 1, 0}, {0.6f, 0, 0.8f}, {0, 0.5f}},
                                       {{0, 2, 0}, {0, 0.6f, 0.8f}, {0, 1}},
                                       {{1, 2, 0.25f}, {0, 0, 1}, {0.5f, 1}},
                                       {{1, 3, 0}, {0, 0, 1}, {0.25f, 1}},
                                       {{1, 3, 0}, {0, 0.6f, 0.8f}, {0.375f, 1}},
                                       {{5, 0, 0}, {0, 1, 0}, {0, 0}},
                                       {{6, 0, 0}, {0, 1, 0}, {1, 0}},
                                       {{5, 0, 1}, {0, 1, 0}, {0.5f, 0}}},
                                      {{0, 1, 4},
                                       {0, 4, 3},
                                       {1, 2, 5},
                                       {1, 5, 4},
                                       {3, 4, 7},
                                       {3, 7, 6},
                                       {4, 5, 7},      // two mirrored halves
                                       {6, 7, 8},      // no texture area
                                       {8, 9, 7},      // 8 and 9 coincide
                                       {10, 11, 12}}); // no texture area, no neighbours
  // Printed by the npm package mikktspace 1.1.1 for the same corners and coordinates.
  const std::vector<vec4<float>> expected{
      {0.992507577f, -0.122183271f, 0, 1},
      {0.988936365f, 0.118672371f, 0.0890042633f, 1},
      {0.975349844f, -0.22066465f, 0, 1},
      {0.992507577f, -0.122183271f, 0, 1},
      {0.975349844f, -0.22066465f, 0, 1},
      {0.979425728f, -0.201804906f, 0, 1},
      {-0.992054105f, 0.100649759f, 0.0754872784f, -1},
      {-0.799999893f, 0, 0.599999964f, -1},
      {-0.789897025f, -0.158422947f, 0.592422783f, -1},
      {-0.992054105f, 0.100649759f, 0.0754872784f, -1},
      {-0.789897025f, -0.158422947f, 0.592422783f, -1},
      {-0.966499686f, -0.256667972f, 0, -1},
      {0.979425728f, -0.201804906f, 0, 1},
      {0.975349844f, -0.22066465f, 0, 1},
      {0.987087429f, -0.160182253f, 0, 1},
      {0.979425728f, -0.201804906f, 0, 1},
      {0.987087429f, -0.160182253f, 0, 1},
      {0.988936424f, -0.118672378f, 0.0890042633f, 1},
      {-0.966499686f, -0.256667972f, 0, -1},
      {-0.789897025f, -0.158422947f, 0.592422783f, -1},
      {-0.948683262f, -0.316227764f, 0, -1},
      {0.988936424f, -0.118672378f, 0.0890042633f, 1},
      {0.987087429f, -0.160182253f, 0, 1},
      {1, 0, 0, -1},
      {1, 0, 0, -1},
      {1, 0, 0, -1},
      {0.987087429f, -0.160182253f, 0, 1},
      {1, 0, 0, -1},
      {1, 0, 0, -1},
      {1, 0, 0, -1},
  };
  const TangentSpace tangents = generate_tangents(mesh, 0);
  ASSERT_EQ(tangents.corners.size(), expected.size());
  float worst = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE(i);
    worst = std::max(worst, distance(tangents.corners[i], expected[i]));
    // Equal to the bit with the reference's arccosine; another may round differently once.
    expect_corner(tangents.corners[i], expected[i], 2 * std::numeric_limits<float>::epsilon());
  }
  std::printf("worst difference from the reference %.3g\n", static_cast<double>(worst));
}

TEST(GenerateTangents, of_a_plane_with_straight_texture_are_the_axes_exactly) {
  const TriangleMesh mesh = make_grid(4, 4, [](float u, float v) {
    return Vertex{{2 * u, 4 * v, 0}, {0, 0, 1}, {u, v}};
  });
  for (const vec4<float>& c : generate_tangents(mesh, 0).corners) expect_corner(c, {1, 0, 0, 1}, 0);
}

TEST(GenerateTangents, with_t_downward_keep_the_tangent_and_negate_the_sign) {
  TriangleMesh mesh = make_mirrored_torus(1);
  const TangentSpace up = generate_tangents(mesh, 0);
  for (vec2<float>& uv : mesh.uv_sets[0]) uv.y = -uv.y;
  const TangentSpace down = generate_tangents(mesh, 0);
  for (std::size_t i = 0; i < up.corners.size(); ++i) {
    const vec4<float> c = up.corners[i];
    expect_corner(down.corners[i], {c.x, c.y, c.z, -c.w}, 0);
  }
}

TEST(GenerateTangents, are_unit_perpendicular_and_signed_by_the_texture_area) {
  const TriangleMesh mesh = make_mirrored_torus(2);
  const TangentSpace tangents = generate_tangents(mesh, 0);
  float worst_length = 0;
  float worst_angle = 0;
  for (std::size_t i = 0; i < tangents.corners.size(); ++i) {
    const vec4<float> c = tangents.corners[i];
    worst_length = std::max(worst_length, std::abs(length(xyz(c)) - 1));
    worst_angle = std::max(worst_angle, std::abs(dot(xyz(c), mesh.normals[mesh.triangles[i / 3][i % 3]])));
    EXPECT_EQ(c.w, texture_area(mesh, i / 3) > 0 ? 1 : -1) << i;
  }
  std::printf("worst length error %.3g, worst cosine with the normal %.3g\n",
              static_cast<double>(worst_length), static_cast<double>(worst_angle));
  EXPECT_LE(worst_length, float_rounding);
  EXPECT_LE(worst_angle, float_rounding);
}

/// Largest distance between the tangents of a torus of n by n quads and dP/ds at their vertices. The
/// texture is s = u, t = v + sin(2 pi u) / 8, so that +s crosses the lines of the grid.
float torus_error(std::uint32_t n) {
  const TriangleMesh mesh = make_grid(n, n, [](float u, float v) {
    Vertex vertex = on_torus(u, v);
    vertex.uv.y += std::sin(2 * pi * u) / 8;
    return vertex;
  });
  const TangentSpace tangents = generate_tangents(mesh, 0);
  float worst = 0;
  for (std::size_t i = 0; i < tangents.corners.size(); ++i) {
    const std::uint32_t index = mesh.triangles[i / 3][i % 3];
    const std::uint32_t column = index % (n + 1);
    const std::uint32_t row = index / (n + 1);
    // At the border of the grid the mean is one-sided.
    if (column == 0 || row == 0 || column == n || row == n) continue;
    const float a = 2 * pi * static_cast<float>(column) / static_cast<float>(n);
    const float b = 2 * pi * static_cast<float>(row) / static_cast<float>(n);
    const float3 dp_du = (2 * pi * (2 + std::cos(b))) * float3{-std::sin(a), std::cos(a), 0};
    const float3 dp_dv =
        (2 * pi) * float3{-std::sin(b) * std::cos(a), -std::sin(b) * std::sin(a), std::cos(b)};
    const float dv_du = -2 * pi * std::cos(a) / 8; // where t stays
    const float3 t = normalize_or_zero(dp_du + dv_du * dp_dv);
    worst = std::max(worst, distance(tangents.corners[i], {t.x, t.y, t.z, 1}));
  }
  return worst;
}

TEST(GenerateTangents, converge_to_the_derivative_of_the_surface) {
  const float coarse = torus_error(32);
  const float fine = torus_error(64);
  std::printf("distance from dP/ds: %.3g with 32 quads, %.3g with 64\n", static_cast<double>(coarse),
              static_cast<double>(fine));
  EXPECT_GT(fine, 1e-5f); // else the ratio below would compare rounding
  // The six triangles around a vertex of a regular grid lie point-symmetrically, so the terms of
  // first order in the step cancel: a quarter is expected, a third leaves room for higher orders.
  EXPECT_LT(fine, coarse / 3);
}

TEST(GenerateTangents, turn_with_the_mesh) {
  TriangleMesh mesh = make_mirrored_torus(3);
  const TangentSpace before = generate_tangents(mesh, 0);
  // Turns by 3-4-5 triangles about z, then x.
  const mat3<float> rotation = mat3<float>{{1, 0, 0}, {0, 0.6f, -0.8f}, {0, 0.8f, 0.6f}} *
                               mat3<float>{{0.8f, -0.6f, 0}, {0.6f, 0.8f, 0}, {0, 0, 1}};
  for (float3& p : mesh.positions) p = rotation * p;
  for (float3& n : mesh.normals) n = rotation * n;
  const TangentSpace after = generate_tangents(mesh, 0);
  float worst = 0;
  for (std::size_t i = 0; i < before.corners.size(); ++i) {
    const float3 turned = rotation * xyz(before.corners[i]);
    worst = std::max(worst, distance(after.corners[i], {turned.x, turned.y, turned.z, before.corners[i].w}));
  }
  std::printf("worst difference after turning %.3g\n", static_cast<double>(worst));
  // Turning rounds coordinates of up to 3 by 2e-7; the shortest edges, of about 0.1, see 20 times that.
  EXPECT_LE(worst, 2e-5f);
}

TEST(GenerateTangents, do_not_depend_on_the_order_of_triangles) {
  TriangleMesh mesh = make_mirrored_torus(4);
  const TangentSpace sorted = generate_tangents(mesh, 0);
  std::vector<std::size_t> order(mesh.triangles.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::mt19937 random(5);
  for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random() % (i + 1)]);
  TriangleMesh shuffled = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) {
    shuffled.triangles[i] = mesh.triangles[order[i]];
    std::rotate(shuffled.triangles[i].begin(), shuffled.triangles[i].begin() + 1,
                shuffled.triangles[i].end());
  }
  const TangentSpace tangents = generate_tangents(shuffled, 0);
  float worst = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      worst =
          std::max(worst, distance(tangents.corners[3 * i + k], sorted.corners[3 * order[i] + (k + 1) % 3]));
  std::printf("worst difference after shuffling %.3g\n", static_cast<double>(worst));
  EXPECT_LE(worst, 5 * float_rounding); // another first corner differences other edges, of about 0.1
}

TEST(GenerateTangents, do_not_depend_on_indexing) {
  const TriangleMesh mesh = make_mirrored_torus(6);
  TriangleMesh unwelded;
  unwelded.uv_sets.resize(1);
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(unwelded.positions.size());
    unwelded.triangles.push_back({first, first + 1, first + 2});
    for (const std::uint32_t index : triangle) {
      unwelded.positions.push_back(mesh.positions[index]);
      unwelded.normals.push_back(mesh.normals[index]);
      unwelded.uv_sets[0].push_back(mesh.uv_sets[0][index]);
    }
  }
  EXPECT_EQ(worst_distance(generate_tangents(mesh, 0), generate_tangents(unwelded, 0)), 0);
}

TEST(GenerateTangents, weld_zeros_of_both_signs) {
  TriangleMesh mesh = make_grid(1, 1, [](float u, float v) {
    return Vertex{{u, v, u * v}, {0, 0, 1}, {u, v + 0.5f * u * v}};
  });
  const TangentSpace shared = generate_tangents(mesh, 0);
  mesh.positions.push_back({-0.0f, -0.0f, -0.0f});
  mesh.normals.push_back({-0.0f, -0.0f, 1});
  mesh.uv_sets[0].push_back({-0.0f, -0.0f});
  ASSERT_EQ(mesh.triangles[1][0], 0u);
  mesh.triangles[1][0] = 4;
  EXPECT_EQ(worst_distance(shared, generate_tangents(mesh, 0)), 0);
  EXPECT_EQ(distance(shared.corners[0], shared.corners[3]), 0);
}

/// Two quads side by side in the plane z = 0; the texture coordinates of the second are given
/// apart, in the order lower left, lower right, upper right, upper left.
TriangleMesh make_two_quads(const std::array<vec2<float>, 4>& second) {
  return make_mesh({{{0, 0, 0}, {0, 0, 1}, {0, 0}},
                    {{1, 0, 0}, {0, 0, 1}, {1, 0}},
                    {{1, 1, 0}, {0, 0, 1}, {1, 1}},
                    {{0, 1, 0}, {0, 0, 1}, {0, 1}},
                    {{1, 0, 0}, {0, 0, 1}, second[0]},
                    {{2, 0, 0}, {0, 0, 1}, second[1]},
                    {{2, 1, 0}, {0, 0, 1}, second[2]},
                    {{1, 1, 0}, {0, 0, 1}, second[3]}},
                   {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
}

TEST(GenerateTangents, split_where_the_texture_mirrors_though_vertices_are_shared) {
  const TangentSpace tangents = generate_tangents(make_two_quads({{{1, 0}, {0, 0}, {0, 1}, {1, 1}}}), 0);
  for (std::size_t i = 0; i < 6; ++i) expect_corner(tangents.corners[i], {1, 0, 0, 1}, 0);
  for (std::size_t i = 6; i < 12; ++i) expect_corner(tangents.corners[i], {-1, 0, 0, -1}, 0);
}

TEST(GenerateTangents, split_at_a_seam_of_the_texture) {
  // The second quad's texture is turned by a quarter: its +s is +y.
  const TangentSpace tangents = generate_tangents(make_two_quads({{{5, 1}, {5, 0}, {6, 0}, {6, 1}}}), 0);
  for (std::size_t i = 0; i < 6; ++i) expect_corner(tangents.corners[i], {1, 0, 0, 1}, 0);
  for (std::size_t i = 6; i < 12; ++i) expect_corner(tangents.corners[i], {0, 1, 0, 1}, 0);
}

TEST(GenerateTangents, average_across_an_edge_of_one_texture_weighted_by_angles) {
  // In the second quad the texture is sheared: over the lower triangle +s is (1, -1) / sqrt 2.
  const TriangleMesh mesh = make_two_quads({{{1, 0}, {2, 1}, {2, 2}, {1, 1}}});
  const TangentSpace tangents = generate_tangents(mesh, 0);
  // Vertex 4 joins the quarter turn of triangle 0's corner 1 and two eighths of the second quad.
  const float h = std::numbers::sqrt2_v<float> / 2;
  const float3 mean = normalize_or_zero(float3{1 + h, -h, 0});
  for (const std::size_t corner : {std::size_t{1}, std::size_t{6}, std::size_t{9}})
    expect_corner(tangents.corners[corner], {mean.x, mean.y, 0, 1}, float_rounding);
  expect_corner(tangents.corners[0], {1, 0, 0, 1}, 0);
}

TEST(GenerateTangents, do_not_average_opposed_directions) {
  // Around the middle of a square +s turns by a quarter from triangle to triangle.
  std::vector<Vertex> vertices{{{0, 0, 0}, {0, 0, 1}, {0.5f, 1}}};
  const std::array<float3, 5> ring{{{1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}}};
  for (std::size_t i = 0; i < 5; ++i)
    vertices.push_back({ring[i], {0, 0, 1}, {static_cast<float>(i) / 4, 0}});
  const TangentSpace tangents =
      generate_tangents(make_mesh(vertices, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}), 0);
  // Each is averaged with its two neighbours, which cancel, and not with the opposite one.
  const std::array<vec4<float>, 4> expected{{{-1, 0, 0, 1}, {0, -1, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}}};
  for (std::size_t i = 0; i < 4; ++i) expect_corner(tangents.corners[3 * i], expected[i], float_rounding);
}

TEST(GenerateTangents, pair_the_triangles_of_a_crowded_edge_in_order) {
  // Two triangles run along the edge 0-1 and three against it: the first of each are neighbours, and
  // the second; the last is alone.
  const TriangleMesh mesh = make_mesh({{{0, 0, 0}, {0, 0, 1}, {0, 0}},
                                       {{1, 0, 0}, {0, 0, 1}, {1, 0.5f}},
                                       {{0, 1, 0}, {0, 0, 1}, {0, 1}},
                                       {{0, 2, 0}, {0, 0, 1}, {-0.5f, 1}},
                                       {{1, -1, 0}, {0, 0, 1}, {1.5f, -1}},
                                       {{0, -1, 0}, {0, 0, 1}, {-0.5f, -1}},
                                       {{1, -2, 0}, {0, 0, 1}, {2, -3}}},
                                      {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 5}, {1, 0, 6}});
  const std::vector<vec4<float>> tangents = generate_tangents(mesh, 0).corners;
  for (const std::size_t along : {0, 1})
    for (const std::size_t against : {2, 3, 4}) {
      SCOPED_TRACE(testing::Message() << along << " and " << against);
      const float at_0 = distance(tangents[3 * along], tangents[3 * against + 1]);
      const float at_1 = distance(tangents[3 * along + 1], tangents[3 * against]);
      if (against == along + 2) {
        EXPECT_EQ(at_0, 0);
        EXPECT_EQ(at_1, 0);
      } else {
        EXPECT_GT(at_0, 0.01f); // a degree is 0.02
        EXPECT_GT(at_1, 0.01f);
      }
    }
}

TEST(GenerateTangents, are_not_averaged_across_a_hard_edge) {
  // A roof: both sides share positions and texture along the ridge, each has its own normal there.
  const TriangleMesh mesh = make_mesh({{{0, 0, 0}, {-0.6f, 0, 0.8f}, {0, 0}},
                                       {{4, 0, 3}, {-0.6f, 0, 0.8f}, {1, 0}},
                                       {{4, 1, 3}, {-0.6f, 0, 0.8f}, {1, 1}},
                                       {{4, 0, 3}, {0.6f, 0, 0.8f}, {1, 0}},
                                       {{8, 0, 0}, {0.6f, 0, 0.8f}, {2, 0.5f}},
                                       {{4, 1, 3}, {0.6f, 0, 0.8f}, {1, 1}}},
                                      {{0, 1, 2}, {3, 4, 5}});
  const std::vector<vec4<float>> tangents = generate_tangents(mesh, 0).corners;
  for (std::size_t i = 0; i < 3; ++i) expect_corner(tangents[i], {0.8f, 0, 0.6f, 1}, float_rounding);
  // Along +s of the right side, y falls by half for every 5 of slope.
  const float3 right = normalize_or_zero(float3{4, -0.5f, -3});
  for (std::size_t i = 3; i < 6; ++i)
    expect_corner(tangents[i], {right.x, right.y, right.z, 1}, float_rounding);
}

TEST(GenerateTangents, without_texture_area_follow_the_neighbour_and_give_it_nothing) {
  TriangleMesh mesh = make_grid(1, 1, [](float u, float v) { return Vertex{{u, v, 0}, {0, 0, 1}, {u, v}}; });
  mesh.uv_sets[0][2] = {0.5f, 0.5f}; // the upper left: triangle 1 collapses onto its diagonal
  ASSERT_EQ(texture_area(mesh, 1), 0);
  const TangentSpace tangents = generate_tangents(mesh, 0);
  for (const std::size_t i : {0, 1, 2, 3, 4}) expect_corner(tangents.corners[i], {1, 0, 0, 1}, 0);
  expect_corner(tangents.corners[5], {1, 0, 0, -1}, 0); // no sound triangle at that vertex
}

TEST(GenerateTangents, are_finite_with_unit_signs_whatever_the_input) {
  constexpr unsigned seed = 7;
  std::printf("seed %u\n", seed);
  std::mt19937 random(seed);
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr std::array values{0.0f,
                              -0.0f,
                              1.0f,
                              -1.0f,
                              2.0f,
                              1e-42f,
                              -1e-38f,
                              1e-20f,
                              1e20f,
                              3e38f,
                              -3e38f,
                              inf,
                              std::numeric_limits<float>::quiet_NaN()};
  for (int repeat = 0; repeat < 2000; ++repeat) {
    // Every other mesh without Inf and NaN, so that overflow is met on its own.
    const std::size_t kinds = repeat % 2 == 0 ? values.size() : values.size() - 2;
    const auto any = [&] { return values[random() % kinds]; };
    std::vector<Vertex> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (int i = 0; i < 10; ++i)
      vertices.push_back({{any(), any(), any()}, {any(), any(), any()}, {any(), any()}});
    const auto index = [&] { return static_cast<std::uint32_t>(random() % 10); };
    for (int i = 0; i < 20; ++i) triangles.push_back({index(), index(), index()});
    for (const vec4<float>& c : generate_tangents(make_mesh(vertices, triangles), 0).corners) {
      ASSERT_TRUE(std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z)) << "mesh " << repeat;
      ASSERT_EQ(std::abs(c.w), 1) << "mesh " << repeat;
      ASSERT_LE(length(xyz(c)), 1 + float_rounding) << "mesh " << repeat;
    }
  }
}

// Big enough to overflow a call stack and to run for hours if a step were quadratic.
constexpr std::uint32_t crowd = 200'000;

TEST(GenerateTangents, survive_a_vertex_with_very_many_triangles) {
  for (const bool turning : {false, true}) {
    std::vector<Vertex> vertices{{{0, 0, 0}, {0, 0, 1}, {0, 0}}};
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::uint32_t i = 0; i <= crowd; ++i) {
      const float a = 2 * pi * static_cast<float>(i) / crowd;
      const float3 p{std::cos(a), std::sin(a), 0};
      // Straight texture, or one that turns around the vertex: there opposed directions meet.
      const vec2<float> uv = turning ? vec2<float>{static_cast<float>(i) / crowd, -1} : vec2<float>{p.x, p.y};
      vertices.push_back({p, {0, 0, 1}, uv});
      if (i > 0) triangles.push_back({0, i, i + 1});
    }
    const TangentSpace tangents = generate_tangents(make_mesh(vertices, triangles), 0);
    if (turning) {
      EXPECT_LE(length(xyz(tangents.corners[0])), 1 + float_rounding);
      EXPECT_EQ(tangents.corners[0].w, 1);
    } else {
      // The edges of 3e-5 are differences of coordinates that round by 6e-8: 2e-3 each at worst, with
      // errors that cancel over the fan.
      expect_corner(tangents.corners[0], {1, 0, 0, 1}, 2e-3f);
    }
  }
}

TEST(GenerateTangents, survive_an_edge_with_very_many_triangles) {
  std::vector<Vertex> vertices{{{0, 0, 0}, {0, 0, 1}, {0, 0}}, {{1, 0, 0}, {0, 0, 1}, {1, 0}}};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < crowd; ++i) {
    const float height = 1 + static_cast<float>(i) / crowd;
    vertices.push_back({{0, height, 0}, {0, 0, 1}, {0, height}});
    triangles.push_back({0, 1, i + 2});
  }
  for (const vec4<float>& c : generate_tangents(make_mesh(vertices, triangles), 0).corners)
    ASSERT_LE(distance(c, {1, 0, 0, 1}), float_rounding);
}

TEST(GenerateTangents, of_an_empty_mesh_are_empty) {
  TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  EXPECT_TRUE(generate_tangents(mesh, 0).corners.empty());
}

TEST(GenerateTangents, use_the_uv_set_asked_for) {
  TriangleMesh mesh = make_grid(2, 2, [](float u, float v) { return Vertex{{u, v, 0}, {0, 0, 1}, {u, v}}; });
  mesh.uv_sets.push_back({});
  for (const vec2<float>& uv : mesh.uv_sets[0]) mesh.uv_sets[1].push_back({uv.y, uv.x});
  for (const vec4<float>& c : generate_tangents(mesh, 1).corners) expect_corner(c, {0, 1, 0, -1}, 0);
}

TEST(GenerateTangentsDeathTest, a_missing_uv_set_is_an_assertion) {
#ifdef NDEBUG
  GTEST_SKIP() << "assertions are compiled out of this build";
#else
  TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  EXPECT_DEATH((void)generate_tangents(mesh, 1), "uv_set");
#endif
}

} // namespace
} // namespace surfgrad::mesh
