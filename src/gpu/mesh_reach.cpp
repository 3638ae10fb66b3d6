#include "gpu/mesh_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace surfgrad::gpu {
namespace {

using Corners = std::array<vec3<double>, 3>;

constexpr double unknown = std::numeric_limits<double>::infinity();

/// Least component of any along their common direction.
double least_along_mean(const Corners& v) {
  const vec3<double> mean = normalize_or_zero(v[0] + v[1] + v[2]);
  return std::min({dot(v[0], mean), dot(v[1], mean), dot(v[2], mean)});
}

/// Most of the product of two interpolated vectors that at corners are at right angles.
double most_product(const Corners& t, const Corners& n) {
  double at_corners = 0, across = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    at_corners = std::max(at_corners, std::abs(dot(t[i], n[i])));
    across = std::max(across, std::abs(dot(t[i], n[j]) + dot(t[j], n[i])));
  }
  return at_corners + across / 3;
}

void add_triangle(const raster::Surface& surface, std::uint32_t triangle, MeshReach& reach) {
  const vec3<double> flat = raster::triangle_normal(surface, triangle);
  if (max_abs(flat) == 0) return; // covers nothing
  Corners n;
  for (std::size_t i = 0; i < 3; ++i) n[i] = surface.normals[surface.mesh->triangles[triangle][i]];
  const double shortest = least_along_mean(n);
  if (!(shortest > 0)) {
    reach.tilt_rad = reach.tangent_length = unknown;
    for (MeshReach::Slot& slot : reach.slots) slot = {unknown, unknown};
    return;
  }
  const double side = dot(n[0] + n[1] + n[2], flat) < 0 ? -1 : 1;
  // An interpolated normal leans no farther than the corner that leans most.
  for (const vec3<double>& each : n)
    reach.tilt_rad = std::max(reach.tilt_rad, std::acos(std::clamp(side * dot(each, flat), -1.0, 1.0)));
  reach.tangent_length = std::max(reach.tangent_length, 1 / shortest);
  for (std::size_t s = 0; s < surface.slots.size(); ++s) {
    const std::vector<vec4<double>>& tangents = surface.slots[s].tangents;
    if (tangents.empty()) continue;
    Corners t;
    for (std::size_t i = 0; i < 3; ++i) {
      const vec4<double>& corner = tangents[3 * static_cast<std::size_t>(triangle) + i];
      t[i] = {corner.x, corner.y, corner.z};
    }
    const double product = most_product(t, n);
    MeshReach::Slot& slot = reach.slots[s];
    slot.along_normal = std::max(slot.along_normal, product / (shortest * shortest));
    const double least = least_along_mean(t) * shortest;
    slot.tangent_tilt_rad =
        std::max(slot.tangent_tilt_rad, least > product ? std::asin(product / least) : unknown);
  }
}

} // namespace

MeshReach mesh_reach(const std::vector<raster::Surface>& surfaces, std::uint32_t material) {
  MeshReach reach;
  for (const raster::Surface& surface : surfaces) {
    reach.slots.resize(std::max(reach.slots.size(), surface.slots.size()));
    const auto& materials = surface.mesh->material_of_triangle;
    for (std::uint32_t i = 0; i < materials.size(); ++i)
      if (materials[i] == material) add_triangle(surface, i, reach);
  }
  return reach;
}

} // namespace surfgrad::gpu
