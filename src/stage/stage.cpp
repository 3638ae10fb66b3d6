#include "stage/stage.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace surfgrad::stage {
namespace {

BackFaces back_faces_of(stack::BackFaces mode) {
  switch (mode) {
  case stack::BackFaces::mirror:
    return BackFaces::mirror;
  case stack::BackFaces::flip:
    return BackFaces::flip;
  case stack::BackFaces::same:
  case stack::BackFaces::cull:
    break; // culled back faces never become fragments
  }
  return BackFaces::same;
}

} // namespace

mat3<double> linear_part(const mat4<double>& m) {
  return {{m.x.x, m.x.y, m.x.z}, {m.y.x, m.y.y, m.y.z}, {m.z.x, m.z.y, m.z.z}};
}

Stage::Stage(const scene::Scene& scene, vec3<double> origin, const std::vector<raster::UvSlot>& needed,
             const Report& report)
    : scene_(scene), slots_(needed) {
  for (const scene::Material& material : scene.materials) engine::collect_uv_slots(material.layers, slots_);
  engine::MapLibrary maps(
      [&](const std::filesystem::path& file) -> const image::Image& { return scene.image(file); });
  for (const scene::Material& material : scene.materials)
    programs_.push_back(engine::compile(material.layers, slots_, maps));
  for (const auto& odd : maps.inward_texels())
    report.warn(fmt::format(
        "{}: {} of {} texels point into the surface (z <= 0); they are read as if z were positive",
        odd.file.string(), odd.count, odd.of));
  for (const scene::Object& object : scene.objects) {
    surfaces_.push_back(
        raster::place_mesh(scene.meshes[object.mesh], object.world_from_object, origin, slots_));
    world_from_object_.push_back(linear_part(object.world_from_object));
  }
}

std::size_t Stage::slot_of(int uv_set) const {
  const auto found = std::find_if(slots_.begin(), slots_.end(),
                                  [&](const raster::UvSlot& slot) { return slot.uv_set == uv_set; });
  return static_cast<std::size_t>(found - slots_.begin());
}

std::uint32_t Stage::material_of(std::uint32_t surface, std::uint32_t triangle) const {
  return surfaces_[surface].mesh->material_of_triangle[triangle];
}

bool Stage::culled(std::uint32_t surface, std::uint32_t triangle, bool front_facing) const {
  return !front_facing &&
         scene_.materials[material_of(surface, triangle)].back_faces == stack::BackFaces::cull;
}

engine::Composition<double> Stage::compose(const raster::Visible& what,
                                           const raster::Fragment<double>& fragment) const {
  const std::uint32_t material = material_of(what.surface, what.triangle);
  return engine::compose_reference(programs_[material], fragment,
                                   back_faces_of(scene_.materials[material].back_faces),
                                   world_from_object_[what.surface]);
}

} // namespace surfgrad::stage
