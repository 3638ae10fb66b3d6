#pragma once

#include "mesh/triangle_mesh.hpp"

#include <span>
#include <vector>

namespace surfgrad::mesh {

/// A shape that a mesh can be pulled towards: what its vertices move by at weight 1. Each list has one
/// entry a vertex, or none: nothing of its kind moves.
struct MorphTarget {
  std::vector<vec3<float>> positions{};
  std::vector<vec3<float>> normals{};
  std::vector<vec3<float>> tangents{}; ///< of the tangents that the mesh came with; their w stays
};

/// The mesh with every target pulled by its weight: position + sum of weight * difference, and the same for
/// normals and tangents, which are then made unit.
///
/// weights     one a target, of any sign and size; targets of weight 0 do not count
/// returns     the mesh with its indices, texture coordinates and materials as they were. Normals or
///             tangents that no counting target moves keep their bits: they are then those of the shape
///             before (stale), and it is the caller's choice to generate others.
/// degenerate  normals and tangents that cancel become (0, 0, 0); sums that overflow are not finite
/// source      glTF 2.0, 3.7.2.2
[[nodiscard]] TriangleMesh morph(const TriangleMesh& mesh, std::span<const MorphTarget> targets,
                                 std::span<const double> weights);

} // namespace surfgrad::mesh
