#include "stack/uses.hpp"

#include <type_traits>

namespace surfgrad::stack {

std::vector<FileName*> files_of(Layer& layer) {
  std::vector<FileName*> files;
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.map.file; }) files.push_back(&kind.map.file);
        if constexpr (requires { kind.file; }) files.push_back(&kind.file);
        if constexpr (requires { kind.files; })
          for (FileName& file : kind.files) files.push_back(&file);
        if constexpr (requires { kind.common.mask; })
          if (kind.common.mask) files.push_back(&kind.common.mask->file);
      },
      layer);
  return files;
}

std::vector<TextureUse> textures_of(const Layer& layer) {
  std::vector<TextureUse> textures;
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.map.uv; }) {
          bool vertex_frame = false;
          if constexpr (requires { kind.basis; }) vertex_frame = kind.basis == Basis::mikktspace;
          textures.push_back({&kind.map, vertex_frame, kind.common.key});
        }
        if constexpr (requires { kind.common.mask; })
          if (kind.common.mask) textures.push_back({&*kind.common.mask, false, kind.common.key + ".mask"});
      },
      layer);
  return textures;
}

} // namespace surfgrad::stack
