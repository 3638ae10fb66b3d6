#pragma once

#include "io/gltf_document.hpp"
#include "io/model.hpp"

#include <vector>

namespace surfgrad::io::gltf {

/// All materials of the document in its order, with the images that their normal textures use.
[[nodiscard]] std::vector<ModelMaterial> read_materials(const Document& document);

} // namespace surfgrad::io::gltf
