#include "bake/bake.hpp"

#include "bake/tangent_space.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "engine/rows.hpp"
#include "raster/visibility.hpp"
#include "stage/stage.hpp"

#include <algorithm>
#include <mutex>

namespace surfgrad::bake {
namespace {

/// Triangles that lie, wholly or in part, where the map does not reach.
std::int64_t triangles_outside(const std::vector<raster::Surface>& surfaces, std::size_t slot) {
  std::int64_t count = 0;
  for (const raster::Surface& surface : surfaces)
    for (const auto& triangle : surface.mesh->triangles)
      count += std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
        const vec2<double> st = surface.slots[slot].st[vertex];
        return st.x < 0 || st.x > 1 || st.y < 0 || st.y > 1;
      });
  return count;
}

/// Of one row: rows run in parallel and must not share a counter for every texel.
struct Counts {
  std::int64_t covered = 0, singular = 0, clamped = 0, degenerate = 0;
};

/// Composed normal of the texel (x, y) in the space asked for.
vec3<double> texel_normal(const stage::Stage& stage, const scene::Scene& scene, std::size_t slot,
                          const raster::Visible& what, const Options& options, int x, int y, Counts& counts) {
  const raster::Surface& surface = stage.surfaces()[what.surface];
  const raster::TrianglePlanes planes =
      raster::uv_planes(surface, slot, what.triangle, options.width, options.height);
  raster::Fragment<double> fragment = raster::make_fragment(surface, what.triangle, planes, x + 0.5, y + 0.5);
  fragment.front_facing = true; // winding in a texture says mirrored, not turned away
  const engine::Composition<double> c = stage.compose(what, fragment);
  ++counts.covered;
  counts.degenerate += c.degenerate;
  if (options.space == Space::world) return c.normal;
  if (options.space == Space::object) {
    // The transpose of M takes normals back: it is the inverse of the inverse transpose.
    const mat3<double> linear = raster::linear_part(scene.objects[what.surface].world_from_object);
    const vec3<double> n = normalize_or_zero(transpose(linear) * c.normal);
    if (max_abs(n) > 0 || max_abs(c.normal) == 0) return n;
    ++counts.singular;
    return {0, 0, 1};
  }
  const raster::UvFragment<double>& uv = fragment.uvs[slot];
  // What decodes the map interpolates the same normals: where they cancel it has no frame.
  const vec3<double> normal = fragment.normal_is_absent ? vec3<double>{0, 0, 0} : fragment.normal;
  const TangentNormal t = in_vertex_frame(normal, uv.tangent, uv.sign, c.normal);
  counts.singular += t.singular;
  counts.clamped += t.clamped;
  return t.normal;
}

} // namespace

Baked bake(const scene::Scene& asked, const Options& options, const Report& report) {
  const auto displaced = displace::displaced(asked, report.at_the_start());
  const scene::Scene& scene = displaced ? displaced->scene : asked;
  const stage::Stage stage(scene, {}, {{0, options.space == Space::tangent}}, report);
  const std::size_t slot = stage.slot_of(0);
  Baked baked;
  baked.outside = triangles_outside(stage.surfaces(), slot);
  const raster::VisibilityBuffer layout =
      raster::lay_out_in_uv(stage.surfaces(), slot, options.width, options.height, &baked.overlapping);
  baked.map = image::make_image(options.width, options.height, 3, image::Depth::unorm16);
  std::mutex adding;
  engine::for_each_row(options.height, report, [&](int y) {
    Counts counts;
    for (int x = 0; x < options.width; ++x) {
      const raster::Visible& what = layout.at(x, y);
      const vec3<double> n = what.surface == raster::Visible::none
                                 ? vec3<double>{0, 0, 1}
                                 : texel_normal(stage, scene, slot, what, options, x, y, counts);
      baked.map.at(x, y, 0) = static_cast<float>(0.5 * n.x + 0.5);
      baked.map.at(x, y, 1) = static_cast<float>(0.5 * n.y + 0.5);
      baked.map.at(x, y, 2) = static_cast<float>(0.5 * n.z + 0.5);
    }
    const std::lock_guard<std::mutex> lock(adding);
    baked.covered += counts.covered;
    baked.singular += counts.singular;
    baked.clamped += counts.clamped;
    baked.degenerate += counts.degenerate;
  });
  if (baked.covered == 0)
    throw InputError({.file = scene.source,
                      .problem = "no triangle covers a texel of the unit square of UV set 0",
                      .remedy = "check the mesh's texture coordinates, or bake at a larger size"});
  return baked;
}

} // namespace surfgrad::bake
