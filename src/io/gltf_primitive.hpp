#pragma once

#include "io/gltf_buffer.hpp"
#include "io/gltf_document.hpp"
#include "mesh/triangle_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace surfgrad::io::gltf {

/// The triangles of `primitive` (`meshes[i].primitives[j]`), all of `material`; nothing if it is
/// made of points or lines. TANGENT becomes the tangent space of `tangent_set`, the UV set that the
/// material's normal texture uses, if the mesh has that set. Missing normals are made flat.
[[nodiscard]] std::optional<mesh::TriangleMesh>
read_primitive(const Element& primitive, std::uint32_t material, std::size_t tangent_set, Buffers& buffers);

} // namespace surfgrad::io::gltf
