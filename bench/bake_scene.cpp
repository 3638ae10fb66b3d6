#include "bake_scene.hpp"

#include "scene/demo_maps.hpp"

namespace surfgrad::bench {

scene::Scene bake_scene(int map_size) {
  scene::Scene scene = scene::demo_scene();
  scene.images.clear();
  scene.images[first_map] = std::make_shared<image::Image>(scene::plates_normal_map(map_size));
  scene.images[second_map] = std::make_shared<image::Image>(scene::weave_normal_map(map_size));
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
