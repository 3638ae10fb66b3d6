#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace surfgrad::io::gltf {

/// What a URI stands for.
struct Resource {
  std::filesystem::path name{}; ///< the file; for data in the URI itself `model.gltf:images[3]`
  std::vector<std::byte> bytes{};
};

/// What the URI of `owner`, an entry such as `images[3]` of the document in `model`, stands for: a
/// file below the folder of the model, or base64 data. Throws InputError at the URI's place if it
/// names a scheme, an absolute path, a parent folder or a missing file, or is badly encoded.
[[nodiscard]] Resource read_uri(const std::filesystem::path& model, const std::string& owner,
                                const std::string& uri);

/// The file that a URI names; none for data in the URI itself. Throws as read_uri, but for a missing file.
[[nodiscard]] std::optional<std::filesystem::path>
file_of_uri(const std::filesystem::path& model, const std::string& owner, const std::string& uri);

} // namespace surfgrad::io::gltf
