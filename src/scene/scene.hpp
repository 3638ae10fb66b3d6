#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "mesh/triangle_mesh.hpp"
#include "stack/stack.hpp"

#include <surfgrad/vec.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace surfgrad::scene {

/// What a surface is bumped with.
struct Material {
  std::string name{};
  stack::BackFaces back_faces = stack::BackFaces::flip;
  std::vector<stack::Layer> layers{}; ///< file names resolved: keys of Scene::images
};

/// A mesh placed in the world.
struct Object {
  std::string name{};
  std::size_t mesh = 0;
  mat4<double> world_from_object{};
};

/// A stack with all it names, loaded. Every index is in range, every image a layer names is there,
/// every mesh has the UV sets that its materials' layers read, and that a displacement's map reads.
struct Scene {
  std::filesystem::path source{}; ///< document or model it came from, for messages; empty: the demo
  std::filesystem::path model{};  ///< file that the meshes came from; empty: the demo's
  std::vector<mesh::TriangleMesh> meshes{};
  std::vector<Object> objects{};
  std::vector<Material> materials{}; ///< what TriangleMesh::material_of_triangle indexes
  std::map<std::filesystem::path, std::shared_ptr<const image::Image>> images{};
  std::optional<stack::Displace> displace{}; ///< still to be done: `meshes` stand as modelled
  stack::Camera camera{};
  stack::Lights lights{};
  std::shared_ptr<const image::Image> environment{}; ///< null: the built-in sky

  /// The image of a file that a layer names.
  [[nodiscard]] const image::Image& image(const std::filesystem::path& file) const {
    return *images.at(file);
  }
};

/// Loads a stack document (.json) with all it names, or a model (.gltf, .glb, .obj) as the stack of
/// its own normal textures. Files named in a document are relative to its folder, and several are decoded
/// at a time. Progress is asked between them, with the fraction 0, perhaps by another thread.
///
/// Throws InputError for whatever is wrong with any of the files, naming it and the place: of several the
/// one that the document names first, materials in the order of their names. Cancelled where the progress
/// callback asks to stop.
[[nodiscard]] Scene load_scene(const std::filesystem::path& file, const Report& report = {});

/// The built-in scene: a torus with two UV sets under a stack of five layers in two passes. Needs no
/// file.
[[nodiscard]] Scene demo_scene();

} // namespace surfgrad::scene
