#pragma once

#include <nlohmann/json_fwd.hpp>
#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::io::gltf {

/// Where an image is: in a bufferView or at a URI.
struct ImageSource {
  int view = -1; ///< index of the bufferView; -1: none
  std::optional<std::string> uri{};
};

/// A glTF 2.0 file as tinygltf holds it, checked as checked_document promises, buffers read.
struct Document {
  std::filesystem::path file{};      ///< as the user named it: for messages, and as the base of URIs
  tinygltf::Model model{};           ///< without images
  std::vector<ImageSource> images{}; ///< not read yet

  /// An InputError about `place` in this document.
  [[noreturn]] void fail(std::string place, std::string problem, std::string remedy) const;
  [[nodiscard]] bool uses(std::string_view extension) const;
  /// The bytes of a bufferView; InputError if it is not within its buffer.
  [[nodiscard]] std::span<const std::byte> bytes_of_view(int index) const;
};

/// The document in the bytes of a .gltf or .glb file. Reads the buffers' files, but no images.
[[nodiscard]] Document read_document(const std::filesystem::path& file, std::span<const std::byte> bytes);

/// All of its JSON, unchecked, with members in their order. InputError also where it is nested deeper than
/// any writer of JSON could follow.
[[nodiscard]] nlohmann::ordered_json read_json(const std::filesystem::path& file,
                                               std::span<const std::byte> bytes);

} // namespace surfgrad::io::gltf
