#include "displace/displace.hpp"

#include "displace/relief.hpp"
#include "mesh/places.hpp"
#include "mesh/precision.hpp"
#include "mesh/subdivide.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace surfgrad::displace {
namespace {

using mesh::narrow, mesh::widen;

using double3 = vec3<double>;

/// What the vertices at one place have in common.
struct Place {
  double height_sum = 0;
  double weight = 0; ///< of all normals in the sum
  double3 normal_sum{0, 0, 0};
  std::uint32_t first = 0; ///< its first vertex
  std::uint32_t vertices = 0;
  bool one_normal = true;
  bool one_height = true;

  [[nodiscard]] double height() const { return height_sum / vertices; }
  /// The normals cancel: what is left of their sum has no meaning as a direction.
  [[nodiscard]] bool parts() const { return !one_normal && length(normal_sum) <= 1e-3 * weight; }
};

std::vector<Place> gathered(const mesh::TriangleMesh& mesh, const mesh::Places& places,
                            const std::vector<double3>& normals, const std::vector<double>& angles,
                            const Relief& relief) {
  std::vector<Place> result(places.count);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    Place& place = result[places.of_vertex[i]];
    if (place.vertices++ == 0) place.first = static_cast<std::uint32_t>(i);
    place.one_normal = place.one_normal && max_abs(normals[i] - normals[place.first]) == 0;
    place.one_height = place.one_height && relief.heights[i] == relief.heights[place.first];
    place.height_sum += relief.heights[i];
  }
  for (std::size_t corner = 0; corner < angles.size(); ++corner) {
    const std::uint32_t vertex = mesh.triangles[corner / 3][corner % 3];
    Place& place = result[places.of_vertex[vertex]];
    place.normal_sum = place.normal_sum + angles[corner] * normals[vertex];
    place.weight += angles[corner] * (max_abs(normals[vertex]) > 0 ? 1 : 0);
  }
  return result;
}

} // namespace

DisplacedMesh displace(const mesh::TriangleMesh& base, const stack::Displace& displace,
                       const engine::TiledMap* map, const Report& report) {
  assert(base.rest_positions.empty());
  const bool curved = displace.edges == stack::Edges::curved;
  DisplacedMesh result{.mesh = mesh::subdivide(base, displace.subdivide,
                                               curved ? mesh::EdgeShape::curved : mesh::EdgeShape::straight)};
  mesh::TriangleMesh& mesh = result.mesh;
  mesh.tangent_spaces.clear();
  mesh.rest_positions = mesh.positions;
  std::vector<double3> normals;
  normals.reserve(mesh.normals.size());
  for (const vec3<float>& n : mesh.normals) normals.push_back(normalize_or_zero(widen(n)));
  const std::vector<double> angles = corner_angles(mesh);
  const mesh::Places places = mesh::places_of(mesh.positions);
  const Relief relief = map != nullptr ? relief_of(mesh, displace, *map, places, normals, angles, report)
                                       : relief_of(mesh, displace, normals, report);
  const std::vector<Place> together = gathered(mesh, places, normals, angles, relief);

  result.lowest = std::numeric_limits<double>::infinity();
  result.highest = -result.lowest;
  for (const Place& place : together) {
    result.lowest = std::min(result.lowest, place.height());
    result.highest = std::max(result.highest, place.height());
    result.parted_places += place.parts();
    result.joined_places += !place.parts() && !(place.one_normal && place.one_height);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Place& place = together[places.of_vertex[i]];
    const bool own = place.one_normal || place.parts();
    const double3 direction = own ? normals[i] : normalize_or_zero(place.normal_sum);
    mesh.positions[i] = narrow(widen(mesh.positions[i]) + place.height() * direction);
    mesh.normals[i] = narrow(normalize_or_zero(normals[i] - relief.surfgrads[i]));
  }
  return result;
}

} // namespace surfgrad::displace
