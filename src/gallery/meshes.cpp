#include "gallery/meshes.hpp"

#include "mesh/precision.hpp"

#include <surfgrad/fractal.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace surfgrad::gallery {
namespace {

using mesh::narrow;

/// One side of the cube: the direction of (a, b) in [-1, 1]^2 is centre + a * right + b * up.
struct Side {
  vec3<double> centre, right, up;
};
constexpr std::array<Side, 6> sides{{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                     {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                     {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},
                                     {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                     {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                     {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}}};

/// How the sides lie in the unwrap: quarter turns counter-clockwise, and whether mirrored before.
struct Chart {
  int quarters;
  bool mirrored;
};
constexpr std::array<Chart, 6> charts{
    {{0, false}, {1, false}, {2, false}, {0, false}, {3, false}, {0, true}}};

constexpr int chart_columns = 3;
constexpr int chart_rows = 2;
/// Part of a chart's cell that stays empty along each border, so that the filter does not see its
/// neighbours: 8 texels of a map of 512 rows.
constexpr double gutter = 0.03;

vec2<double> turned(vec2<double> v, int quarters) {
  for (int i = 0; i < quarters; ++i) v = {-v.y, v.x};
  return v;
}

vec2<double> chart_uv(std::size_t side, vec2<double> ab) {
  const Chart& chart = charts[side];
  const vec2<double> v = turned({chart.mirrored ? -ab.x : ab.x, ab.y}, chart.quarters);
  const auto column = static_cast<double>(side % chart_columns);
  const auto row = static_cast<double>(side / chart_columns);
  return {(column + 0.5 + (0.5 - gutter) * v.x) / chart_columns,
          (row + 0.5 + (0.5 - gutter) * v.y) / chart_rows};
}

/// The chart's cell around a texture coordinate.
std::size_t chart_at(vec2<double> uv) {
  const int column = std::clamp(static_cast<int>(uv.x * chart_columns), 0, chart_columns - 1);
  const int row = std::clamp(static_cast<int>(uv.y * chart_rows), 0, chart_rows - 1);
  return static_cast<std::size_t>(row * chart_columns + column);
}

/// Where uv lies on its side: [-1, 1]^2 within the chart, beyond it outside.
vec2<double> place_on_side(std::size_t side, vec2<double> uv) {
  const Chart& chart = charts[side];
  const auto column = static_cast<double>(side % chart_columns);
  const auto row = static_cast<double>(side / chart_columns);
  const vec2<double> v = turned({(uv.x * chart_columns - column - 0.5) / (0.5 - gutter),
                                 (uv.y * chart_rows - row - 0.5) / (0.5 - gutter)},
                                4 - chart.quarters);
  return {chart.mirrored ? -v.x : v.x, v.y};
}

vec3<double> direction_on_side(std::size_t side, vec2<double> ab) {
  const Side& s = sides[side];
  return normalize_or_zero(s.centre + ab.x * s.right + ab.y * s.up);
}

/// Longitude and latitude of a triangle's corners, unbroken over it.
std::array<vec2<double>, 3> tiling_uvs(const std::array<vec3<double>, 3>& d) {
  std::array<vec2<double>, 3> uv;
  std::array<bool, 3> pole{};
  for (std::size_t i = 0; i < 3; ++i) {
    pole[i] = std::abs(d[i].x) < 1e-9 && std::abs(d[i].z) < 1e-9;
    uv[i] = {0.5 + std::atan2(d[i].x, d[i].z) / (2 * std::numbers::pi),
             0.5 * (0.5 + std::asin(std::clamp(d[i].y, -1.0, 1.0)) / std::numbers::pi)};
  }
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (!pole[i]) most = std::max(most, uv[i].x);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (pole[i]) continue;
    if (most - uv[i].x > 0.5) uv[i].x += 1; // the far side of the seam
    sum += uv[i].x;
    ++count;
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (pole[i]) uv[i].x = sum / count;
  return uv;
}

} // namespace

double turn(double part) { return 2 * std::numbers::pi * (part - std::floor(part)); }

void append_patch(mesh::TriangleMesh& mesh, int columns, int rows,
                  const std::function<SurfacePoint(double s, double t)>& point,
                  const std::function<vec2<double>(double s, double t)>& uv) {
  mesh.uv_sets.resize(1);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double s = static_cast<double>(i) / columns;
      const double t = static_cast<double>(j) / rows;
      const SurfacePoint p = point(s, t);
      mesh.positions.push_back(narrow(p.position));
      mesh.normals.push_back(narrow(p.normal));
      mesh.uv_sets[0].push_back(narrow(uv(s, t)));
    }
  const auto vertex = [&](int i, int j) { return first + static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  mesh.material_of_triangle.resize(mesh.triangles.size(), 0);
}

mesh::TriangleMesh closed_surface(int cells, const std::function<SurfacePoint(vec3<double>)>& point) {
  mesh::TriangleMesh mesh;
  mesh.uv_sets.resize(2);
  // Corners of their own for every triangle: the two sets are cut along different edges.
  const auto append = [&](std::size_t side, const std::array<vec2<double>, 3>& corners) {
    std::array<vec3<double>, 3> directions;
    for (std::size_t i = 0; i < 3; ++i) directions[i] = direction_on_side(side, corners[i]);
    const std::array<vec2<double>, 3> tiling = tiling_uvs(directions);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::size_t i = 0; i < 3; ++i) {
      const SurfacePoint p = point(directions[i]);
      mesh.positions.push_back(narrow(p.position));
      mesh.normals.push_back(narrow(p.normal));
      mesh.uv_sets[0].push_back(narrow(chart_uv(side, corners[i])));
      mesh.uv_sets[1].push_back(narrow(tiling[i]));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.material_of_triangle.push_back(0);
  };
  // Whole numbers first: the same point of an edge is computed alike on both of its sides.
  const auto along = [cells](int i) { return static_cast<double>(2 * i - cells) / cells; };
  for (std::size_t side = 0; side < sides.size(); ++side)
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const vec2<double> low{along(i), along(j)};
        const vec2<double> high{along(i + 1), along(j + 1)};
        append(side, {low, {high.x, low.y}, high});
        append(side, {low, high, {low.x, high.y}});
      }
  return mesh;
}

vec3<double> unwrapped_direction(vec2<double> uv) {
  const std::size_t side = chart_at(uv);
  return direction_on_side(side, place_on_side(side, uv));
}

vec2<double> nearest_in_chart(vec2<double> uv, double inset) {
  const std::size_t side = chart_at(uv);
  const vec2<double> ab = place_on_side(side, uv);
  if (std::abs(ab.x) <= 1 && std::abs(ab.y) <= 1) return uv;
  const double border = 1 - inset;
  return chart_uv(side, {std::clamp(ab.x, -border, border), std::clamp(ab.y, -border, border)});
}

SurfacePoint ball_point(vec3<double> direction) { return {direction, direction}; }

SurfacePoint rounded_cube_point(vec3<double> d) {
  // |x|^8 + |y|^8 + |z|^8 = 1, whose gradient is along the seventh powers.
  const auto seventh = [](double v) { return v * v * v * v * v * v * v; };
  const vec3<double> g{seventh(d.x), seventh(d.y), seventh(d.z)};
  const double r = 1 / std::pow(dot(g, d), 0.125);
  return {r * d, normalize_or_zero(g)};
}

SurfacePoint pill_point(vec3<double> d) {
  constexpr double radius = 0.55;
  constexpr double half = 0.6;
  const double around = std::hypot(d.y, d.z);
  if (std::abs(d.x) * radius <= half * around)
    return {(radius / around) * d, vec3<double>{0, d.y / around, d.z / around}};
  const vec3<double> centre{std::copysign(half, d.x), 0, 0};
  const double along = dot(d, centre);
  const double r = along + std::sqrt(along * along - half * half + radius * radius);
  return {r * d, normalize_or_zero(r * d - centre)};
}

namespace {

// Somewhere in the noise where the boulder looks well.
constexpr vec3<double> rock_place{3.7, 1.2, 8.4};

/// Radius of the boulder without its crags, and the radius' gradient.
Noise<double> rock_radius(vec3<double> d, int octaves) {
  const Noise<double> shape = fractal_sum(1.3 * d + rock_place, {octaves, 2.03, 0.42});
  return {1 + 0.34 * shape.value, (0.34 * 1.3) * shape.gradient};
}

/// The point r(d) d, d of unit length: its normal is r d less the part of r's gradient along the sphere.
SurfacePoint point_at_radius(vec3<double> d, const Noise<double>& r) {
  const vec3<double> along = r.gradient - dot(r.gradient, d) * d;
  return {r.value * d, normalize_or_zero(r.value * d - along)};
}

} // namespace

SurfacePoint rock_point(vec3<double> d, int octaves) {
  const Noise<double> shape = rock_radius(d, std::min(octaves, rock_mesh_octaves));
  // Crests and clefts begin where the mesh ends.
  const Noise<double> crags = ridged(3.1 * d + rock_place, {octaves - rock_mesh_octaves, 2.11, 0.46});
  return point_at_radius(
      d, {shape.value + 0.055 * crags.value, shape.gradient + (0.055 * 3.1) * crags.gradient});
}

vec3<double> ledged_rock_normal(vec3<double> d) {
  const Noise<double> wave = perlin(2.0 * d + rock_place);
  constexpr double ledges = 3.2; // in a unit of height
  const double level = ledges * (d.y + 0.12 * wave.value);
  const vec3<double> level_gradient = ledges * (vec3<double>{0, 1, 0} + 0.24 * wave.gradient);
  // Upwards the rock leans out by `depth`, and draws back by as much within less than half of the way.
  constexpr double depth = 0.2;
  constexpr double width = 0.45;
  const double place = level - std::floor(level);
  const double edge = 2 * std::clamp((place - 0.5) / width, 0.0, 1.0) - 1;
  // A smooth bump whose mean over the ledge, edge from -1 to 1, is 1.
  const double bump = 1.875 * (1 - edge * edge) * (1 - edge * edge);
  const double slope = depth * (1 - bump / width);
  const Noise<double> shape = rock_radius(d, rock_mesh_octaves);
  return point_at_radius(d, {shape.value, shape.gradient + slope * level_gradient}).normal;
}

mesh::TriangleMesh rock_mesh() {
  return closed_surface(24, [](vec3<double> d) { return rock_point(d, rock_mesh_octaves); });
}

mesh::TriangleMesh half_mirrored_torus() {
  constexpr int around = 10; // of half the ring: coarse enough that single triangles are seen
  constexpr int across = 12;
  const auto point = [](double s, double t) {
    const double u = turn(s);
    const double v = turn(t);
    const vec3<double> n{std::cos(v) * std::sin(u), std::sin(v), std::cos(v) * std::cos(u)};
    return SurfacePoint{vec3<double>{std::sin(u), 0, std::cos(u)} + 0.45 * n, n};
  };
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, around, across, [&](double s, double t) { return point(0.5 * s, t); },
      [](double s, double t) {
        return vec2<double>{0.5 * s, t};
      });
  append_patch(
      mesh, around, across, [&](double s, double t) { return point(0.5 + 0.5 * s, t); },
      [](double s, double t) {
        return vec2<double>{0.5 - 0.5 * s, t};
      });
  return mesh;
}

mesh::TriangleMesh barrel() {
  constexpr double radius = 2.5;
  constexpr double half_width = 2.5;
  constexpr double degree = std::numbers::pi / 180;
  constexpr double front = 45 * degree;
  constexpr double whole = (45 + 65) * degree;
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, 8, 48,
      [](double s, double t) {
        const double angle = front - whole * t;
        const vec3<double> n{0, std::cos(angle), std::sin(angle)};
        return SurfacePoint{vec3<double>{half_width * (2 * s - 1), -radius, 0} + radius * n, n};
      },
      [](double s, double t) {
        return vec2<double>{2 * half_width * s, radius * whole * t};
      });
  return mesh;
}

