#include "oracles/hard_meshes.hpp"

#include "support/meshes.hpp"
#include "support/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace surfgrad::test {
namespace {

using mesh::TriangleMesh;

/// A torus with waves in its texture, so that no two triangles agree about a direction.
TriangleMesh wavy_torus(int columns, int rows) {
  TriangleMesh mesh;
  append_patch(mesh, columns, rows, torus_point, [](double s, double t) {
    return vec2<double>{s + 0.02 * std::sin(40 * t), t + 0.03 * std::cos(31 * s)};
  });
  return mesh;
}

/// Collapses a share of the triangles: onto a corner, onto an edge, or to a sliver between distinct vertices.
TriangleMesh with_degenerate_triangles() {
  TriangleMesh mesh = wavy_torus(24, 16);
  Random random(1);
  for (auto& triangle : mesh.triangles) switch (random.integer(8)) {
    case 0:
      triangle[1] = triangle[0];
      break;
    case 1:
      triangle = {triangle[2], triangle[2], triangle[2]};
      break;
    case 2: // another vertex at the same position
      mesh.positions[triangle[1]] = mesh.positions[triangle[2]];
      break;
    case 3:
      mesh.positions[triangle[0]] = 0.5f * (mesh.positions[triangle[1]] + mesh.positions[triangle[2]]);
      break;
    default:
      break;
    }
  return mesh;
}

/// Collapses the texture of regions, of single triangles, and turns some over.
TriangleMesh with_degenerate_texture() {
  TriangleMesh mesh = wavy_torus(24, 16);
  Random random(2);
  std::vector<vec2<float>>& uvs = mesh.uv_sets[0];
  for (std::size_t i = 0; i < uvs.size() / 4; ++i) uvs[i] = {0.5f, 0.5f};
  for (auto& triangle : mesh.triangles) switch (random.integer(8)) {
    case 0:
      uvs[triangle[0]] = uvs[triangle[1]];
      break;
    case 1: // on a line
      uvs[triangle[0]] = 0.5f * (uvs[triangle[1]] + uvs[triangle[2]]);
      break;
    case 2:
      std::swap(uvs[triangle[0]], uvs[triangle[1]]);
      break;
    default:
      break;
    }
  return mesh;
}

/// Every triangle has a texture of its own, turned or mirrored at random, over shared positions and normals:
/// some corners agree by chance, the others split.
TriangleMesh with_islands() {
  const TriangleMesh torus = wavy_torus(16, 12);
  Random random(3);
  TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  for (const auto& triangle : torus.triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const int turn = random.integer(3);
    for (const std::uint32_t vertex : triangle) {
      mesh.positions.push_back(torus.positions[vertex]);
      mesh.normals.push_back(torus.normals[vertex]);
      const vec2<float> uv = torus.uv_sets[0][vertex];
      mesh.uv_sets[0].push_back(turn == 0   ? uv
                                : turn == 1 ? vec2<float>{1 - uv.x, uv.y}
                                            : vec2<float>{uv.y, uv.x});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return mesh;
}

/// Quads that are not flat, each a fan around its first corner; which corner is first changes.
TriangleMesh of_quads() {
  TriangleMesh mesh = wavy_torus(20, 14);
  Random random(4);
  for (vec3<float>& p : mesh.positions) p = p + narrow(0.02 * random.vector3());
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 2) {
    const std::array<std::uint32_t, 4> quad{mesh.triangles[i][0], mesh.triangles[i][1], mesh.triangles[i][2],
                                            mesh.triangles[i + 1][2]};
    const auto first = static_cast<std::size_t>(random.integer(4));
    const auto at = [&](std::size_t k) { return quad[(first + k) % 4]; };
    mesh.triangles[i] = {at(0), at(1), at(2)};
    mesh.triangles[i + 1] = {at(0), at(2), at(3)};
  }
  return mesh;
}

/// Triangles around one vertex. The texture's directions turn with them by `turns`.
TriangleMesh fan(std::uint32_t count, double turns) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}};
  mesh.normals = {{0, 0, 1}};
  mesh.uv_sets = {{{0, 0}}};
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double a = 2 * std::numbers::pi * i / count;
    mesh.positions.push_back(narrow(vec3<double>{std::cos(a), std::sin(a), 0.1 * std::sin(3 * a)}));
    mesh.normals.push_back({0, 0, 1});
    mesh.uv_sets[0].push_back(narrow(vec2<double>{std::cos((1 - turns) * a), 1 + std::sin((1 - turns) * a)}));
    if (i > 0) mesh.triangles.push_back({0, i, i + 1});
  }
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return mesh;
}

