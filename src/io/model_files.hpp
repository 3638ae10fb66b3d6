#pragma once

#include <filesystem>
#include <vector>

namespace surfgrad::io {

/// The files that a model names beside itself: buffers and all images, whether read_model reads them or not.
/// None for an OBJ, of which nothing else is read.
///
/// Throws InputError as read_model does for what it looks at.
[[nodiscard]] std::vector<std::filesystem::path> files_named_by(const std::filesystem::path& model);

} // namespace surfgrad::io
