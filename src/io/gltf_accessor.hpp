#pragma once

#include "io/gltf_buffer.hpp"
#include "io/gltf_document.hpp"

#include <cstdint>
#include <vector>

namespace surfgrad::io::gltf {

/// The vertex attributes that are read, each with its own shape and number formats.
enum class Attribute { position, normal, tangent, texcoord };

/// Components in one element: 3, 3, 4, 2.
[[nodiscard]] std::size_t component_count(Attribute attribute);

/// The accessor that `reference` (e.g. `meshes[0].primitives[0].attributes.NORMAL`) is the index of,
/// as floats, component_count(attribute) a vertex. Integers are scaled as the format says; sparse
/// values are applied. All results are finite. KHR_mesh_quantization is honoured where declared.
[[nodiscard]] std::vector<float> read_attribute(const Element& reference, Attribute attribute,
                                                Buffers& buffers);

/// Vertex indices, each below `vertex_count`.
[[nodiscard]] std::vector<std::uint32_t> read_indices(const Element& reference, std::size_t vertex_count,
                                                      Buffers& buffers);

} // namespace surfgrad::io::gltf
