#pragma once

#include "engine/map_library.hpp"
#include "gpu/map_words.hpp"
#include "shadergen/shadergen.hpp"

#include <memory>
#include <vector>

namespace surfgrad::gpu {

/// The engine's maps that a generated shader with `exact` access reads.
class StackMaps {
 public:
  /// throws  InputError where an image does not serve for its map
  StackMaps(const shadergen::Shader& shader, engine::MapLibrary& library);

  /// In the order of Shader::textures, a relief's twice.
  [[nodiscard]] const std::vector<StackMap>& maps() const { return maps_; }

 private:
  std::vector<StackMap> maps_;
  std::vector<std::shared_ptr<const void>> owners_;
};

} // namespace surfgrad::gpu
