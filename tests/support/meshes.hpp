#pragma once

/// Meshes for tests: patches of a parametric surface, and loose triangles.

#include "mesh/triangle_mesh.hpp"

#include <cmath>
#include <numbers>

namespace surfgrad::test {

inline vec3<float> narrow(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline vec2<float> narrow(vec2<double> v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }
inline vec3<double> widen(vec3<float> v) { return {v.x, v.y, v.z}; }
inline vec2<double> widen(vec2<float> v) { return {v.x, v.y}; }

struct SurfacePoint {
  vec3<double> position;
  vec3<double> normal;
};

/// Appends a grid over (s, t) in [0, 1]^2. point(s, t) runs counter-clockwise seen from outside;
/// uv(s, t) is the texture coordinate of the first UV set.
template <class Point, class Uv>
void append_patch(mesh::TriangleMesh& mesh, int columns, int rows, const Point& point, const Uv& uv) {
  if (mesh.uv_sets.empty()) mesh.uv_sets.resize(1);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double s = static_cast<double>(i) / columns;
      const double t = static_cast<double>(j) / rows;
      const SurfacePoint p = point(s, t);
      mesh.positions.push_back(narrow(p.position));
      mesh.normals.push_back(narrow(p.normal));
      mesh.uv_sets[0].push_back(narrow(vec2<double>(uv(s, t))));
    }
  const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  mesh.material_of_triangle.resize(mesh.triangles.size(), 0);
}

inline SurfacePoint torus_point(double s, double t) {
  const double u = 2 * std::numbers::pi * s;
  const double v = 2 * std::numbers::pi * t;
  const vec3<double> n{std::cos(v) * std::sin(u), std::sin(v), std::cos(v) * std::cos(u)};
  return {vec3<double>{std::sin(u), 0, std::cos(u)} + 0.4 * n, n};
}

/// A whole torus unwrapped once over the unit square.
inline mesh::TriangleMesh torus(int columns, int rows) {
  mesh::TriangleMesh mesh;
  append_patch(mesh, columns, rows, torus_point, [](double s, double t) { return vec2<double>{s, t}; });
  return mesh;
}

/// The same torus in two halves that lie beside each other in the texture, the second one mirrored.
inline mesh::TriangleMesh half_mirrored_torus(int columns, int rows) {
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, columns / 2, rows, [](double s, double t) { return torus_point(0.5 * s, t); },
      [](double s, double t) {
        return vec2<double>{0.5 * s, t};
      });
  append_patch(
      mesh, columns / 2, rows, [](double s, double t) { return torus_point(0.5 + 0.5 * s, t); },
      [](double s, double t) {
        return vec2<double>{1 - 0.5 * s, t};
      });
  return mesh;
}

/// A unit sphere without its poles, as a latitude and longitude grid.
inline mesh::TriangleMesh sphere_band(int columns, int rows) {
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, columns, rows,
      [](double s, double t) {
        const double u = 2 * std::numbers::pi * s;
        const double v = std::numbers::pi * 0.4 * (2 * t - 1);
        const vec3<double> n{std::cos(v) * std::sin(u), std::sin(v), std::cos(v) * std::cos(u)};
        return SurfacePoint{n, n};
      },
      [](double s, double t) {
        return vec2<double>{s, t};
      });
  return mesh;
}

/// The square [-1, 1]^2 at z = 0, facing +z.
inline mesh::TriangleMesh plane(int cells) {
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, cells, cells,
      [](double s, double t) {
        return SurfacePoint{{2 * s - 1, 2 * t - 1, 0}, {0, 0, 1}};
      },
      [](double s, double t) {
        return vec2<double>{s, t};
      });
  return mesh;
}

/// Adds one triangle with vertices of its own; the normal is that of the plane through them.
inline void append_triangle(mesh::TriangleMesh& mesh, vec3<double> a, vec3<double> b, vec3<double> c) {
  if (mesh.uv_sets.empty()) mesh.uv_sets.resize(1);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const vec3<float> n = narrow(normalize_or_zero(cross(b - a, c - a)));
  for (const vec3<double>& p : {a, b, c}) {
    mesh.positions.push_back(narrow(p));
    mesh.normals.push_back(n);
    mesh.uv_sets[0].push_back(narrow(vec2<double>{p.x, p.y}));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.material_of_triangle.push_back(0);
}

inline mat4<double> affine(const mat3<double>& m, vec3<double> move = {0, 0, 0}) {
  return {{m.x.x, m.x.y, m.x.z, move.x},
          {m.y.x, m.y.y, m.y.z, move.y},
          {m.z.x, m.z.y, m.z.z, move.z},
          {0, 0, 0, 1}};
}

inline mat3<double> scaling(vec3<double> s) { return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}; }

} // namespace surfgrad::test
