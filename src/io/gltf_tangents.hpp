#pragma once

#include "io/gltf_edit.hpp"
#include "io/gltf_scene.hpp"
#include "mesh/triangle_mesh.hpp"

#include <surfgrad/vec.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace surfgrad::io::gltf {

/// Vertices and triangles of a primitive, with one tangent a vertex.
struct TangentVertices {
  std::vector<std::uint32_t> source{};  ///< [vertex] vertex of the primitive as it was
  std::vector<vec4<float>> tangents{};  ///< [vertex]
  std::vector<vec3<float>> normals{};   ///< [vertex]; empty where the primitive has its own
  std::vector<std::uint32_t> indices{}; ///< three a triangle
  std::size_t split = 0;                ///< vertices that are there because corners of one disagreed
  std::size_t arbitrary = 0;            ///< corners where nothing is left of the tangent: some unit vector
};

/// MikkTSpace tangents of a primitive of triangles, unmorphed, over a UV set that it has.
[[nodiscard]] TangentVertices make_tangents(const Document& document, PrimitivePlace place,
                                            std::size_t uv_set);

/// Gives the primitive these vertices, with all the attributes and morph targets that it has, as a list of
/// triangles. Its accessors should have been given up.
void install(Edit& edit, PrimitivePlace place, const TangentVertices& vertices);

/// Replaces the primitive's shape by a mesh that it did not have: all attributes, and no morph targets. The
/// corners' tangents are the mesh's for the UV set, or MikkTSpace's.
void install(Edit& edit, PrimitivePlace place, const mesh::TriangleMesh& mesh, std::size_t uv_set);

/// The tangents of all corners of a mesh over a UV set: its own, or MikkTSpace's. Where nothing is left of
/// one some unit vector stands in, for the format wants one; returns how many in `arbitrary`.
[[nodiscard]] std::vector<vec4<float>> corner_tangents(const mesh::TriangleMesh& mesh, std::size_t uv_set,
                                                       std::size_t& arbitrary);

} // namespace surfgrad::io::gltf
