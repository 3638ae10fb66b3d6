#pragma once

#include "io/model.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace surfgrad::io::gltf {

/// The model as glTF 2.0: a .glb, or the JSON form with its one buffer inside. What is kept and what is
/// not stands at write_model. `file` serves messages only.
///
/// Throws InputError where a number of a vertex is not finite or the file would be larger than the form
/// can be; std::invalid_argument where an array or an index breaks what Model promises.
[[nodiscard]] std::vector<std::byte> encode(const Model& model, bool is_binary,
                                            const std::filesystem::path& file);

} // namespace surfgrad::io::gltf
