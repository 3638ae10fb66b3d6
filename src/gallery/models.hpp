#pragma once

#include "diagnostic/report.hpp"
#include "gallery/figure.hpp"

#include <filesystem>

namespace surfgrad::gallery {

/// The models (.gltf, .glb, .obj) in a folder and those below it that bring normal maps, each with and
/// without them, in the order of their paths.
///
/// Throws InputError where the folder is missing or has no such model. Warns about models that cannot be
/// read, and leaves them out.
[[nodiscard]] Figure model_figure(const std::filesystem::path& folder, const Report& report);

} // namespace surfgrad::gallery