/// Many triangles on both sides of one edge.
TriangleMesh crowded_edge(std::uint32_t count) {
  Random random(5);
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  mesh.normals.assign(2, {0, 0, 1});
  mesh.uv_sets = {{{0, 0}, {1, 0.25f}}};
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.positions.push_back(narrow(random.vector3()));
    mesh.normals.push_back({0, 0, 1});
    mesh.uv_sets[0].push_back(narrow(random.vector2()));
    const bool along = random.integer(2) == 0;
    mesh.triangles.push_back({along ? 0u : 1u, along ? 1u : 0u, i + 2});
  }
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, float positions, float texture) {
  for (vec3<float>& p : mesh.positions) p = positions * p;
  for (vec2<float>& uv : mesh.uv_sets[0]) uv = texture * uv;
  return mesh;
}

/// Normals that are no unit vectors, zero, or lie in the surface.
TriangleMesh with_wild_normals() {
  TriangleMesh mesh = wavy_torus(20, 14);
  Random random(6);
  for (vec3<float>& n : mesh.normals) switch (random.integer(5)) {
    case 0:
      n = {0, 0, 0};
      break;
    case 1:
      n = 7.0f * n;
      break;
    case 2:
      n = narrow(random.unit_vector());
      break;
    default:
      break;
    }
  return mesh;
}

} // namespace

std::vector<HardMesh> hard_meshes() {
  return {{"smooth", wavy_torus(32, 24)},
          {"degenerate triangles", with_degenerate_triangles()},
          {"degenerate texture", with_degenerate_texture()},
          {"mirrored halves", half_mirrored_torus(32, 24)},
          {"an island a triangle", with_islands()},
          {"quads", of_quads()},
          {"straight fan", fan(500, 0)},
          {"fan with opposed directions", fan(4, 1)},
          {"fan with many opposed directions", fan(360, 1)},
          {"straight fan beyond the size that is compared", fan(3000, 0)},
          {"crowded edge", crowded_edge(300)},
          {"tiny", scaled(wavy_torus(20, 14), 1e-12f, 1)},
          {"tiny texture", scaled(wavy_torus(20, 14), 1, 1e-12f)},
          {"texture areas below the smallest normal number", scaled(wavy_torus(20, 14), 1, 1e-20f)},
          {"huge", scaled(wavy_torus(20, 14), 1e12f, 1)},
          {"huge texture", scaled(wavy_torus(20, 14), 1, 1e12f)},
          {"wild normals", with_wild_normals()}};
}

TriangleMesh extreme_soup(unsigned seed) {
  constexpr std::array values{0.0f,   -0.0f,   1.0f,   -1.0f, 2.0f, 0.5f,
                              1e-42f, -1e-38f, 1e-20f, 1e15f, 3e9f, -1e12f};
  Random random(seed);
  const auto any = [&] { return values[static_cast<std::size_t>(random.integer(values.size()))]; };
  TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  for (int i = 0; i < 10; ++i) {
    mesh.positions.push_back({any(), any(), any()});
    mesh.normals.push_back({any(), any(), any()});
    mesh.uv_sets[0].push_back({any(), any()});
  }
  const auto vertex = [&] { return static_cast<std::uint32_t>(random.integer(10)); };
  for (int i = 0; i < 20; ++i) mesh.triangles.push_back({vertex(), vertex(), vertex()});
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return mesh;
}

TriangleMesh lattice_soup(unsigned seed) {
  Random random(seed);
  TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  const int side = 2 + random.integer(3);
  const auto on_lattice = [&] { return static_cast<float>(random.integer(side)); };
  constexpr std::array<vec3<float>, 4> normals{{{0, 0, 1}, {0, 0.6f, 0.8f}, {1, 0, 0}, {0, 0, -1}}};
  const int few_normals = 1 + random.integer(static_cast<int>(normals.size()));
  const int vertices = 6 + random.integer(30);
  for (int i = 0; i < vertices; ++i) {
    const float x = on_lattice();
    const float y = on_lattice();
    const float z = random.integer(3) == 0 ? on_lattice() : 0.0f;
    mesh.positions.push_back({x, y, z});
    mesh.normals.push_back(normals[static_cast<std::size_t>(random.integer(few_normals))]);
    // Half of the textures follow the positions, so that there are neighbours to average with.
    const float u = random.integer(2) == 0 ? x : on_lattice();
    mesh.uv_sets[0].push_back({u, random.integer(2) == 0 ? y : on_lattice()});
  }
  const auto vertex = [&] { return static_cast<std::uint32_t>(random.integer(vertices)); };
  const int triangles = 4 + random.integer(80);
  for (int i = 0; i < triangles; ++i) {
    const std::uint32_t a = vertex();
    const std::uint32_t b = vertex();
    mesh.triangles.push_back({a, b, vertex()});
  }
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return mesh;
}

} // namespace surfgrad::test
