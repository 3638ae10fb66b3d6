#include "engine/reference.hpp"

#include "engine/tiles.hpp"

namespace surfgrad::engine {
namespace {

void put(double value, float* to, int i) {
  if (to != nullptr) to[i] = static_cast<float>(value);
}

void put(vec2<double> v, vec2<float*> to, int i) {
  put(v.x, to.x, i);
  put(v.y, to.y, i);
}

void put(vec3<double> v, vec3<float*> to, int i) {
  put(v.x, to.x, i);
  put(v.y, to.y, i);
  put(v.z, to.z, i);
}

} // namespace

Composition<double> compose_reference(const Program& program, const raster::Fragment<double>& fragment,
                                      BackFaces back_faces, const Placement& placement) {
  return compose(program, fragment, back_faces, placement);
}

void compose_tile_reference(const TileWork& work) {
  const TileWork::Results& results = work.results;
  for (int i = 0; i < work.count; ++i) {
    const raster::TileScan::Shown& shown = work.shown[static_cast<std::size_t>(work.which[i])];
    const vec2<double> at = shown.nearest.value_or(vec2<double>{work.x[i], work.y[i]});
    raster::Fragment<double> fragment =
        raster::make_fragment(*work.surface, shown.id.triangle, shown.planes, at.x, at.y);
    if (!work.wanted.screen) fragment.front_facing = true; // winding in a texture says mirrored
    if (work.wanted.to_viewer) fragment.to_viewer = normalize_or_zero(-fragment.position);
    put(fragment.to_viewer, results.to_viewer, i);
    put(fragment.normal_is_absent ? vec3<double>{0, 0, 0} : fragment.normal, results.mesh_normal, i);
    const raster::UvFragment<double>& uv = fragment.uvs[results.slot];
    put(uv.tangent, results.tangent, i);
    put(uv.sign, results.sign, i);
    put(uv.st, results.st, i);
    const Composition<double> c =
        compose_reference(*work.program, fragment, work.back_faces, *work.placement);
    put(c.normal, results.normal, i);
    put(c.base_normal, results.base_normal, i);
    put(c.surfgrad, results.surfgrad, i);
    put(c.sunlight, results.sunlight, i);
    put(c.degenerate ? 1 : 0, results.degenerate, i);
  }
}

} // namespace surfgrad::engine
