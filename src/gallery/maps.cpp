#include "gallery/maps.hpp"

#include "bake/bake.hpp"
#include "gallery/blending.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"
#include "gallery/periodic_noise.hpp"
#include "gallery/relief_maps.hpp"
#include "scene/demo_maps.hpp"
#include "scene/map_functions.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

namespace surfgrad::gallery {
namespace {

using image::Image;

constexpr int size = 512; // of every map: a picture's size, and quick to make

Image flat() {
  return scene::normal_map_of(size, [](double, double) { return 0.0; });
}

Image grain() {
  return scene::normal_map_of(size, [](double s, double t) {
    double sum = 0;
    double amplitude = 0.03;
    for (int cells = 8; cells <= 64; cells *= 2) {
      sum += amplitude * periodic_noise(s, t, cells);
      amplitude *= 0.6;
    }
    return sum;
  });
}

Image studs() {
  return scene::normal_map_of(size, [](double s, double t) {
    constexpr int rows = 4;
    const double u = 2 * scene::fraction(rows * s) - 1;
    const double v = 2 * scene::fraction(rows * t) - 1;
    const double r2 = u * u + v * v;
    // A paraboloid, 2.2 steep at its foot, that leaves the ground smoothly.
    const double dome = std::max(0.75 - r2, 0.0);
    return 1.3 / (2 * rows) * dome * dome / (dome + 0.06);
  });
}

Image ripples() {
  return scene::normal_map_of(size, [](double s, double t) {
    constexpr int waves = 16;
    return 0.35 / waves * (scene::arch(waves * (s + t)) - 0.5);
  });
}

template <class Height>
Image height_map_of(int texels, const Height& height) {
  Image map = image::make_image(texels, texels, 1, image::Depth::unorm16);
  for (int y = 0; y < texels; ++y)
    for (int x = 0; x < texels; ++x) {
      const double h = std::clamp(height((x + 0.5) / texels, (y + 0.5) / texels), 0.0, 1.0);
      map.at(x, y, 0) = static_cast<float>(std::floor(h * 65535 + 0.5) / 65535);
    }
  return map;
}

Image paving() {
  return height_map_of(size, [](double s, double t) {
    constexpr int courses = 4;
    constexpr int in_a_course = 3;
    const double row = std::floor(courses * t);
    const double along = in_a_course * s + (static_cast<int>(row) % 2 == 0 ? 0.0 : 0.5);
    const double stone = std::floor(along) - in_a_course * std::floor(std::floor(along) / in_a_course);
    // A product of two rounded ridges: a stone with broad shoulders in a joint.
    const auto ridge = [](double v) {
      const double u = 2 * scene::fraction(v) - 1;
      return 1 - u * u * u * u * u * u;
    };
    const double shape = ridge(along) * ridge(courses * t);
    // Heights of the stones, far enough apart to be told from each other: fifths in no order.
    const double worn = scene::fraction(0.4 * row + 0.6 * stone + 0.2 * row * stone);
    return (0.6 + 0.4 * worn) * shape;
  });
}

Image coarse_heights() {
  return height_map_of(16, [](double s, double t) {
    // Three bumps across, one of them higher, and a dip: slopes of every direction.
    return 0.5 * scene::arch(2 * s) * scene::arch(2 * t) + 0.5 * scene::arch(s + t);
  });
}

/// Object-space normals of a shape on the unwrap of the closed surfaces.
template <class Normal>
Image object_normals(const Normal& normal) {
  Image map = image::make_image(size, size, 3, image::Depth::unorm16);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec2<double> uv{(x + 0.5) / size, (y + 0.5) / size};
      scene::set_normal(map, x, y, normal(unwrapped_direction(uv)));
    }
  return map;
}

Image rock_object() {
  return object_normals([](vec3<double> d) { return rock_point(d, rock_all_octaves).normal; });
}

/// What `surfgrad bake` makes of the rock under its object-space normals, continued into the gutters
/// between the charts, where the filter may look.
Image rock(Maps& maps) {
  scene::Scene scene = scene_of(rock_mesh());
  stack::ObjectNormalMapLayer layer;
  layer.common.key = "rock";
  layer.map.file = maps.in(scene, "rock object");
  scene.materials[0].layers = {layer};
  const Image baked = bake::bake(scene, {.width = size, .height = size}).map;
  Image map = baked;
  constexpr double inset = 0.02; // more than a texel, so that the nearest one is covered
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec2<double> uv = nearest_in_chart({(x + 0.5) / size, (y + 0.5) / size}, inset);
      for (int channel = 0; channel < 3; ++channel)
        map.at(x, y, channel) =
            baked.at(static_cast<int>(uv.x * size), static_cast<int>(uv.y * size), channel);
    }
  return map;
}

template <vec3<double> (*blend)(vec3<double>, vec3<double>)>
Image blended(Maps& maps, const char* base, const char* detail) {
  return blended_map(*maps[base], *maps[detail], blend);
}

using Make = std::function<Image(Maps&)>;

const std::map<std::string, Make>& makers() {
  static const std::map<std::string, Make> table{
      {"flat", [](Maps&) { return flat(); }},
      {"plates", [](Maps&) { return scene::plates_normal_map(size); }},
      {"weave", [](Maps&) { return scene::weave_normal_map(size); }},
      {"stripes", [](Maps&) { return scene::stripes_mask(size); }},
      {"grain", [](Maps&) { return grain(); }},
      {"studs", [](Maps&) { return studs(); }},
      {"ripples", [](Maps&) { return ripples(); }},
      {"paving", [](Maps&) { return paving(); }},
      {"coarse heights", [](Maps&) { return coarse_heights(); }},
      {"letter", [](Maps&) { return letter_normals(size); }},
      {"letter cube", [](Maps&) { return letter_cube(size / 2); }},
      {"cobbles", [](Maps&) { return cobble_heights(size); }},
      {"crags", [](Maps&) { return crag_normals(size); }},
      {"rock", rock},
      {"rock object", [](Maps&) { return rock_object(); }},
      {"ledged rock", [](Maps&) { return object_normals(ledged_rock_normal); }},
      {"linear", [](Maps& m) { return blended<blend_linear>(m, "studs", "ripples"); }},
      {"udn", [](Maps& m) { return blended<blend_udn>(m, "studs", "ripples"); }},
      {"whiteout", [](Maps& m) { return blended<blend_whiteout>(m, "studs", "ripples"); }},
      {"reoriented", [](Maps& m) { return blended<blend_reoriented>(m, "studs", "ripples"); }},
      {"flat linear", [](Maps& m) { return blended<blend_linear>(m, "flat", "studs"); }},
      {"flat udn", [](Maps& m) { return blended<blend_udn>(m, "flat", "studs"); }},
      {"flat whiteout", [](Maps& m) { return blended<blend_whiteout>(m, "flat", "studs"); }},
      {"flat reoriented", [](Maps& m) { return blended<blend_reoriented>(m, "flat", "studs"); }}};
  return table;
}

} // namespace

std::shared_ptr<const image::Image> Maps::operator[](const std::string& name) {
  Entry* entry = nullptr;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    entry = &entries_[name]; // references into a map stay valid
  }
  std::call_once(entry->once, [&] {
    // Isolated: a thread that waits for part of this work must not take up another picture, which may
    // wait for this very map.
    tbb::this_task_arena::isolate(
        [&] { entry->image = std::make_shared<const Image>(makers().at(name)(*this)); });
  });
  return entry->image;
}

stack::FileName Maps::in(scene::Scene& scene, const std::string& name) {
  scene.images[name] = (*this)[name];
  return {.path = name};
}

} // namespace surfgrad::gallery
