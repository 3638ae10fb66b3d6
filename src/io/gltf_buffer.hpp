#pragma once

#include "io/gltf_document.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace surfgrad::io::gltf {

/// The file that a URI names, below the folder of the model. Throws at `uri` if it names a scheme,
/// an absolute path, a parent folder or a missing file, or has a bad percent code.
[[nodiscard]] std::filesystem::path resolve_uri(const Element& uri);

/// The bytes of a `data:...;base64,` URI; nothing if the URI is of another kind.
[[nodiscard]] std::optional<std::vector<std::byte>> decode_data_uri(const Element& uri);

/// Bytes of a bufferView.
struct BufferView {
  std::span<const std::byte> bytes{};
  std::size_t stride = 0; ///< bytes between elements; 0: they lie tightly
};

/// The buffers of a document, each read when first used.
class Buffers {
 public:
  explicit Buffers(const Document& document) : document_(&document), loaded_(document.count("buffers")) {}

  /// The view that `reference` is the index of. Lives as long as this object and the document.
  [[nodiscard]] BufferView view(const Element& reference);

 private:
  [[nodiscard]] std::span<const std::byte> buffer(const Element& reference);

  const Document* document_;
  std::vector<std::optional<std::vector<std::byte>>> loaded_;
};

} // namespace surfgrad::io::gltf
