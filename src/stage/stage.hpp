#pragma once

#include "diagnostic/report.hpp"
#include "engine/tiles.hpp"
#include "raster/tile_grid.hpp"
#include "scene/scene.hpp"
#include "stage/backend.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace surfgrad::stage {

/// Where the fragments of a picture come from and who looks at them. The default is a bake's: nobody.
struct View {
  vec3<double> origin{0, 0, 0}; ///< world position that fragments are relative to: the camera
  /// Takes (x, y, depth, 1) in pixels to positions relative to the origin, before the division by w.
  std::optional<mat4<double>> relative_from_screen{};
  vec3<double> to_sun{0, 0, 0}; ///< world space, unit; zero where no sun shines
};

/// A scene made ready for the engine: layers compiled, meshes placed in the world. What render and
/// bake have in common.
class Stage {
 public:
  /// needed   texture coordinates that the job reads besides those of the layers
  /// backend  composes in the engine's stead; null: the engine
  /// Warns about normal maps with texels that point into the surface. Images leave the scene as soon as the
  /// last map is made of them: of a scene that was moved here they are gone from memory. Throws InputError
  /// where a mesh lacks a needed UV set or the scene needs more of them than a fragment carries.
  Stage(scene::Scene scene, const View& view, const std::vector<raster::UvSlot>& needed, const Report& report,
        const Backend* backend = nullptr);

  Stage(const Stage&) = delete; // what is made ready points into the scene
  Stage& operator=(const Stage&) = delete;

  /// The scene without its images.
  [[nodiscard]] const scene::Scene& scene() const { return scene_; }
  /// One a scene object, in the same order.
  [[nodiscard]] const std::vector<raster::Surface>& surfaces() const { return surfaces_; }
  /// Where a UV set that the layers or the job asked for lies in Fragment::uvs.
  [[nodiscard]] std::size_t slot_of(int uv_set) const;

  [[nodiscard]] std::uint32_t material_of(const raster::TriangleId& id) const;
  /// Whether a triangle is left out on the side it shows.
  [[nodiscard]] bool culled(const raster::TriangleId& id, bool front_facing) const;
  /// How pixels of this triangle's surface and material are composed: all but the pixels.
  [[nodiscard]] engine::TileWork work_of(const raster::TriangleId& id) const;
  /// Composes pixels of this triangle's surface and material.
  void compose(const engine::TileWork& work, const raster::TriangleId& id) const;

 private:
  scene::Scene scene_; // without images
  std::vector<raster::UvSlot> slots_;
  std::vector<engine::Program> programs_; // one a material
  std::vector<raster::Surface> surfaces_;
  std::vector<engine::Placement> placements_; // one a surface
  std::unique_ptr<Composer> composer_;        // null: the engine
};

} // namespace surfgrad::stage
