#pragma once

#include "io/gltf_document.hpp"

#include <surfgrad/vec.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace surfgrad::io::gltf {

/// Where a primitive stands: meshes[mesh].primitives[primitive].
struct PrimitivePlace {
  std::size_t mesh = 0;
  std::size_t primitive = 0;

  [[nodiscard]] std::string text() const;
};

[[nodiscard]] const tinygltf::Primitive& primitive_of(const Document& document, PrimitivePlace place);

/// A primitive of triangles under some morph weights, one for each of its targets.
struct ShownMesh {
  PrimitivePlace place{};
  std::vector<double> weights{};
};

/// A primitive that a node places in the world.
struct ShownObject {
  std::string name{};
  std::size_t node = 0;
  std::size_t mesh = 0; ///< index into Shown::meshes
  mat4<double> world_from_object{};
};

/// What the scene of a document shows: Model::meshes and Model::objects, each in its order.
struct Shown {
  std::vector<ShownMesh> meshes{};
  std::vector<ShownObject> objects{}; ///< at least one
};

/// morph_weights  those of ModelOptions. Throws as read_model does.
[[nodiscard]] Shown shown_by(const Document& document, std::span<const double> morph_weights);

} // namespace surfgrad::io::gltf
