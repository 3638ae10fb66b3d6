#pragma once

/// Scenes put together in memory.

#include "scene/scene.hpp"
#include "support/meshes.hpp"

#include <memory>
#include <utility>

namespace surfgrad::test {

inline void add_image(scene::Scene& scene, const char* name, image::Image image) {
  scene.images[name] = std::make_shared<image::Image>(std::move(image));
}

/// One object of one material without layers.
inline scene::Scene scene_of(mesh::TriangleMesh mesh, const mat3<double>& linear = scaling({1, 1, 1}),
                             vec3<double> move = {0, 0, 0}) {
  scene::Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.objects.push_back({"object", 0, affine(linear, move)});
  scene.materials.push_back({"test", stack::BackFaces::flip, {}});
  return scene;
}

/// A normal map layer of an image of the scene.
inline stack::NormalMapLayer normal_layer(const char* image) {
  stack::NormalMapLayer layer;
  layer.common.key = "layers";
  layer.map.file.path = image;
  return layer;
}

} // namespace surfgrad::test
