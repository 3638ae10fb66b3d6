#pragma once

#include "engine/map_library.hpp"
#include "gpu/map_words.hpp"
#include "shadergen/shadergen.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace surfgrad::gpu {

/// The map of a texture that is one map; not of a relief.
///
/// throws  InputError where an image does not serve for it
[[nodiscard]] std::shared_ptr<const image::Map> map_of(const shadergen::TextureBinding& texture,
                                                       engine::MapLibrary& library);

/// The engine's maps that a generated shader with `exact` access reads.
class StackMaps {
 public:
  /// format_of  of the textures that are sampled, if any are
  /// throws     InputError where an image does not serve for its map
  StackMaps(const shadergen::Shader& shader, engine::MapLibrary& library,
            const std::function<TextureFormat(const image::Map&, stack::Filter)>& format_of = {});

  /// In the order of Shader::textures, a relief's twice.
  [[nodiscard]] const std::vector<StackMap>& maps() const { return maps_; }

 private:
  std::vector<StackMap> maps_;
  std::vector<std::shared_ptr<const void>> owners_;
  void add_sampled(const std::shared_ptr<const image::Map>& map, const TextureFormat& format,
                   const std::string& file);
};

} // namespace surfgrad::gpu
