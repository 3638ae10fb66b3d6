#pragma once

#include "stack/stack.hpp"

#include <string>
#include <vector>

namespace surfgrad::stack {

/// A map that a layer reads at a texture coordinate of the mesh.
struct TextureUse {
  const Texture* texture;
  bool vertex_frame; ///< the layer wants the tangents of that texture coordinate
  std::string key;   ///< of the texture's object, e.g. `layers[2].mask`
};

/// Every file that a layer names.
[[nodiscard]] std::vector<FileName*> files_of(Layer& layer);
[[nodiscard]] std::vector<const FileName*> files_of(const Layer& layer);

/// Every texture that a layer reads, its mask's too.
[[nodiscard]] std::vector<TextureUse> textures_of(const Layer& layer);

} // namespace surfgrad::stack
