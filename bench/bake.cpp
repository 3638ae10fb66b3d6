/// Race: baking two normal maps on two UV sets plus noise into one normal map.
///
/// Peer    Blender's Cycles (cycles_bake.py): the same mesh and maps, the same composition built of its
///         nodes, one octave of its Perlin noise through its bump node.
/// Method  The bake call alone on both sides, into an image that is there, on one processor, with as many
///         threads as said; one sample a texel, no margin, no tiles. Ours includes making slopes, mip levels
///         and tangents; Cycles' includes its own preparations. Reading and writing files is measured beside.
///         Without the noise, which is not the same function, both results are compared.

#include "bake/bake.hpp"
#include "bake_scene.hpp"
#include "child_process.hpp"
#include "io/image_file.hpp"
#include "io/model_file.hpp"
#include "race.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>

namespace surfgrad::bench {
namespace {

namespace fs = std::filesystem;

void write_inputs(const scene::Scene& scene, const fs::path& folder) {
  io::Model model;
  model.meshes = scene.meshes;
  model.objects.push_back({scene.objects[0].name, 0, scene.objects[0].world_from_object});
  model.materials.push_back({"race", true, {}});
  io::write_model(folder / "model.glb", model);
  for (const auto& [name, image] : scene.images) io::write_image(folder / name, *image, image->depth);
}

/// Blender, waiting for commands; null where there is none.
std::unique_ptr<ChildProcess> start_cycles(const fs::path& folder) {
  auto blender = std::make_unique<ChildProcess>(
      std::vector<std::string>{"blender", "--background", "--factory-startup", "--python-exit-code", "1",
                               "--python", SURFGRAD_BENCH_DIR "/cycles_bake.py", "--", folder.string(),
                               fmt::format("{}", noise_frequency), fmt::format("{}", noise_height)},
      "cycles: ");
  const std::optional<std::string> ready = blender->answer();
  if (!ready) {
    report_absent("bake", "Blender's Cycles", "no program `blender` that runs cycles_bake.py");
    return nullptr;
  }
  report_note("bake", "Blender " + ready->substr(std::string("ready ").size()));
  return blender;
}

/// Degrees between two maps of the same size: what half and what 90 % of the texels keep within, of those
/// that are tilted by less than 40 degrees. Cycles bends normals from about 45 degrees on, until they mirror
/// a viewer above the surface to somewhere above it.
void compare(const image::Image& ours, const image::Image& theirs) {
  std::vector<double> degrees;
  for (int y = 0; y < ours.height; ++y)
    for (int x = 0; x < ours.width; ++x) {
      const auto normal = [&](const image::Image& map) {
        return normalize_or_zero(
            vec3<double>{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1});
      };
      const vec3<double> a = normal(ours);
      const vec3<double> b = normal(theirs);
      if (a.z < 0.766) continue;
      degrees.push_back(std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi);
    }
  std::sort(degrees.begin(), degrees.end());
  const auto percentile = [&](double share) {
    return degrees[static_cast<std::size_t>(share * static_cast<double>(degrees.size() - 1))];
  };
  const double count = static_cast<double>(ours.width) * ours.height;
  const double mean =
      std::accumulate(degrees.begin(), degrees.end(), 0.0) / static_cast<double>(degrees.size());
  report_value({.race = "bake", .title = "normals without noise and mip levels"},
               "mean angle between ours and Cycles'", mean, "degrees", {0.05, true});
  report_note("bake",
              fmt::format("Without noise and mip levels half of the texels are within {:.4f} degrees of "
                          "Cycles', 90 % within {:.3f}; {:.0f} % are compared: those tilted by less than "
                          "40 degrees, for Cycles bends steeper ones.",
                          percentile(0.5), percentile(0.9),
                          100 * static_cast<double>(degrees.size()) / count));
}

void compare_results(const scene::Scene& scene, ChildProcess& cycles, const fs::path& folder, int size) {
  scene::Scene plain = scene;
  plain.materials[0].layers.resize(2);
  for (stack::Layer& layer : plain.materials[0].layers)
    std::get<stack::NormalMapLayer>(layer).map.filter = stack::Filter::bilinear; // Cycles knows no mip levels
  const fs::path file = folder / "cycles.exr";
  cycles.tell(fmt::format("save {} {}", size, file.string()));
  if (!cycles.answer()) return;
  compare(bake::bake(plain, {size, size, bake::Space::tangent}).map, io::read_image(file));
}

void race(const Request& request, const scene::Scene& scene, ChildProcess* cycles, int size, int threads) {
  const Heat heat{"bake",  fmt::format("{0}x{0}", size), "texel", double(size) * size,
                  threads, std::min(request.rounds, 5)};
  // Cycles bakes into an image that it has already; so do we.
  image::Image map = image::make_image(size, size, 3, image::Depth::unorm16);
  std::vector<Contestant> contestants{
      {"surfgrad", [&] {
         return timed([&] {
           limited_to(threads, [&] {
             (void)bake::bake_bands(scene, {size, size, bake::Space::tangent}, stage::into(map));
           });
         });
       }}};
  if (cycles != nullptr)
    contestants.push_back({"Cycles", [&] {
                             cycles->tell(fmt::format("bake {} {}", size, threads));
                             const std::string seconds = cycles->answer().value_or("nan nan");
                             std::size_t end = 0;
                             const double cpu = std::stod(seconds, &end);
                             return Time{cpu, std::stod(seconds.substr(end))};
                           }});
  const std::vector<Result> results = run(heat, contestants);
  if (cycles == nullptr) return;
  const double factor = times_faster(results[1], results[0]);
  if (size == 2048 && threads == 1)
    report_ratio(heat, "surfgrad over Cycles, processor time", factor, {25});
  else
    report_ratio(heat, "surfgrad over Cycles, processor time", factor);
}

/// Seconds of files: what the races leave out.
void time_files(const scene::Scene& scene, const fs::path& folder, int size) {
  const Heat heat{.race = "bake", .title = fmt::format("files, {0}x{0}", size)};
  const Time decode = timed([&] {
    for (const auto& [name, image] : scene.images) (void)io::read_image(folder / name);
  });
  report_value(heat, "reading two maps (PNG, 16 bits)", decode.cpu, "s");
  const image::Image map = bake::bake(scene, {size, size, bake::Space::tangent}).map;
  const Time encode =
      timed([&] { (void)io::encode_image(map, image::Depth::unorm16, io::ImageFormat::png); });
  report_value(heat, "writing the result (PNG, 16 bits)", encode.cpu, "s");
}

void race(const Request& request) {
  const std::vector<int> sizes = request.quick ? std::vector{256, 512} : std::vector{2048, 4096};
  const fs::path folder =
      fs::temp_directory_path() / fmt::format("surfgrad_bench_{}", std::random_device{}());
  fs::create_directories(folder);
  {
    const scene::Scene scene = bake_scene(sizes[0]);
    write_inputs(scene, folder);
    const std::unique_ptr<ChildProcess> cycles = start_cycles(folder);
    if (cycles) compare_results(scene, *cycles, folder, sizes[0]);
    for (const int threads : request.threads)
      for (const int size : sizes) race(request, scene, cycles.get(), size, threads);
    time_files(scene, folder, sizes[0]);
  }
  fs::remove_all(folder);
}

} // namespace
} // namespace surfgrad::bench

int main(int argc, char** argv) { surfgrad::bench::race(surfgrad::bench::parse_request(argc, argv)); }
