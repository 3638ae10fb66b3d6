#pragma once

#include "mesh/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace surfgrad::mesh {

/// Smooth vertex normals: the mean of the unit normals of the triangles at a vertex, weighted by the
/// angle each has there (Thuermer and Wuethrich, 1998), so that the triangulation of a flat face
/// does not matter.
///
/// positions  one a vertex, any unit; vertices at one position stay apart
/// triangles  vertex indices, all in range; counter-clockwise triangles face along their normal
/// returns    one a vertex: unit length, or (0, 0, 0) where no triangle counts (isolated vertices)
///            and where the normals cancel exactly
/// degenerate triangles of zero area and those with a non-finite position do not count
[[nodiscard]] std::vector<vec3<float>>
generate_normals(std::span<const vec3<float>> positions,
                 std::span<const std::array<std::uint32_t, 3>> triangles);

/// The mesh with every triangle flat, as glTF 2.0 (3.7.2.1) demands of a mesh without normals: each
/// corner becomes a vertex of its own, vertex 3 * triangle + corner. UV sets and materials are kept,
/// tangent spaces dropped: they belong to the normals that were there.
///
/// degenerate triangles of zero area or with a non-finite position get the normal (0, 0, 0)
/// fails      MachineError for more corners than 32 bits can number
[[nodiscard]] TriangleMesh with_flat_normals(const TriangleMesh& mesh);

} // namespace surfgrad::mesh
