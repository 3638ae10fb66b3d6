#include "stack/uses.hpp"

#include <type_traits>

namespace surfgrad::stack {

namespace {

/// Name  FileName or const FileName, as the layer is
template <class Name, class AnyLayer>
std::vector<Name*> names_in(AnyLayer& layer) {
  std::vector<Name*> files;
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.map.file; }) files.push_back(&kind.map.file);
        if constexpr (requires { kind.file; }) files.push_back(&kind.file);
        if constexpr (requires { kind.files; })
          for (Name& file : kind.files) files.push_back(&file);
        if constexpr (requires { kind.common.mask; })
          if (kind.common.mask) files.push_back(&kind.common.mask->file);
      },
      layer);
  return files;
}

} // namespace

std::vector<FileName*> files_of(Layer& layer) { return names_in<FileName>(layer); }
std::vector<const FileName*> files_of(const Layer& layer) { return names_in<const FileName>(layer); }

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
