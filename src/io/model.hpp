#pragma once

#include "image/image.hpp"
#include "image/sampler.hpp"
#include "mesh/triangle_mesh.hpp"

#include <surfgrad/vec.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace surfgrad::io {

/// A normal map as a model's material uses it, in our conventions: texture origin lower left, t up.
/// The map is read at st' = R(rotate_rad) * (tile * st) + offset, R turning counter-clockwise.
struct ModelTexture {
  /// The image file; for an image inside the model `model.glb:images[3]`. Equal names, equal images.
  std::filesystem::path name{};
  std::shared_ptr<const image::Image> image{}; ///< never null; shared between materials
  int uv_set = 0;                              ///< a mesh of this material may lack it
  double scale = 1.0;                          ///< factor of the x and y of every normal
  vec2<double> tile{1.0, 1.0};
  double rotate_rad = 0.0;
  vec2<double> offset{0.0, 0.0};
  image::Wrap wrap_s = image::Wrap::repeat;
  image::Wrap wrap_t = image::Wrap::repeat;
};

struct ModelMaterial {
  std::string name{}; ///< never empty: `material_3` where the file names none, `default` where it has none
  bool double_sided = false; ///< OBJ knows no sides: always true there
  std::optional<ModelTexture> normal{};
};

/// A mesh placed in the world. Meshes may be shared by several objects.
struct ModelObject {
  std::string name{};
  std::size_t mesh = 0;             ///< index into Model::meshes
  mat4<double> world_from_object{}; ///< finite; may be singular or mirror (negative determinant)
};

/// A model as loaded. Every index is in range; every position, normal, texture coordinate and tangent is
/// finite.
struct Model {
  std::vector<mesh::TriangleMesh>
      meshes{}; ///< at least one triangle each; material_of_triangle indexes `materials`
  std::vector<ModelObject> objects{};     ///< at least one
  std::vector<ModelMaterial> materials{}; ///< at least one
};

} // namespace surfgrad::io
