#include "gltf_output.hpp"

#include "bake/model.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"
#include "io/model_tangents.hpp"
#include "options.hpp"

namespace surfgrad::cli {

void GltfOutput::add_option(CLI::App& verb) {
  verb.add_option("--gltf", file_,
                  "also write the model as .glb, with its tangents and with the map as its normal texture;\n"
                  "the map must be a .png of --space tangent, --encoding rgb and --green up")
      ->check(not_empty())
      ->type_name("FILE");
}

void GltfOutput::check(const OutputNames& names, const std::vector<std::string>& scenes) const {
  names.check("--gltf", file_.string(), scenes);
}

void GltfOutput::rename(const std::function<std::filesystem::path(const std::string&)>& file_for) {
  file_ = file_for(file_.string());
}

void GltfOutput::check(const bake::Options& job, const std::filesystem::path& map) const {
  if (!is_wanted()) return;
  if (io::lower_extension(map) != ".png" || job.space != bake::Space::tangent ||
      job.encoding != bake::Encoding::rgb || job.green != stack::Green::up)
    throw CLI::ValidationError(
        "--gltf", "glTF holds a map that is a .png of --space tangent, --encoding rgb and --green up");
  const Unbroken probe;
  io::check_glb_output(file_);
}

void GltfOutput::write(const scene::Scene& scene, const bake::Options& job, const bake::Counts& baked,
                       const Maps& maps, bool quiet) const {
  if (!is_wanted()) return;
  Console console("writing the model", quiet);
  const std::vector<std::byte> glb = bake::encode_model_with_maps(scene,
                                                                  {.uv_set = job.uv_set,
                                                                   .normal_png = io::read_file(maps.normal),
                                                                   .roughness = maps.roughness,
                                                                   .is_repeated = baked.outside > 0},
                                                                  console.report());
  const Unbroken whole_file;
  stop_if_interrupted();
  io::write_file(file_, glb);
}

} // namespace surfgrad::cli
