#include "io/model_file.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"
#include "io/gltf.hpp"
#include "io/obj.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace surfgrad::io {
Model read_model(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension != ".gltf" && extension != ".glb" && extension != ".obj")
    throw InputError{{.file = file,
                      .problem = extension.empty() ? "has no extension"
                                                   : "\"" + extension + "\" is not a model's extension",
                      .remedy = "expected .gltf, .glb or .obj"}};
  const std::vector<std::byte> bytes = read_file(file);
  if (bytes.empty()) throw InputError{{.file = file, .problem = "is empty", .remedy = "expected a model"}};
  if (extension == ".obj") return read_obj(file, bytes);
  return read_gltf(file, bytes);
}

} // namespace surfgrad::io
