/// Race: how the cost of a bake grows, with no peer but itself.
///
/// Method  Layers of every kind, 1 to 32, and decals, 1 to 1000, in one bake of a torus; parallax, which
///         needs a viewer, in a picture of it. Threads: one, two, and two processes of one thread each, which
///         share nothing but the machine. Sizes: each in a process of its own, whose peak of memory is read
///         back. Inputs are decoded before, results are handed over in bands and dropped.

#include "growth.hpp"

#include "bake/bake.hpp"
#include "bake_scene.hpp"
#include "child_process.hpp"
#include "image/map.hpp"
#include "render/render.hpp"
#include "scene/demo_maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <string_view>
#include <utility>

namespace surfgrad::bench {
namespace {

constexpr const char* normals = first_map;
constexpr const char* heights = "heights.png";

/// The bake race's torus with heights at hand, still without layers.
scene::Scene bare_scene(int map_size) {
  scene::Scene scene = bake_scene(map_size);
  scene.images[heights] = std::make_shared<image::Image>(scene::stripes_mask(map_size));
  scene.materials[0].layers.clear();
  return scene;
}

stack::Layer normal_map(stack::Basis basis) {
  stack::NormalMapLayer layer;
  layer.map.file.path = normals;
  layer.basis = basis;
  return layer;
}

stack::Layer masked_normal_map() {
  stack::NormalMapLayer layer;
  layer.map.file.path = normals;
  layer.common.mask.emplace();
  layer.common.mask->file.path = heights;
  return layer;
}

stack::Layer derivative_map() {
  stack::DerivativeMapLayer layer;
  layer.map.file.path = normals;
  return layer;
}

stack::Layer height_map(stack::HeightMode mode) {
  stack::HeightMapLayer layer;
  layer.map.file.path = heights;
  layer.mode = mode;
  layer.height = 0.01;
  if (mode == stack::HeightMode::scale_free) layer.taps = stack::Taps::bicubic;
  return layer;
}

stack::Layer object_normal_map() {
  stack::ObjectNormalMapLayer layer;
  layer.map.file.path = normals;
  layer.common.scale = 0.1;
  return layer;
}

stack::Layer noise(stack::NoiseKind kind) {
  stack::NoiseLayer layer;
  layer.noise.function = kind;
  layer.noise.frequency = noise_frequency;
  layer.common.scale = noise_height;
  return layer;
}

stack::Layer planar() {
  stack::PlanarLayer layer;
  layer.file.path = normals;
  return layer;
}

stack::Layer triplanar() {
  stack::TriplanarLayer layer;
  layer.files.resize(1);
  layer.files[0].path = normals;
  return layer;
}

stack::Layer parallax() {
  stack::ParallaxLayer layer;
  layer.map.file.path = heights;
  layer.height = 0.02;
  return layer;
}

/// Rivets all over the torus, none larger than what 1000 of them leave room for.
stack::DecalLayer decals(int count) {
  stack::DecalLayer layer;
  layer.files.resize(1);
  layer.files[0].path = normals;
  layer.space = stack::Space::object;
  layer.instances.clear();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(0, 6.283185);
  for (int i = 0; i < count; ++i) {
    const double u = angle(random);
    const double v = angle(random);
    const vec3<double> n{std::cos(v) * std::sin(u), std::sin(v), std::cos(v) * std::cos(u)};
    stack::DecalInstance instance;
    instance.size = {0.12, 0.12, 0.3};
    instance.position = vec3<double>{std::sin(u), 0, std::cos(u)} + 0.45 * n;
    instance.direction = -n;
    layer.instances.push_back(instance);
  }
  return layer;
}

struct Kind {
  const char* name;
  stack::Layer layer;
  bool in_picture = false; ///< needs a viewer
};

std::vector<Kind> kinds() {
  return {{"normal_map, vertex frame", normal_map(stack::Basis::mikktspace)},
          {"normal_map, derived frame", normal_map(stack::Basis::derived)},
          {"normal_map under a mask", masked_normal_map()},
          {"derivative_map", derivative_map()},
          {"height_map, three taps", height_map(stack::HeightMode::physical)},
          {"height_map, scale-free", height_map(stack::HeightMode::scale_free)},
          {"object_normal_map", object_normal_map()},
          {"noise, perlin", noise(stack::NoiseKind::perlin)},
          {"noise, simplex", noise(stack::NoiseKind::simplex)},
          {"noise, worley", noise(stack::NoiseKind::worley)},
          {"noise, turbulence of 4 octaves", noise(stack::NoiseKind::turbulence)},
          {"planar", planar()},
          {"triplanar", triplanar()},
          {"decal, 50 boxes", decals(50)},
          {"resolve", stack::ResolveLayer{}},
          {"parallax (in a picture)", parallax(), true}};
}

/// Results are not wanted.
void drop(const image::Image& /*band*/) {}

Time bake_time(const scene::Scene& scene, int size, int threads) {
  return timed([&] {
    limited_to(threads, [&] { (void)bake::bake_bands(scene, {size, size, bake::Space::tangent}, drop); });
  });
}

Time picture_time(const scene::Scene& scene, int size, int threads) {
  return timed([&] {
    limited_to(threads, [&] {
      (void)render::render_bands(scene, {.width = size, .height = size, .samples = 1}, drop);
    });
  });
}

/// Kilobytes behind a name in what the system tells about this process.
double own_kilobytes(std::string_view name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(name)) return std::atof(line.c_str() + name.size() + 1);
  return 0;
}

std::unique_ptr<ChildProcess> start_child(int size, int map_size, int bits = 16) {
  auto child = std::make_unique<ChildProcess>(
      std::vector<std::string>{"/proc/self/exe", "--child", std::to_string(size), std::to_string(map_size),
                               std::to_string(bits)},
      "child: ");
  (void)child->answer(); // ready
  return child;
}

/// What a child answers.
struct Baked {
  Time time;
  double bare = 0, peak = 0; ///< bytes: of the process before it loaded anything, and at its peak
};

Baked answer_of(ChildProcess& child) {
  Baked baked;
  const std::string text = child.answer().value_or("");
  if (std::sscanf(text.c_str(), "%lf %lf %lf %lf", &baked.time.cpu, &baked.time.wall, &baked.bare,
                  &baked.peak) != 4)
    std::fprintf(stderr, "a bake in a process of its own failed\n");
  return baked;
}

} // namespace

