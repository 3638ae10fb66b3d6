// Compiled once for each instruction set.

#include "bake/encode.hpp"
#include "bake/tangent_space.hpp"
#include "engine/point.hpp"
#include "simd/object_scalar.hpp"

namespace surfgrad::bake::SURFGRAD_ISA_NAMESPACE {
namespace {

using T = simd::ObjectScalar;

vec3<T> at(const vec3<float*>& array, int i) {
  return {load<T>(array.x + i), load<T>(array.y + i), load<T>(array.z + i)};
}

TangentNormal<T> in_space(const EncodeWork& work, int i) {
  const engine::TileWork::Results& composed = *work.composed;
  const vec3<T> normal = at(composed.normal, i);
  const T zero = T(0.0f);
  const mask_t<T> no = zero < zero;
  switch (work.space) {
  case Space::world:
    return {normal, no, no};
  case Space::object: {
    // The transpose of M takes normals back: it is the inverse of the inverse transpose.
    const vec3<T> n = normalize_or_zero(transpose(engine::in_lanes<T>(work.linear)) * normal);
    const mask_t<T> singular = (max_abs(n) == zero) & (zero < max_abs(normal));
    return {select<T>(singular, {zero, zero, T(1.0f)}, n), singular, no};
  }
  case Space::tangent:
    break;
  }
  return in_vertex_frame(at(composed.mesh_normal, i), at(composed.tangent, i), load<T>(composed.sign + i),
                         normal);
}

} // namespace

void encode_pixels(const EncodeWork& work) {
  const T zero = T(0.0f);
  const T one = T(1.0f);
  for (int i = work.first; i < work.end; i += lane_count<T>) {
    const TangentNormal<T> n = in_space(work, i);
    store(n.normal.x, work.normal.x + i);
    store(n.normal.y, work.normal.y + i);
    store(n.normal.z, work.normal.z + i);
    store(select(n.singular, one, zero), work.singular + i);
    store(select(n.clamped, one, zero), work.clamped + i);
  }
}

} // namespace surfgrad::bake::SURFGRAD_ISA_NAMESPACE
