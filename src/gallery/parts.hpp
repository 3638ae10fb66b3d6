#pragma once

#include "gallery/maps.hpp"
#include "mesh/triangle_mesh.hpp"
#include "scene/scene.hpp"

#include <surfgrad/vec.hpp>

#include <string>
#include <utility>

namespace surfgrad::gallery {

[[nodiscard]] inline mat4<double> affine(const mat3<double>& m, vec3<double> move = {0, 0, 0}) {
  return {{m.x.x, m.x.y, m.x.z, move.x},
          {m.y.x, m.y.y, m.y.z, move.y},
          {m.z.x, m.z.y, m.z.z, move.z},
          {0, 0, 0, 1}};
}

[[nodiscard]] inline mat3<double> scaling(vec3<double> s) { return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}; }

/// One object where the mesh stands, of one material without layers.
[[nodiscard]] inline scene::Scene scene_of(mesh::TriangleMesh mesh) {
  scene::Scene scene;
  scene.meshes.push_back(std::move(mesh));
  scene.objects.push_back({"object", 0, affine(scaling({1, 1, 1}))});
  scene.materials.push_back({"gallery", stack::BackFaces::flip, {}});
  return scene;
}

inline void look_from(scene::Scene& scene, double yaw_deg, double pitch_deg, double zoom = 1) {
  scene.camera.yaw_deg = yaw_deg;
  scene.camera.pitch_deg = pitch_deg;
  scene.camera.zoom = zoom;
}

/// A sun from the side: what is raised casts light and shade apart.
inline void light_from(scene::Scene& scene, vec3<double> direction, double strength = 3) {
  scene.lights.sun = stack::Sun{direction, strength};
}

/// How a normal map lies.
struct Laid {
  int uv = 0;
  vec2<double> tile{1, 1};
  stack::Basis basis = stack::Basis::mikktspace;
};

/// A normal map layer of a built-in map, which the scene is given.
[[nodiscard]] inline stack::NormalMapLayer normal_map(scene::Scene& scene, Maps& maps,
                                                      const std::string& name, const Laid& laid = {},
                                                      double scale = 1) {
  stack::NormalMapLayer layer;
  layer.common.key = name;
  layer.common.scale = scale;
  layer.map.file = maps.in(scene, name);
  layer.map.uv = laid.uv;
  layer.map.tile = laid.tile;
  layer.basis = laid.basis;
  return layer;
}

} // namespace surfgrad::gallery
