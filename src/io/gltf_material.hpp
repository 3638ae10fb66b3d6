#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "io/gltf_document.hpp"
#include "io/model.hpp"

#include <string>
#include <vector>

namespace surfgrad::io::gltf {

/// All materials of the document in its order, with the images that their normal textures use,
/// several of them decoded at a time. Throws Cancelled where the report asks to stop.
[[nodiscard]] std::vector<ModelMaterial> read_materials(const Document& document, const Report& report);

/// The image of a texture. Throws InputError at `place`, which names the texture, where there is no such one,
/// and as read_materials does.
[[nodiscard]] image::Image read_texture(const Document& document, int texture, const std::string& place);

} // namespace surfgrad::io::gltf
