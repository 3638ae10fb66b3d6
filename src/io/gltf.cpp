#include "io/gltf.hpp"

#include "io/gltf_document.hpp"
#include "io/gltf_material.hpp"
#include "io/gltf_primitive.hpp"
#include "io/gltf_scene.hpp"
#include "io/model_file.hpp"

#include <cstdint>
#include <optional>

namespace surfgrad::io {

Model read_gltf(const std::filesystem::path& file, std::span<const std::byte> bytes,
                const ModelOptions& options) {
  const gltf::Document document = gltf::read_document(file, bytes);
  Model model;
  model.materials = gltf::read_materials(document, options.report);
  gltf::Shown shown = gltf::shown_by(document, options.morph_weights);
  std::optional<std::size_t> default_material;
  for (const gltf::ShownMesh& mesh : shown.meshes) {
    const tinygltf::Primitive& primitive = gltf::primitive_of(document, mesh.place);
    if (primitive.material < 0 && !default_material) {
      default_material = model.materials.size();
      model.materials.push_back({.name = "default"});
    }
    const std::size_t material =
        primitive.material < 0 ? *default_material : static_cast<std::size_t>(primitive.material);
    const auto& normal = model.materials[material].normal;
    model.meshes.push_back(
        gltf::read_primitive(document, primitive, mesh.place.text(), static_cast<std::uint32_t>(material),
                             static_cast<std::size_t>(normal ? normal->uv_set : 0), mesh.weights));
  }
  for (gltf::ShownObject& object : shown.objects)
    model.objects.push_back({std::move(object.name), object.mesh, object.world_from_object});
  return model;
}

} // namespace surfgrad::io
