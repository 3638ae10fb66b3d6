/// Race: a picture of three trilinear normal maps on three derived bases, lit by a sun through GGX.
///
/// Peer    Mesa's lavapipe: Vulkan on the processor, its shaders compiled to vector code
///         (lavapipe_render.frag).
/// Method  The same sphere, maps, mip levels, camera and shading; one sample a pixel, into a picture that is
///         there. Covered pixels over processor seconds. What is done once is left out on both sides: of
///         lavapipe uploads and the compilation of shaders, of ours reading maps into slopes, mip levels and
///         the lights' tables (the time of a picture of 16x16 is subtracted). Both pictures are compared and
///         written to the current folder.

#include "render/render.hpp"
#include "io/image_file.hpp"
#include "race.hpp"
#include "render/camera.hpp"
#include "render/shading.hpp"
#include "scene/demo_maps.hpp"
#include "slope_pyramid.hpp"
#include "stage/bands.hpp"
#if SURFGRAD_BENCH_LAVAPIPE
#include "lavapipe.hpp"
#endif

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace surfgrad::bench {
namespace {

constexpr int map_size = 1024;
constexpr const char* map_names[3] = {"plates", "weave", "fine weave"};

vec3<float> narrow(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// A sphere with three UV sets, the second turned and the third finer.
mesh::TriangleMesh sphere() {
  constexpr int columns = 192;
  constexpr int rows = 96;
  mesh::TriangleMesh mesh;
  mesh.uv_sets.resize(3);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double s = static_cast<double>(i) / columns;
      const double t = static_cast<double>(j) / rows;
      const double u = 2 * std::numbers::pi * s;
      const double v = std::numbers::pi * (0.998 * t - 0.499); // without the poles themselves
      const vec3<double> n{std::cos(v) * std::sin(u), std::sin(v), std::cos(v) * std::cos(u)};
      mesh.positions.push_back(narrow(n));
      mesh.normals.push_back(narrow(n));
      const auto uv = [](double a, double b) {
        return vec2<float>{static_cast<float>(a), static_cast<float>(b)};
      };
      mesh.uv_sets[0].push_back(uv(6 * s, 3 * t));
      mesh.uv_sets[1].push_back(uv(8 * s + 3 * t, 4 * t - 2 * s));
      mesh.uv_sets[2].push_back(uv(14 * s, 7 * t));
    }
  const auto vertex = [](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  mesh.material_of_triangle.assign(mesh.triangles.size(), 0);
  return mesh;
}

/// As most normal maps come: in 8 bits.
image::Image in_8_bits(image::Image map) {
  for (float& value : map.texels.floats()) value = std::round(value * 255) / 255;
  map.depth = image::Depth::unorm8;
  return map;
}

scene::Scene make_scene() {
  scene::Scene scene;
  scene.meshes.push_back(sphere());
  scene.objects.push_back({"sphere", 0, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
  scene.images[map_names[0]] = std::make_shared<image::Image>(in_8_bits(scene::plates_normal_map(map_size)));
  scene.images[map_names[1]] = std::make_shared<image::Image>(in_8_bits(scene::weave_normal_map(map_size)));
  scene.images[map_names[2]] = scene.images[map_names[1]];
  scene.materials.push_back({"bumps", stack::BackFaces::cull, {}});
  for (int k = 0; k < 3; ++k) {
    stack::NormalMapLayer layer;
    layer.map.file.path = map_names[k];
    layer.map.uv = k;
    layer.basis = stack::Basis::derived;
    scene.materials[0].layers.emplace_back(layer);
  }
  scene.camera = {.yaw_deg = 20, .pitch_deg = 0, .zoom = 1.4}; // the sphere reaches beyond all four sides
  scene.lights.sun.emplace();
  scene.lights.sky = 0;
  return scene;
}

#if SURFGRAD_BENCH_LAVAPIPE
/// Share of a white sky that the glaze mirrors, at cosines k / 64.
void fill_mirrored(PeerLight& light, const stack::Lights& lights) {
  const render::Shading shading(lights, nullptr);
  for (int k = 0; k <= 64; ++k) {
    const double share = shading.mirrored(k / 64.0);
    light.mirrored[k][0] = static_cast<float>(share);
    light.mirrored[k][1] = static_cast<float>(shading.mirrored(std::min(k + 1, 64) / 64.0) - share);
  }
}

PeerScene peer_scene(const scene::Scene& scene, const std::array<SlopePyramid, 3>& maps, int size) {
  PeerScene peer;
  peer.width = peer.height = size;
  const render::Pinhole camera = render::place_camera(scene, size, size);
  const mesh::TriangleMesh& mesh = scene.meshes[0];
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const vec3<float> p = mesh.positions[v];
    const vec3<float> relative = narrow(vec3<double>{p.x, p.y, p.z} - camera.eye);
    const vec3<float> n = mesh.normals[v];
    PeerVertex vertex{{relative.x, relative.y, relative.z}, {n.x, n.y, n.z}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      vertex.st[k][0] = mesh.uv_sets[k][v].x;
      vertex.st[k][1] = mesh.uv_sets[k][v].y;
    }
    peer.vertices.push_back(vertex);
  }
  for (const auto& triangle : mesh.triangles)
    peer.indices.insert(peer.indices.end(), triangle.begin(), triangle.end());
  // From pixels, y up, to Vulkan's square, y down; depth 1 - near / w.
  const mat4<double> pixels = camera.screen_from_relative(size, size);
  const vec4<double> w = pixels.w;
  const vec4<double> rows[4]{(2.0 / size) * pixels.x + -1.0 * w, -2.0 / size * pixels.y + w,
                             w + vec4<double>{0, 0, 0, -camera.near}, w};
  for (std::size_t r = 0; r < 4; ++r) {
    const double row[4]{rows[r].x, rows[r].y, rows[r].z, rows[r].w};
    for (std::size_t c = 0; c < 4; ++c) peer.clip_from_relative[4 * c + r] = static_cast<float>(row[c]);
  }
  for (std::size_t k = 0; k < 3; ++k) peer.maps[k] = &maps[k];
  const vec3<float> sun = narrow(normalize_or_zero(scene.lights.sun->direction));
  peer.light = {{sun.x, sun.y, sun.z, static_cast<float>(scene.lights.sun->strength)}, {}};
  fill_mirrored(peer.light, scene.lights);
  return peer;
}

/// Both pictures side by side in figures, theirs and ours in files.
void compare(const render::Picture& ours, const std::vector<std::uint8_t>& theirs) {
  image::Image peer = image::make_image(ours.image.width, ours.image.height, 3);
  double sum = 0;
  std::size_t covered = 0;
  std::size_t far = 0;
  for (int y = 0; y < peer.height; ++y)
    for (int x = 0; x < peer.width; ++x) {
      const std::size_t pixel =
          std::size_t{4} * (static_cast<std::size_t>(peer.height - 1 - y) * peer.width + x);
      double worst = 0;
      for (int c = 0; c < 3; ++c) {
        peer.at(x, y, c) = static_cast<float>(theirs[pixel + static_cast<std::size_t>(c)]) / 255;
        worst = std::max(worst, std::abs(double(peer.at(x, y, c)) - ours.image.at(x, y, c)));
      }
      if (theirs[pixel + 3] == 0) continue;
      ++covered;
      sum += worst;
      far += worst > 8.0 / 255;
    }
  io::write_image("race_render_surfgrad.png", ours.image, image::Depth::unorm8);
  io::write_image("race_render_lavapipe.png", peer, image::Depth::unorm8);
  const double count = static_cast<double>(covered);
  report_note(
      "render",
      fmt::format("pictures: {} pixels covered by surfgrad, {} by lavapipe; the worst channel differs by "
                  "{:.2f} of 255 on average, by more than 8 in {:.2f} % of the pixels",
                  ours.covered, covered, 255 * sum / count, 100 * static_cast<double>(far) / count));
}
#endif

struct Sizes {
  int picture;
  int setup = 16;
};

Contestant surfgrad_contestant(const scene::Scene& scene, Sizes sizes, int threads) {
  // Lavapipe draws into a picture that is there already; so do we, after the turn that is not recorded.
  const auto picture = [&scene, threads](int size) {
    const auto image =
        std::make_shared<image::Image>(image::make_image(size, size, 3, image::Depth::float32));
    return [&scene, threads, size, image] {
      return timed([&] {
        limited_to(threads, [&] {
          (void)render::render_bands(scene, {.width = size, .height = size, .samples = 1}, stage::into(*image));
        });
      });
    };
  };
  return {"surfgrad", [setup = picture(sizes.setup), all = picture(sizes.picture)] {
            const Time once = setup();
            const Time time = all();
            return Time{time.cpu - once.cpu, time.wall - once.wall};
          }};
}

void race(const Request& request, int threads) {
  const Sizes sizes{request.quick ? 512 : 2048};
  const scene::Scene scene = make_scene();
  const render::Picture picture =
      render::render(scene, {.width = sizes.picture, .height = sizes.picture, .samples = 1});
  const Heat heat{"render",        fmt::format("{0}x{0}, 3 derived bases, GGX", sizes.picture),
                  "covered pixel", static_cast<double>(picture.covered),
                  threads,         request.rounds};
  std::vector<Contestant> contestants{surfgrad_contestant(scene, sizes, threads)};
#if SURFGRAD_BENCH_LAVAPIPE
  const std::array<SlopePyramid, 3> maps{make_slope_pyramid(*scene.images.at(map_names[0])),
                                         make_slope_pyramid(*scene.images.at(map_names[1])),
                                         make_slope_pyramid(*scene.images.at(map_names[2]))};
  std::vector<std::unique_ptr<Lavapipe>> peers;
  try {
    const PeerScene peer = peer_scene(scene, maps, sizes.picture);
    for (const PeerTexels texels : {PeerTexels::float32, PeerTexels::float16})
      peers.push_back(std::make_unique<Lavapipe>(peer, texels, threads));
  } catch (const NoLavapipe& reason) {
    peers.clear();
    report_absent("render", "lavapipe", reason.what());
  }
  const int frames = request.quick ? 3 : 2;
  const auto draw = [frames](Lavapipe& peer) {
    const Time time = timed([&] {
      for (int k = 0; k < frames; ++k) peer.draw();
    });
    return Time{time.cpu / frames, time.wall / frames};
  };
  if (!peers.empty()) {
    peers[0]->draw();
    if (threads == request.threads[0]) {
      report_note("render", peers[0]->driver());
      compare(picture, peers[0]->picture());
    }
    contestants.push_back({"lavapipe, 32-bit texels", [&] { return draw(*peers[0]); }});
    contestants.push_back({"lavapipe, 16-bit texels", [&] { return draw(*peers[1]); }});
  }
#else
  report_absent("render", "lavapipe", "Vulkan or glslangValidator not found when the races were built");
#endif
  const std::vector<Result> results = run(heat, contestants);
  for (std::size_t k = 1; k < results.size(); ++k) {
    const double factor = times_faster(results[k], results[0]);
    const std::string what = "surfgrad over " + results[k].name + ", pixels per core-second";
    report_ratio(heat, what, factor, {2});
  }
}

} // namespace
} // namespace surfgrad::bench

int main(int argc, char** argv) {
  const surfgrad::bench::Request request = surfgrad::bench::parse_request(argc, argv);
  for (const int threads : request.threads) surfgrad::bench::race(request, threads);
}
