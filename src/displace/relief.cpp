#include "displace/relief.hpp"

#include "engine/noise_function.hpp"
#include "engine/rows.hpp"
#include "image/bicubic.hpp"
#include "mesh/precision.hpp"

#include <surfgrad/gradient.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

namespace surfgrad::displace {
namespace {

using mesh::widen;

using double2 = vec2<double>;
using double3 = vec3<double>;

/// Runs work(i) for every vertex, in parallel.
template <class Work>
void for_each_vertex(std::size_t count, const Report& report, const Work& work) {
  constexpr std::size_t block = 1024; // enough work to share out, and soon done when asked to stop
  engine::for_each_row(static_cast<int>((count + block - 1) / block), report, [&](int row) {
    const std::size_t first = static_cast<std::size_t>(row) * block;
    for (std::size_t i = first; i < std::min(first + block, count); ++i) work(i);
  });
}

/// Derivatives of the position by the texture coordinate in a triangle.
struct Jacobian {
  double3 dp_ds, dp_dt;
  bool exists;
};

Jacobian jacobian_of(const mesh::TriangleMesh& mesh, std::size_t set, std::size_t triangle) {
  const auto [a, b, c] = mesh.triangles[triangle];
  const double3 p = widen(mesh.positions[a]);
  const double3 u = widen(mesh.positions[b]) - p;
  const double3 v = widen(mesh.positions[c]) - p;
  const double2 st = widen(mesh.uv_sets[set][a]);
  const double2 du = widen(mesh.uv_sets[set][b]) - st;
  const double2 dv = widen(mesh.uv_sets[set][c]) - st;
  const double area = cross(du, dv);
  // Coordinates are float: what is smaller than this is the rounding of a triangle without texture area.
  if (!(std::abs(area) > 1e-12 * length(du) * length(dv))) return {{}, {}, false};
  return {(1 / area) * (dv.y * u - du.y * v), (1 / area) * (du.x * v - dv.x * u), true};
}

} // namespace

std::vector<double> corner_angles(const mesh::TriangleMesh& mesh) {
  std::vector<double> angles(3 * mesh.triangles.size(), 0);
  for (std::size_t corner = 0; corner < angles.size(); ++corner) {
    const auto& t = mesh.triangles[corner / 3];
    const double3 p = widen(mesh.positions[t[corner % 3]]);
    const double3 a = widen(mesh.positions[t[(corner + 1) % 3]]) - p;
    const double3 b = widen(mesh.positions[t[(corner + 2) % 3]]) - p;
    const double sine = length(cross(a, b));
    // Unlike acos, atan2 keeps its precision at angles near 0 and pi.
    if (sine > 0) angles[corner] = std::atan2(sine, dot(a, b));
  }
  return angles;
}

Relief relief_of(const mesh::TriangleMesh& mesh, const stack::Displace& displace,
                 std::span<const double3> normals, const Report& report) {
  Relief relief{std::vector<double>(normals.size()), std::vector<double3>(normals.size())};
  for_each_vertex(normals.size(), report, [&](std::size_t i) {
    // Width 0: the function itself. What its vertices cannot show is not filtered away.
    const Noise<double> noise = engine::evaluate(displace.noise, widen(mesh.positions[i]), 0.0);
    relief.heights[i] = displace.height * (noise.value - displace.level);
    relief.surfgrads[i] = displace.height * from_volume_gradient(normals[i], noise.gradient);
  });
  return relief;
}

Relief relief_of(const mesh::TriangleMesh& mesh, const stack::Displace& displace, const engine::TiledMap& map,
                 const mesh::Places& places, std::span<const double3> normals, std::span<const double> angles,
                 const Report& report) {
  const auto set = static_cast<std::size_t>(displace.map->uv);
  const double2 size{double(map.map->width()), double(map.map->height())};
  Relief relief{std::vector<double>(normals.size()), std::vector<double3>(normals.size(), double3{0, 0, 0})};
  std::vector<double2> dh_dst(normals.size());
  for_each_vertex(normals.size(), report, [&](std::size_t i) {
    const image::BicubicSample<double> sample = image::sample_bicubic<double>(
        *map.map, engine::map_coordinate(map, widen(mesh.uv_sets[set][i])), map.wrap, true);
    relief.heights[i] = displace.height * (sample.value - displace.level);
    dh_dst[i] = displace.height * engine::by_coordinate(map, size * sample.derivative);
  });

  // Vertices at one place with one normal have one sum: there a texture seam is no seam of the surface.
  std::map<std::array<double, 4>, std::size_t> first_of; // by place and normal
  std::vector<std::size_t> sum_of(normals.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double3& n = normals[i];
    sum_of[i] = first_of.try_emplace({double(places.of_vertex[i]), n.x, n.y, n.z}, i).first->second;
  }
  std::vector<double3> sums(normals.size(), double3{0, 0, 0});
  std::vector<double> weights(normals.size(), 0);
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const Jacobian jacobian = jacobian_of(mesh, set, triangle);
    if (!jacobian.exists) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[triangle][k];
      const double angle = angles[3 * triangle + k];
      const double3 surfgrad =
          from_parametric_derivative(normals[vertex], jacobian.dp_ds, jacobian.dp_dt, dh_dst[vertex]);
      sums[sum_of[vertex]] = sums[sum_of[vertex]] + angle * surfgrad;
      weights[sum_of[vertex]] += angle;
    }
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const std::size_t sum = sum_of[i];
    if (weights[sum] > 0) relief.surfgrads[i] = (1 / weights[sum]) * sums[sum];
  }
  return relief;
}

} // namespace surfgrad::displace
