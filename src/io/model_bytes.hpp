#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace surfgrad::io {

/// The content, not empty, of a file that is named like a model: .gltf, .glb or .obj. Throws as read_model
/// does.
[[nodiscard]] std::vector<std::byte> read_model_bytes(const std::filesystem::path& file);

} // namespace surfgrad::io
