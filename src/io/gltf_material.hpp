#pragma once

#include "diagnostic/report.hpp"
#include "io/gltf_document.hpp"
#include "io/model.hpp"

#include <vector>

namespace surfgrad::io::gltf {

/// All materials of the document in its order, with the images that their normal textures use,
/// several of them decoded at a time. Throws Cancelled where the report asks to stop.
[[nodiscard]] std::vector<ModelMaterial> read_materials(const Document& document, const Report& report);

} // namespace surfgrad::io::gltf
