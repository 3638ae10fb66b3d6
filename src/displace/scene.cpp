#include "displace/scene.hpp"

#include "diagnostic/error.hpp"
#include "displace/displace.hpp"
#include "engine/compiler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfgrad::displace {
namespace {

void require_size(const scene::Scene& scene) {
  std::size_t before = 0;
  for (const mesh::TriangleMesh& mesh : scene.meshes) before += mesh.triangles.size();
  int fitting = 0;
  while (fitting < stack::Displace::most_levels && before << 2 * (fitting + 1) <= most_triangles) ++fitting;
  const int levels = scene.displace->subdivide;
  if (levels <= fitting) return;
  throw InputError({.file = scene.source,
                    .line = scene.displace->subdivide_line,
                    .place = "displace.subdivide",
                    .problem = fmt::format("is {}: the {} triangles would become {}", levels, before,
                                           before << 2 * levels),
                    .remedy = fmt::format("expected {} at most, for {} triangles", fitting, most_triangles)});
}

void require_finite(const scene::Scene& scene, const mesh::TriangleMesh& mesh) {
  const bool finite = std::ranges::all_of(mesh.positions, [](const vec3<float>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
  if (!finite)
    throw InputError({.file = scene.source,
                      .line = scene.displace->line,
                      .place = "displace",
                      .problem = "moves vertices beyond what numbers can hold",
                      .remedy = "expected a smaller \"height\", or a \"level\" nearer to the values"});
}

/// The part of the job's progress that falls to each mesh.
Report part_of(const Report& report, std::size_t mesh, std::size_t meshes) {
  if (!report.progress) return report;
  return {[&report, mesh, meshes](double fraction) {
            return report.progress((static_cast<double>(mesh) + fraction) / static_cast<double>(meshes));
          },
          report.warning};
}

std::optional<engine::TiledMap> map_of(const scene::Scene& scene) {
  if (!scene.displace->map) return std::nullopt;
  const stack::DisplacementMap& use = *scene.displace->map;
  engine::MapLibrary library(
      [&](const std::filesystem::path& file) -> const image::Image& { return scene.image(file); },
      scene.source);
  const std::vector<raster::UvSlot> no_slots;
  const engine::Compiler compiler(no_slots, library);
  return compiler.tiled(use, library.heights(use.file, use.channel));
}

} // namespace

std::optional<DisplacedScene> displaced(const scene::Scene& scene, const Report& report) {
  if (!scene.displace) return std::nullopt;
  require_size(scene);
  const std::optional<engine::TiledMap> map = map_of(scene);
  DisplacedScene result{.scene = scene,
                        .lowest = std::numeric_limits<double>::infinity(),
                        .highest = -std::numeric_limits<double>::infinity()};
  result.scene.displace.reset();
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    DisplacedMesh displaced = displace(scene.meshes[i], *scene.displace, map ? &*map : nullptr,
                                       part_of(report, i, scene.meshes.size()));
    require_finite(scene, displaced.mesh);
    result.vertices += displaced.mesh.positions.size();
    result.triangles += displaced.mesh.triangles.size();
    result.lowest = std::min(result.lowest, displaced.lowest);
    result.highest = std::max(result.highest, displaced.highest);
    result.joined_places += displaced.joined_places;
    result.parted_places += displaced.parted_places;
    result.scene.meshes[i] = std::move(displaced.mesh);
  }
  if (result.parted_places > 0)
    report.warn(fmt::format("displace: at {} places normals cancel, as on the two sides of a leaf without "
                            "thickness: each side moves along its own, and the mesh may open there",
                            result.parted_places));
  return result;
}

} // namespace surfgrad::displace
