#pragma once

#include "io/model.hpp"

#include <cstddef>
#include <filesystem>
#include <span>

namespace surfgrad::io {

/// The model in the bytes of a .gltf or .glb file; `file` serves messages and finds the files that
/// its URIs name. See read_model and, for `morph_weights`, ModelOptions.
[[nodiscard]] Model read_gltf(const std::filesystem::path& file, std::span<const std::byte> bytes,
                              std::span<const double> morph_weights);

} // namespace surfgrad::io
