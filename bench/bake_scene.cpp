#include "bake_scene.hpp"

#include "io/image_file.hpp"
#include "scene/demo_maps.hpp"

namespace surfgrad::bench {

namespace {

/// A picture as a file holds it.
std::shared_ptr<const image::Image> of_a_file(const image::Image& picture, image::Depth depth) {
  return std::make_shared<image::Image>(
      io::decode_image(io::encode_image(picture, depth, io::ImageFormat::tiff), "memory"));
}

} // namespace

scene::Scene bake_scene(int map_size, image::Depth depth) {
  scene::Scene scene = scene::demo_scene();
  scene.images.clear();
  scene.images[first_map] = of_a_file(scene::plates_normal_map(map_size), depth);
  scene.images[second_map] = of_a_file(scene::weave_normal_map(map_size), depth);
  stack::NormalMapLayer first;
  first.map.file.path = first_map;
  stack::NormalMapLayer second;
  second.map.file.path = second_map;
  second.map.uv = 1;
  stack::NoiseLayer noise;
  noise.noise.frequency = noise_frequency;
  noise.common.scale = noise_height;
  scene.materials[0].layers = {first, second, stack::ResolveLayer{}, noise};
  return scene;
}

} // namespace surfgrad::bench
