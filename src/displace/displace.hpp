#pragma once

#include "diagnostic/report.hpp"
#include "engine/texture.hpp"
#include "mesh/triangle_mesh.hpp"
#include "stack/displace.hpp"

#include <cstddef>

namespace surfgrad::displace {

struct DisplacedMesh {
  mesh::TriangleMesh mesh{};
  double lowest = 0, highest = 0; ///< least and largest move of a place along its normal, object units
  /// Places whose vertices have different normals or heights, moved together so that the mesh stays closed.
  std::size_t joined_places = 0;
  /// Places whose normals cancel: each vertex moves along its own, and the mesh may open there.
  std::size_t parted_places = 0;
};

/// The mesh subdivided, then every vertex moved along its normal: p' = p + h(p) n, with h = height * (value -
/// level). Its normal becomes normalize(n - surfgrad), from the exact gradient of h at p.
///
/// mesh      not displaced yet; normals unit or zero
/// displace  what moves it; files and lines do not count
/// map       the map of a displacement that has one, whose UV set the mesh has; else null
/// returns   rest_positions hold the subdivided mesh before it moved. No tangent spaces: those given
///           belong to the mesh before. Positions may overflow where the height is huge; nothing else is
///           not finite.
///
/// Vertices at one place (mesh::Places) move by the mean of their heights, along the mean of their normals
/// weighted by the angles of their triangles, each keeping a normal of its own. In a map's case the surface
/// gradient at a vertex is the mean, so weighted, of those in its triangles, on both sides of a texture seam
/// where the normals there are equal.
///
/// error       the normal neglects h times the curvature of the base: quadratic in the height
/// degenerate  a zero normal does not move, unless others at its place do; triangles without texture area
///             say nothing about slopes
/// throws      Cancelled where the report's progress asks to stop; MachineError as mesh::subdivide
/// source      Gustavson 2021, equations 3 to 8; Mikkelsen 2019, listings 8 and 12
[[nodiscard]] DisplacedMesh displace(const mesh::TriangleMesh& mesh, const stack::Displace& displace,
                                     const engine::TiledMap* map = nullptr, const Report& report = {});

} // namespace surfgrad::displace
