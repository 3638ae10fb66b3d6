#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace surfgrad::io::gltf {

/// An InputError about `place` in the document, e.g. `accessors[5].byteOffset`.
[[noreturn]] void fail(const std::filesystem::path& file, std::string place, std::string problem,
                       std::string remedy);

/// The part of a glTF 2.0 document that is read here; all else is left out. tinygltf takes a value
/// of a wrong type for a missing one, wraps large integers and tells no places, so it gets to see
/// only what is returned here: values of the format's types, in range, indices in range of their
/// arrays, and every number that need not be whole a double.
///
/// Throws InputError at the place of the first value that is otherwise, and for other versions of
/// glTF and required extensions that would change what is read here.
[[nodiscard]] nlohmann::json checked_document(const std::filesystem::path& file,
                                              const nlohmann::json& document);

} // namespace surfgrad::io::gltf
