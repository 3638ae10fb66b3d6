#pragma once

#include "io/model_file.hpp"

#include <cstddef>
#include <filesystem>
#include <span>

namespace surfgrad::io {

/// The model in the bytes of a .gltf or .glb file; `file` serves messages and finds the files that
/// its URIs name. See read_model.
[[nodiscard]] Model read_gltf(const std::filesystem::path& file, std::span<const std::byte> bytes,
                              const ModelOptions& options);

} // namespace surfgrad::io
