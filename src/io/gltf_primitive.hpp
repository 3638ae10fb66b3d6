#pragma once

#include "io/gltf_document.hpp"
#include "mesh/triangle_mesh.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace surfgrad::io::gltf {

/// The triangles of `primitive`, which is made of triangles, a strip or a fan, all of `material`.
/// TANGENT becomes the tangent space of `tangent_set`, the UV set that the material's normal texture
/// uses, if the mesh has that set. Its morph targets are applied with `morph_weights`, one a target.
/// Missing normals are then made flat. `place` is where the primitive stands: `meshes[i].primitives[j]`.
[[nodiscard]] mesh::TriangleMesh
read_primitive(const Document& document, const tinygltf::Primitive& primitive, const std::string& place,
               std::uint32_t material, std::size_t tangent_set, std::span<const double> morph_weights);

/// The vertices of its triangles as the file numbers them, in the order and with the corners of
/// read_primitive.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>>
read_triangles(const Document& document, const tinygltf::Primitive& primitive, const std::string& place);

} // namespace surfgrad::io::gltf
