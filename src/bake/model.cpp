#include "bake/model.hpp"

#include "displace/scene.hpp"
#include "io/model_bake.hpp"

#include <utility>

namespace surfgrad::bake {

std::vector<std::byte> encode_model_with_maps(const scene::Scene& asked, ModelMaps maps,
                                              const Report& report) {
  // The bake has given its warnings.
  auto displaced = displace::displaced(asked, {report.at_the_start().progress, {}});
  const scene::Scene& scene = displaced ? displaced->scene : asked;
  io::BakedModel baked{.file = scene.model,
                       .morph_weights = scene.morph_weights,
                       .is_displaced = displaced.has_value(),
                       .normal_png = std::move(maps.normal_png),
                       .roughness = maps.roughness,
                       .uv_set = static_cast<std::size_t>(maps.uv_set),
                       .is_repeated = maps.is_repeated};
  baked.model.meshes = displaced ? std::move(displaced->scene.meshes) : asked.meshes;
  for (const scene::Object& object : scene.objects)
    baked.model.objects.push_back({object.name, object.mesh, object.world_from_object});
  for (const scene::Material& material : scene.materials) {
    baked.model.materials.push_back(
        {.name = material.name, .double_sided = material.back_faces != stack::BackFaces::cull});
    baked.is_bumped.push_back(!material.layers.empty());
  }
  return io::encode_baked_model(std::move(baked), report);
}

} // namespace surfgrad::bake