mesh::TriangleMesh ground() {
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, 1, 1,
      [](double s, double t) {
        return SurfacePoint{{8 * s - 4, 0, 4 - 8 * t}, {0, 1, 0}};
      },
      [](double s, double t) {
        return vec2<double>{s, t};
      });
  return mesh;
}

mesh::TriangleMesh scroll() {
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, 96, 16,
      [](double s, double t) {
        const double u = turn(0.62 * s + 0.02);
        const vec3<double> n{std::sin(u), 0, std::cos(u)};
        return SurfacePoint{n + vec3<double>{0, 1.6 * t - 0.8, 0}, n};
      },
      [](double s, double t) {
        return vec2<double>{0.62 * 4 * s, 1.02 * t};
      });
  return mesh;
}

mesh::TriangleMesh sheet(int cells, double bend) {
  mesh::TriangleMesh mesh;
  append_patch(
      mesh, cells, cells,
      [bend](double s, double t) {
        const double x = 2 * s - 1;
        const double arc = 1 - 2 * t; // along +z
        if (bend == 0) return SurfacePoint{{x, 0, arc}, {0, 1, 0}};
        const vec3<double> n{0, std::cos(bend * arc), std::sin(bend * arc)};
        return SurfacePoint{vec3<double>{x, -1 / bend, 0} + (1 / bend) * n, n};
      },
      [](double s, double t) {
        return vec2<double>{s, t};
      });
  return mesh;
}

} // namespace surfgrad::gallery
