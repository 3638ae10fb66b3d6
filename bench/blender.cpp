/// Comparison: a baked model, opened in Blender, shows the normals that were composed.
///
/// Peer    Blender's importer of glTF, its MikkTSpace, its normal map node and Cycles (blender_match.py).
/// Method  A stack is baked to a map of 8192x8192 and 16 bits inside a .glb. Blender renders the file's
/// normals from
///         near, one sample in the middle of each pixel: Cycles has no mip levels. The same picture of the
///         stack itself is what they are compared with. Pixels whose normal mirrors the viewer to below the
///         surface are left out: Cycles bends those, whatever the map.

#include "bake/bake.hpp"
#include "bake/model.hpp"
#include "bake_scene.hpp"
#include "child_process.hpp"
#include "io/file.hpp"
#include "io/image_file.hpp"
#include "race.hpp"
#include "render/camera.hpp"
#include "render/render.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::bench {
namespace {

namespace fs = std::filesystem;

struct Subject {
  std::string name{};
  scene::Scene scene{};
  double zoom = 1; ///< so near that a texel is larger than a pixel
};

/// A model of the shared assets under normal textures of its own or under these layers. Nothing where the
/// assets are absent.
void add_model(const std::string& name, const std::string& model, const std::string& layers, double zoom,
               const fs::path& folder, std::vector<Subject>& subjects) {
  const fs::path assets = SURFGRAD_SHARED_DIR "/assets";
  if (!fs::exists(assets / model))
    return report_absent("blender", name, model + " is not among the shared assets");
  if (layers.empty()) return subjects.push_back({name, scene::load_scene(assets / model), zoom});
  std::string document = R"({ "surfgrad": 1, "mesh": "@/)" + model + R"(", "layers": [)" + layers + "] }";
  for (std::size_t at = document.find('@'); at != std::string::npos; at = document.find('@', at))
    document.replace(at, 1, fs::absolute(assets).generic_string());
  io::write_file(folder / "stack.json", std::as_bytes(std::span(document)));
  subjects.push_back({name, scene::load_scene(folder / "stack.json"), zoom});
}

std::vector<Subject> subjects_in(const fs::path& folder) {
  std::vector<Subject> subjects;
  subjects.push_back({"torus, two maps and noise", bake_scene(1024), 8});
  add_model("Suzanne, its own map", "mesh/blenderio_suzanne/02_suzanne.gltf", "", 6, folder, subjects);
  add_model("mirrored islands, a map", "mesh/ogre_mirrored_uv/testmirroreduvmesh_converted.obj",
            R"({ "type": "normal_map", "map": "@/normal_tile/ogre_nm/NMBalls.png", "green": "down" })", 6,
            folder, subjects);
  return subjects;
}

/// The picture's normals of the stack.
void write_normals(const scene::Scene& scene, int side, render::Aov aov, const fs::path& file) {
  const render::Picture picture =
      render::render(scene, {.width = side, .height = side, .samples = 1, .aov = aov});
  io::write_image(file, picture.image, image::Depth::float32);
}

void compare(const Subject& subject, int map_side, int side, const fs::path& folder) {
  scene::Scene scene = subject.scene;
  scene.camera.zoom = subject.zoom;
  const bake::Options options{.width = map_side, .height = map_side, .padding = 16};
  const bake::Baked baked = bake::bake(scene, options);
  const fs::path model = folder / "model.glb";
  io::write_file(model, bake::encode_model_with_maps(
                            scene, {.normal_png = io::encode_image(baked.map, image::Depth::unorm16,
                                                                   io::ImageFormat::png)}));
  write_normals(scene, side, render::Aov::normal, folder / "composed.exr");
  write_normals(scene, side, render::Aov::base_normal, folder / "interpolated.exr");

  const render::Pinhole camera = render::place_camera(scene, side, side);
  const vec3<double> target = camera.eye + camera.forward;
  std::vector<std::string> words{"blender",
                                 "--background",
                                 "--factory-startup",
                                 "--python-exit-code",
                                 "1",
                                 "--python",
                                 SURFGRAD_BENCH_DIR "/blender_match.py",
                                 "--",
                                 model.string(),
                                 (folder / "composed.exr").string(),
                                 (folder / "interpolated.exr").string(),
                                 fmt::format("{}", side)};
  const double fov_deg = 2 * std::atan(0.5 * side / camera.focal_px) * 180 / std::numbers::pi;
  for (const double number :
       {camera.eye.x, camera.eye.y, camera.eye.z, target.x, target.y, target.z, fov_deg})
    words.push_back(fmt::format("{}", number));
  ChildProcess blender(words, "match: ");
  const std::optional<std::string> answer = blender.answer();
  if (!answer)
    return report_absent("blender", subject.name, "no program `blender` that runs blender_match.py");
  const auto match = nlohmann::json::parse(*answer);
  const Heat heat{.race = "blender", .title = subject.name};
  report_value(heat, "pixels compared", match["pixels"], "");
  report_value(heat, "pixels left out, which Cycles bends", match["left_out"], "");
  report_value(heat, "half of them within", match["half_deg"], "degrees");
  report_value(heat, "99 % of them within", match["high_deg"], "degrees");
  report_value(heat, "mean angle to the composed normals", match["mean_deg"], "degrees", {0.2, true});
}

} // namespace
} // namespace surfgrad::bench

int main(int argc, char** argv) {
  using namespace surfgrad::bench;
  const Request request = parse_request(argc, argv);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("surfgrad_bench_{}", std::random_device{}());
  std::filesystem::create_directories(folder);
  for (const Subject& subject : subjects_in(folder))
    compare(subject, request.quick ? 1024 : 8192, 512, folder);
  std::filesystem::remove_all(folder);
}
