#pragma once

#include "diagnostic/error.hpp"

#include <surfgrad/vec.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace surfgrad::mesh {

/// Tangent space of one UV set, one entry a triangle corner (3 * triangle + corner): MikkTSpace
/// vectors may differ between triangles that share a vertex.
struct TangentSpace {
  std::vector<vec4<float>> corners{}; ///< xyz tangent (unit), w the sign: bitangent = w * cross(n, t)
};

/// An indexed triangle mesh in object space. Texture origin lower left, t up; counter-clockwise
/// triangles face the viewer.
struct TriangleMesh {
  std::vector<vec3<float>> positions{}; ///< one a vertex
  /// One a vertex where the mesh has been displaced: the positions before it. Else empty.
  std::vector<vec3<float>> rest_positions{};
  std::vector<vec3<float>> normals{};                    ///< one a vertex; readers generate missing ones
  std::vector<std::vector<vec2<float>>> uv_sets{};       ///< [set][vertex]; may be empty
  std::vector<std::array<std::uint32_t, 3>> triangles{}; ///< vertex indices, all in range
  std::vector<std::uint32_t> material_of_triangle{};     ///< index into the model's materials, one a triangle
  /// [set]; an absent or empty entry means: not given by the file, generate on demand.
  std::vector<TangentSpace> tangent_spaces{};
};

/// Whether the mesh came with tangents for this UV set; else they are generated on demand.
[[nodiscard]] inline bool has_tangents(const TriangleMesh& mesh, std::size_t uv_set) {
  return uv_set < mesh.tangent_spaces.size() && !mesh.tangent_spaces[uv_set].corners.empty();
}

/// Three a triangle. Corners are numbered in 32 bits: MachineError for a mesh that has more.
[[nodiscard]] inline std::uint32_t corner_count(const TriangleMesh& mesh) {
  // The largest 32-bit number is a multiple of three; it is kept free to mean "no corner".
  constexpr std::size_t most_triangles = std::numeric_limits<std::uint32_t>::max() / 3 - 1;
  if (mesh.triangles.size() > most_triangles)
    throw MachineError("the mesh has " + std::to_string(mesh.triangles.size()) + " triangles; at most " +
                       std::to_string(most_triangles) + " can be processed");
  return static_cast<std::uint32_t>(3 * mesh.triangles.size());
}

} // namespace surfgrad::mesh