void race_layers(const Request& request) {
  const std::vector<int> counts = request.quick ? std::vector{1, 4} : std::vector{1, 2, 4, 8, 16, 32};
  const int size = request.quick ? 64 : 512;
  for (const Kind& kind : kinds()) {
    Heat heat{"growth", "layers of one kind", "pixel", double(size) * size, 1, request.rounds};
    std::vector<Contestant> contestants;
    for (const int count : counts) {
      auto scene = std::make_shared<scene::Scene>(bare_scene(512));
      scene->materials[0].layers.assign(static_cast<std::size_t>(count), kind.layer);
      contestants.push_back({fmt::format("{}", count), [scene, size, in_picture = kind.in_picture] {
                               return in_picture ? picture_time(*scene, size, 1) : bake_time(*scene, size, 1);
                             }});
    }
    report_growth(heat, kind.name, counts, run_quietly(heat, contestants));
  }
}

void race_decals(const Request& request) {
  const std::vector<int> counts{1, 10, 100, 1000};
  const int size = request.quick ? 128 : 1024;
  const Heat heat{"growth", "decals of one layer", "pixel", double(size) * size, 1, request.rounds};
  std::vector<Contestant> contestants;
  for (const int count : counts) {
    auto scene = std::make_shared<scene::Scene>(bare_scene(512));
    scene->materials[0].layers.emplace_back(decals(count));
    contestants.push_back({fmt::format("{}", count), [scene, size] { return bake_time(*scene, size, 1); }});
  }
  report_growth(heat, "decal, boxes scattered over the torus", counts, run_quietly(heat, contestants));
}

void race_threads(const Request& request) {
  const int size = request.quick ? 256 : 2048;
  const scene::Scene scene = bake_scene(1024);
  Heat heat{"growth",      fmt::format("threads: bake {0}x{0}", size), "texel", double(size) * size, 2,
            request.rounds};
  const std::unique_ptr<ChildProcess> children[2]{start_child(size, 1024), start_child(size, 1024)};
  const std::vector<Result> r =
      run(heat, {{"1 thread", [&] { return bake_time(scene, size, 1); }},
                 {"2 threads", [&] { return bake_time(scene, size, 2); }},
                 {"2 processes of 1 thread, two bakes", [&] {
                    for (const auto& child : children) child->tell("bake");
                    const Baked a = answer_of(*children[0]);
                    const Baked b = answer_of(*children[1]);
                    return Time{a.time.cpu + b.time.cpu, std::max(a.time.wall, b.time.wall)};
                  }}});
  const double threads = times_faster(r[0], r[1], Clock::wall);
  const double processes = 2 * times_faster(r[0], r[2], Clock::wall);
  report_ratio(heat, "2 threads over 1", threads, {1.8});
  report_ratio(heat, "2 processes over 1", processes);
  report_value(heat, "2 threads, of what 2 processes reach (either target is enough)",
               100 * threads / processes, "%", {90});
  heat.title = fmt::format("threads: render {0}x{0}", size);
  const std::vector<Result> p = run(heat, {{"1 thread", [&] { return picture_time(scene, size, 1); }},
                                           {"2 threads", [&] { return picture_time(scene, size, 2); }}});
  report_ratio(heat, "2 threads over 1", times_faster(p[0], p[1], Clock::wall), {1.8});
}

