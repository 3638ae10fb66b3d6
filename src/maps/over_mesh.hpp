#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "maps/form.hpp"

#include <filesystem>

namespace surfgrad::maps {

/// A map of normals in another space, over a mesh: from tangent space into the object's or back.
struct OverMesh {
  std::filesystem::path model{}; ///< .glb, .gltf or .obj
  int uv_set = 0;
  bool to_object = false; ///< from tangent space; else into it
  stack::Green green_from = stack::Green::up;
  stack::Green green_to = stack::Green::up;
  image::Depth depth = image::Depth::unorm16;
  bool dither = false;
  int padding = 16;
};

/// Bakes the map over the model, in the map's size: as a layer `normal_map` or `object_normal_map` of all its
/// materials, in MikkTSpace.
///
/// file    that the map came from, for messages
/// errors  as scene::load_scene and bake::bake
[[nodiscard]] image::Image in_other_space(const image::Image& map, const OverMesh& job,
                                          const std::filesystem::path& file, const Report& report = {});

} // namespace surfgrad::maps
