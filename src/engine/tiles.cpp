// Compiled once for each instruction set.

#include "engine/tiles.hpp"

#include "engine/compose.hpp"
#include "simd/object_scalar.hpp"

namespace surfgrad::engine::SURFGRAD_ISA_NAMESPACE {
namespace {

using T = simd::ObjectScalar;

void put(T value, float* to, int i) {
  if (to != nullptr) store(value, to + i);
}

void put(vec2<T> v, vec2<float*> to, int i) {
  if (to.x == nullptr) return;
  store(v.x, to.x + i);
  store(v.y, to.y + i);
}

void put(vec3<T> v, vec3<float*> to, int i) {
  if (to.x == nullptr) return;
  store(v.x, to.x + i);
  store(v.y, to.y + i);
  store(v.z, to.z + i);
}

/// Composes one pack of pixels; results go to the i-th place on.
void compose_pack(const TileWork& work, const std::int32_t* which, const float* x, const float* y, int i) {
  const TileWork::Results& results = work.results;
  const T zero = T(0.0f);
  const T one = T(1.0f);
  raster::Fragment<T> fragment =
      raster::interpolate<T>(work.setups, which, work.wanted, {load<T>(x), load<T>(y)});
  Point<T> point(fragment, work.back_faces, *work.placement);
  const vec3<T> base = point.frame.normal;
  put(base, results.base_normal, i);
  put(fragment.to_viewer, results.to_viewer, i);
  put(select<T>(fragment.normal_is_absent, {zero, zero, zero}, fragment.normal), results.mesh_normal, i);
  const raster::UvFragment<T>& uv = fragment.uvs[results.slot];
  put(uv.tangent, results.tangent, i);
  put(uv.sign, results.sign, i);
  put(uv.st, results.st, i);
  mask_t<T> degenerate;
  const vec3<T> normal = run(*work.program, point, degenerate);
  put(normal, results.normal, i);
  if (results.surfgrad.x != nullptr)
    put(point.frame.resolve_sign * from_perturbed_normal(base, normal), results.surfgrad, i);
  put(point.sunlight, results.sunlight, i);
  put(select(degenerate, one, zero), results.degenerate, i);
}

} // namespace

void compose_tile(const TileWork& work) {
  constexpr int lanes = lane_count<T>;
  int i = 0;
  for (; i + lanes <= work.count; i += lanes) compose_pack(work, work.which + i, work.x + i, work.y + i, i);
  if (i == work.count) return;
  // Lanes beyond the last pixel repeat it.
  std::int32_t which[lanes];
  float x[lanes];
  float y[lanes];
  for (int k = 0; k < lanes; ++k) {
    const int from = i + k < work.count ? i + k : work.count - 1;
    which[k] = work.which[from];
    x[k] = work.x[from];
    y[k] = work.y[from];
  }
  compose_pack(work, which, x, y, i);
}

} // namespace surfgrad::engine::SURFGRAD_ISA_NAMESPACE
