#pragma once

#include "diagnostic/report.hpp"
#include "engine/texture.hpp"
#include "mesh/places.hpp"
#include "mesh/triangle_mesh.hpp"
#include "stack/displace.hpp"

#include <span>
#include <vector>

namespace surfgrad::displace {

/// Heights and their surface gradients, one a vertex.
struct Relief {
  std::vector<double> heights{};         ///< object units
  std::vector<vec3<double>> surfgrads{}; ///< perpendicular to the vertex's normal
};

/// Angle of each triangle at each of its corners, radians, 3 * triangle + corner; 0 in triangles without
/// area.
[[nodiscard]] std::vector<double> corner_angles(const mesh::TriangleMesh& mesh);

/// The relief of a function of space at the vertices.
///
/// normals  one a vertex, unit or zero
[[nodiscard]] Relief relief_of(const mesh::TriangleMesh& mesh, const stack::Displace& displace,
                               std::span<const vec3<double>> normals, const Report& report);

/// The relief of a map at the vertices: a cubic B-spline over the texels of level 0, and its derivative by
/// the texture coordinate brought to the surface in each triangle.
///
/// normals, angles  one a vertex, unit or zero, and one a corner
[[nodiscard]] Relief relief_of(const mesh::TriangleMesh& mesh, const stack::Displace& displace,
                               const engine::TiledMap& map, const mesh::Places& places,
                               std::span<const vec3<double>> normals, std::span<const double> angles,
                               const Report& report);

} // namespace surfgrad::displace
