#pragma once

#include "io/model.hpp"

#include <cstddef>
#include <filesystem>
#include <span>

namespace surfgrad::io {

/// The model in the bytes of a Wavefront OBJ; `file` serves messages and names the object. See
/// read_model.
[[nodiscard]] Model read_obj(const std::filesystem::path& file, std::span<const std::byte> bytes);

} // namespace surfgrad::io
