#include "io/model_files.hpp"

#include "io/extension.hpp"
#include "io/gltf_document.hpp"
#include "io/gltf_uri.hpp"
#include "io/model_bytes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstddef>

namespace surfgrad::io {

std::vector<std::filesystem::path> files_named_by(const std::filesystem::path& model) {
  if (lower_extension(model) == ".obj") return {};
  const nlohmann::ordered_json json = gltf::read_json(model, read_model_bytes(model));
  std::vector<std::filesystem::path> files;
  for (const char* const kind : {"buffers", "images"}) {
    if (!json.contains(kind)) continue;
    for (std::size_t i = 0; i < json[kind].size(); ++i) {
      const auto& entry = json[kind][i];
      if (!entry.contains("uri")) continue;
      if (auto file = gltf::file_of_uri(model, fmt::format("{}[{}]", kind, i), entry["uri"]))
        files.push_back(*file);
    }
  }
  return files;
}

} // namespace surfgrad::io
