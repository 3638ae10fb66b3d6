#include "gallery/morphs.hpp"

#include "gallery/meshes.hpp"
#include "mesh/mikktspace.hpp"
#include "mesh/morph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace surfgrad::gallery {
namespace {

using std::numbers::pi;

/// 1 at the middle of the sheet, 0 from radius 1 on; smooth.
double middle(vec3<double> p) {
  const double m = std::max(1 - p.x * p.x - p.y * p.y, 0.0);
  return m * m;
}

vec3<double> flat(double s, double t) { return {2 * s - 1, 2 * t - 1, 0}; }

vec3<double> swirled(double s, double t) {
  const vec3<double> p = flat(s, t);
  const double angle = 25 * pi / 36 * middle(p); // 125 degrees: with the stretch, a right angle
  const double c = std::cos(angle);
  const double d = std::sin(angle);
  return {c * p.x - d * p.y, d * p.x + c * p.y, 0};
}

vec3<double> stretched(double s, double t) {
  const vec3<double> p = flat(s, t);
  return {1.6 * p.x, p.y, p.z};
}

vec3<double> bulged(double s, double t) {
  const vec3<double> p = flat(s, t);
  return {p.x, p.y, 0.6 * middle(p)};
}

using Shape = vec3<double> (*)(double, double);
constexpr std::array<Shape, 3> targets{swirled, stretched, bulged};
constexpr std::array<double, 3> weights{1, 1, 1};

vec3<double> morphed(double s, double t) {
  const vec3<double> rest = flat(s, t);
  vec3<double> sum = rest;
  for (std::size_t i = 0; i < targets.size(); ++i) sum = sum + weights[i] * (targets[i](s, t) - rest);
  return sum;
}

template <class Surface>
SurfacePoint point_of(const Surface& surface, double s, double t) {
  // Central differences: exact to step^2 and 1e-16 / step, far beyond the floats they become.
  constexpr double step = 1e-5;
  const vec3<double> along_s = surface(s + step, t) - surface(s - step, t);
  const vec3<double> along_t = surface(s, t + step) - surface(s, t - step);
  return {surface(s, t), normalize_or_zero(cross(along_s, along_t))};
}

template <class Surface>
mesh::TriangleMesh mesh_of(int cells, const Surface& surface) {
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, cells, cells, [&](double s, double t) { return point_of(surface, s, t); },
      [](double s, double t) {
        return vec2<double>{s, t};
      });
  return mesh;
}

/// MikkTSpace tangents at the vertices: of a smooth patch all corners at a vertex have the same.
std::vector<vec3<float>> vertex_tangents(const mesh::TriangleMesh& mesh) {
  const mesh::TangentSpace space = mesh::generate_tangents(mesh, 0);
  std::vector<vec3<float>> tangents(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const vec4<float> t = space.corners[3 * i + k];
      tangents[mesh.triangles[i][k]] = {t.x, t.y, t.z};
    }
  return tangents;
}

std::vector<vec3<float>> differences(const std::vector<vec3<float>>& to,
                                     const std::vector<vec3<float>>& from) {
  std::vector<vec3<float>> all(to.size());
  for (std::size_t i = 0; i < to.size(); ++i) all[i] = to[i] - from[i];
  return all;
}

} // namespace

mesh::TriangleMesh flat_sheet(int cells) { return mesh_of(cells, flat); }

mesh::TriangleMesh morphed_sheet(int cells, MorphedTangents tangents) {
  mesh::TriangleMesh rest = flat_sheet(cells);
  const std::vector<vec3<float>> rest_tangents = vertex_tangents(rest);
  std::vector<mesh::MorphTarget> pulls;
  for (const Shape& shape : targets) {
    const mesh::TriangleMesh target = mesh_of(cells, shape);
    mesh::MorphTarget& pull = pulls.emplace_back();
    pull.positions = differences(target.positions, rest.positions);
    if (tangents == MorphedTangents::blended)
      pull.tangents = differences(vertex_tangents(target), rest_tangents);
  }
  if (tangents != MorphedTangents::recomputed) rest.tangent_spaces = {mesh::generate_tangents(rest, 0)};
  mesh::TriangleMesh mesh = mesh::morph(rest, pulls, weights);
  mesh.normals = mesh_of(cells, morphed).normals;
  return mesh;
}

} // namespace surfgrad::gallery
