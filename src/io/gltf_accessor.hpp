#pragma once

#include "io/gltf_document.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace surfgrad::io::gltf {

/// The vertex attributes that are read, each with its own shape and number formats.
enum class Attribute { position, normal, tangent, texcoord };

/// Components in one element: 3, 3, 4, 2.
[[nodiscard]] std::size_t component_count(Attribute attribute);

/// The accessor of this index as floats, component_count(attribute) a vertex. Integers are scaled as
/// the format says; sparse values are applied. All results are finite. KHR_mesh_quantization is
/// honoured where declared. `place` is where the index stands, e.g. `meshes[0].primitives[0].indices`.
[[nodiscard]] std::vector<float> read_attribute(const Document& document, int index, Attribute attribute,
                                                const std::string& place);

/// Vertex indices, each below `vertex_count`.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const Document& document, int index,
                                                      std::size_t vertex_count, const std::string& place);

/// The components of any accessor, in order, as they are stored: each the bits of its number. Sparse values
/// are applied. One that is nobody's, such as a colour's, may have any type but matrices of bytes or shorts.
[[nodiscard]] std::vector<std::uint32_t> read_bits(const Document& document, int index);

/// Bytes of one component.
[[nodiscard]] std::size_t component_size(int component_type);

} // namespace surfgrad::io::gltf
