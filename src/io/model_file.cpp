#include "io/model_file.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"
#include "io/gltf.hpp"
#include "io/gltf_writer.hpp"
#include "io/model_bytes.hpp"
#include "io/obj.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <new>
#include <string>
#include <vector>

namespace surfgrad::io {
namespace {

ModelFormat output_format(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".glb") return ModelFormat::glb;
  if (extension == ".gltf") return ModelFormat::gltf;
  throw InputError{{.file = file,
                    .problem = fmt::format("no model can be written for the extension \"{}\"", extension),
                    .remedy = "expected .glb or .gltf"}};
}

std::vector<std::byte> encode(const Model& model, ModelFormat format, const std::filesystem::path& file) {
  try {
    return gltf::encode(model, format == ModelFormat::glb, file);
  } catch (const std::bad_alloc&) {
    throw MachineError(fmt::format("{}: not enough memory to encode this model", file.string()));
  }
}

} // namespace

std::vector<std::byte> read_model_bytes(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  if (extension != ".gltf" && extension != ".glb" && extension != ".obj")
    throw InputError{{.file = file,
                      .problem = extension.empty() ? "has no extension"
                                                   : "\"" + extension + "\" is not a model's extension",
                      .remedy = "expected .gltf, .glb or .obj"}};
  std::vector<std::byte> bytes = read_file(file);
  if (bytes.empty()) throw InputError{{.file = file, .problem = "is empty", .remedy = "expected a model"}};
  return bytes;
}

Model read_model(const std::filesystem::path& file, const ModelOptions& options) {
  const std::vector<std::byte> bytes = read_model_bytes(file);
  if (lower_extension(file) != ".obj") return read_gltf(file, bytes, options);
  if (!options.morph_weights.empty())
    throw TooManyWeights{{.file = file,
                          .problem = "has no morph targets: the format knows none",
                          .remedy = "leave out their weights or convert the model to glTF"}};
  return read_obj(file, bytes);
}

std::vector<std::byte> encode_model(const Model& model, ModelFormat format) {
  return encode(model, format, {});
}

void write_model(const std::filesystem::path& file, const Model& model) {
  write_file(file, encode(model, output_format(file), file));
}

void check_model_output(const std::filesystem::path& file) {
  output_format(file);
  check_writable(file);
}

} // namespace surfgrad::io
