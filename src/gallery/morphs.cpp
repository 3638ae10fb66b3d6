#include "gallery/morphs.hpp"

#include "gallery/meshes.hpp"
#include "mesh/mikktspace.hpp"
#include "mesh/morph.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace surfgrad::gallery {
namespace {

using std::numbers::pi;

constexpr double radius = 0.42;
constexpr double half_height = 1.15;

vec3<double> tube(double s, double t) {
  const double u = turn(s);
  return {radius * std::sin(u), half_height * (2 * t - 1), radius * std::cos(u)};
}

vec3<double> twisted(double s, double t) {
  // Opposite ways at both ends, less than half a turn each: straight lines to it do not meet the axis.
  const double u = turn(s) + 0.62 * pi * (2 * t - 1);
  return {radius * std::sin(u), half_height * (2 * t - 1), radius * std::cos(u)};
}

vec3<double> bent(double s, double t) {
  const vec3<double> p = tube(s, t);
  // The axis becomes an arc of 120 degrees, as long as it was.
  constexpr double arc = 2 * pi / 3;
  constexpr double r = 2 * half_height / arc;
  const double a = p.y / r;
  return {r - (r - p.x) * std::cos(a), (r - p.x) * std::sin(a), p.z};
}

vec3<double> swollen(double s, double t) {
  const vec3<double> p = tube(s, t);
  // Two leaning bulges, which stretch the texture slantwise.
  const double wave = std::sin(turn(s) + 3 * pi * t);
  const double swell = 1 + 0.9 * std::sin(pi * t) * (0.5 + 0.5 * wave);
  return {swell * p.x, p.y, swell * p.z};
}

using Shape = vec3<double> (*)(double, double);
constexpr std::array<Shape, 3> targets{twisted, bent, swollen};
constexpr std::array<double, 3> weights{0.8, 0.75, 0.9};

vec3<double> morphed(double s, double t) {
  const vec3<double> rest = tube(s, t);
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

mesh::TriangleMesh straight_tube(int cells) { return mesh_of(cells, tube); }

mesh::TriangleMesh morphed_tube(int cells, MorphedTangents tangents) {
  mesh::TriangleMesh rest = straight_tube(cells);
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
