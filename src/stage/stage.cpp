#include "stage/stage.hpp"

#include "diagnostic/error.hpp"
#include "mesh/tangent_signs.hpp"
#include "stack/uses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

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

/// The job's own texture coordinates must be there; those of layers were checked with the scene.
void require_uv_sets(const scene::Scene& scene, const std::vector<raster::UvSlot>& needed) {
  for (const raster::UvSlot& slot : needed)
    for (const scene::Object& object : scene.objects)
      if (static_cast<std::size_t>(slot.uv_set) >= scene.meshes[object.mesh].uv_sets.size())
        throw InputError({.file = scene.source,
                          .place = "mesh \"" + object.name + "\"",
                          .problem = fmt::format("has no texture coordinates (UV set {})", slot.uv_set),
                          .remedy = "unwrap it first"});
}

void warn_about_tangents(const scene::Scene& scene, const std::vector<raster::UvSlot>& slots,
                         const Report& report) {
  for (const scene::Object& object : scene.objects)
    for (const raster::UvSlot& slot : slots) {
      const mesh::TriangleMesh& mesh = scene.meshes[object.mesh];
      const auto set = static_cast<std::size_t>(slot.uv_set);
      if (!slot.tangents || !mesh::has_tangents(mesh, set)) continue;
      const std::size_t count = mesh::contradicting_triangles(mesh, set);
      if (count > 0)
        report.warn(
            fmt::format("mesh \"{}\": the given tangents of {} of {} triangles contradict the texture "
                        "coordinates: relief is inverted along one axis there (basis \"derived\" is not)",
                        object.name, count, mesh.triangles.size()));
    }
}

/// The images that layers name, each until the last of those layers is done with it. Maps take more room than
/// the images that they are made of: with all of both a job would need half as much again.
class Images {
 public:
  using ByName = std::map<std::filesystem::path, std::shared_ptr<const image::Image>>;

  Images(ByName images, const std::vector<scene::Material>& materials) {
    for (const scene::Material& material : materials)
      for (const stack::Layer& layer : material.layers)
        for (const stack::FileName* name : stack::files_of(layer)) {
          Entry& entry = entries_[name->path];
          entry.image = images.at(name->path);
          ++entry.uses;
        }
  }

  [[nodiscard]] const image::Image& find(const std::filesystem::path& file) const {
    return *entries_.at(file).image;
  }
  /// The image if nobody reads it after the layer that does now. It is const only to those who share it: none
  /// is made as a constant.
  [[nodiscard]] image::Image* expendable(const std::filesystem::path& file) const {
    const Entry& entry = entries_.at(file);
    const bool ours_alone = entry.uses == 1 && entry.image.use_count() == 1;
    return ours_alone ? std::const_pointer_cast<image::Image>(entry.image).get() : nullptr;
  }
  void no_more_for(const stack::Layer& layer) {
    for (const stack::FileName* name : stack::files_of(layer))
      if (--entries_.at(name->path).uses == 0) entries_.erase(name->path);
  }

 private:
  struct Entry {
    std::shared_ptr<const image::Image> image{};
    int uses = 0; ///< by layers
  };
  std::map<std::filesystem::path, Entry> entries_{};
};

} // namespace

Stage::Stage(scene::Scene scene, const View& view, const std::vector<raster::UvSlot>& needed,
             const Report& report, const Backend* backend)
    : scene_(std::move(scene)), slots_(needed) {
  require_uv_sets(scene_, needed);
  for (const scene::Material& material : scene_.materials) engine::collect_uv_slots(material.layers, slots_);
  Images images(std::exchange(scene_.images, {}), scene_.materials);
  engine::MapLibrary maps(
      [&](const std::filesystem::path& file) -> const image::Image& { return images.find(file); },
      scene_.source, [&](const std::filesystem::path& file) { return images.expendable(file); });
  for (const scene::Material& material : scene_.materials)
    programs_.push_back(engine::compile(material.layers, slots_, maps,
                                        [&](const stack::Layer& layer) { images.no_more_for(layer); }));
  for (const auto& odd : maps.inward_texels())
    report.warn(fmt::format(
        "{}: {} of {} texels point into the surface (z <= 0); they are read as if z were positive",
        odd.file.string(), odd.count, odd.of));
  warn_about_tangents(scene_, slots_, report);
  for (const scene::Object& object : scene_.objects) {
    surfaces_.push_back(
        raster::place_mesh(scene_.meshes[object.mesh], object.world_from_object, view.origin, slots_));
    placements_.push_back(engine::place(object.world_from_object, view.origin));
    placements_.back().relative_from_screen = view.relative_from_screen;
    placements_.back().to_sun = view.to_sun;
  }
  if (backend != nullptr) composer_ = backend->prepare(scene_, slots_, surfaces_, maps);
}

std::size_t Stage::slot_of(int uv_set) const {
  const auto found = std::find_if(slots_.begin(), slots_.end(),
                                  [&](const raster::UvSlot& slot) { return slot.uv_set == uv_set; });
  return static_cast<std::size_t>(found - slots_.begin());
}

std::uint32_t Stage::material_of(const raster::TriangleId& id) const {
  return surfaces_[id.surface].mesh->material_of_triangle[id.triangle];
}

bool Stage::culled(const raster::TriangleId& id, bool front_facing) const {
  return !front_facing && scene_.materials[material_of(id)].back_faces == stack::BackFaces::cull;
}

engine::TileWork Stage::work_of(const raster::TriangleId& id) const {
  const std::uint32_t material = material_of(id);
  const raster::Surface& surface = surfaces_[id.surface];
  engine::TileWork work;
  work.program = &programs_[material];
  work.placement = &placements_[id.surface];
  work.back_faces = back_faces_of(scene_.materials[material].back_faces);
  work.surface = &surface;
  work.wanted.object_position = work.program->reads_object_position();
  work.wanted.normal_derivatives = work.program->reads_normal_derivatives();
  work.wanted.slots = static_cast<int>(surface.slots.size());
  for (std::size_t s = 0; s < surface.slots.size(); ++s) {
    work.wanted.present[s] = surface.slots[s].present;
    work.wanted.tangents[s] = surface.slots[s].present && !surface.slots[s].tangents.empty();
  }
  return work;
}

void Stage::compose(const engine::TileWork& work, const raster::TriangleId& id) const {
  if (composer_)
    composer_->compose(work, material_of(id));
  else
    engine::compose_tile(work);
}

} // namespace surfgrad::stage