void race_sizes(const Request& request) {
  const std::vector<int> sizes =
      request.quick ? std::vector{128, 256, 512} : std::vector{512, 1024, 2048, 4096, 8192};
  const int map_size = request.quick ? 512 : 4096;
  for (const int bits : {8, 16}) {
    const Heat heat{"growth", fmt::format("sizes: bake under two maps of {0}x{0}, {1} bits", map_size, bits),
                    "bake",   1,
                    1,        std::min(request.rounds, 5)};
    std::vector<std::unique_ptr<ChildProcess>> children;
    // Of the first bake of a process: later ones find memory that the first has given back to the process.
    std::vector<std::optional<Baked>> first(sizes.size());
    std::vector<Contestant> contestants;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      children.push_back(start_child(sizes[i], map_size, bits));
      contestants.push_back({fmt::format("{0}x{0}", sizes[i]), [&, i] {
                               children[i]->tell("bake");
                               const Baked baked = answer_of(*children[i]);
                               if (!first[i]) first[i] = baked;
                               return baked.time;
                             }});
    }
    const std::vector<Result> results = run(heat, contestants);
    constexpr double mib = 1024.0 * 1024.0;
    const int texel_words = bits == 8 ? 1 : 2; // two codes of 16 bits, or two floats
    const double maps = 2 * 4 * static_cast<double>(image::words_of_map(map_size, map_size, texel_words));
    report_value(heat, "the maps: slopes with their mip levels", maps / mib, "MiB");
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const Baked& b = *first[i];
      report_value(heat, fmt::format("{0}x{0}: memory beyond the maps", sizes[i]),
                   (b.peak - b.bare - maps) / mib, "MiB", {64, true});
      if (sizes[i] == sizes.back())
        report_value(heat, fmt::format("{0}x{0}: whole process at its peak", sizes[i]), b.peak / mib, "MiB",
                     {1024, true});
    }
    for (std::size_t i = 1; i < sizes.size(); ++i) {
      const std::string what = fmt::format("time of {0}x{0} over {1}x{1}", sizes[i], sizes[i - 1]);
      const double factor = times_faster(results[i], results[i - 1]);
      if (sizes[i] == 4096)
        report_ratio(heat, what, factor, {4.2, true});
      else
        report_ratio(heat, what, factor);
    }
  }
}

/// The first bake takes the scene and, as the program does, lets go of its images; the others leave theirs.
void bake_when_told(int size, int map_size, int bits) {
  const auto make_scene = [&] {
    return bake_scene(map_size, bits == 8 ? image::Depth::unorm8 : image::Depth::unorm16);
  };
  const double bare = 1024 * own_kilobytes("VmRSS:"); // before anything is loaded
  scene::Scene scene = make_scene();
  bool first = true;
  std::cout << "child: ready" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    scene::Scene taken = first ? std::move(scene) : scene;
    std::ofstream("/proc/self/clear_refs") << "5"; // the peak starts anew
    const Time time = timed([&] {
      limited_to(1, [&] {
        (void)bake::bake_bands(std::move(taken), {size, size, bake::Space::tangent}, drop);
      });
    });
    std::cout << fmt::format("child: {} {} {} {}", time.cpu, time.wall, bare, 1024 * own_kilobytes("VmHWM:"))
              << std::endl;
    if (std::exchange(first, false)) scene = make_scene();
  }
}

} // namespace surfgrad::bench

int main(int argc, char** argv) {
  using namespace surfgrad::bench;
  if (argc == 5 && std::string_view(argv[1]) == "--child") {
    bake_when_told(std::atoi(argv[2]), std::atoi(argv[3]), std::atoi(argv[4]));
    return 0;
  }
  const Request request = parse_request(argc, argv);
  race_layers(request);
  race_decals(request);
  race_threads(request);
  race_sizes(request);
}
