// Compiled once for each instruction set.

#include "engine/point.hpp"
#include "gpu/fragments.hpp"
#include "simd/object_scalar.hpp"

namespace surfgrad::gpu::SURFGRAD_ISA_NAMESPACE {
namespace {

using T = simd::ObjectScalar;

void put(T value, float* to) { store(value, to); }
void put(vec2<T> v, float* to, std::size_t stride) {
  store(v.x, to);
  store(v.y, to + stride);
}
void put(vec3<T> v, float* to, std::size_t stride) {
  store(v.x, to);
  store(v.y, to + stride);
  store(v.z, to + 2 * stride);
}

/// Where an array of results is wanted.
void put(T value, float* array, int i) {
  if (array != nullptr) store(value, array + i);
}
void put(vec2<T> v, vec2<float*> arrays, int i) {
  put(v.x, arrays.x, i);
  put(v.y, arrays.y, i);
}
void put(vec3<T> v, vec3<float*> arrays, int i) {
  put(v.x, arrays.x, i);
  put(v.y, arrays.y, i);
  put(v.z, arrays.z, i);
}

/// The surface's own position, which no displacement has moved, in the world.
vec3<T> world_position(const engine::Placement& placement, vec3<T> object_position) {
  const mat4<double>& m = placement.world_from_object;
  return engine::in_lanes<T>(placement.linear) * object_position +
         engine::in_lanes<T>(vec3<double>{m.x.w, m.y.w, m.z.w});
}

void put_attribute(const FragmentWork& work, const AttributeArray& array, const raster::Fragment<T>& f,
                   int i) {
  const T zero = T(0.0f);
  const T one = T(1.0f);
  float* const to = array.to + i;
  const std::size_t stride = work.stride;
  const raster::UvFragment<T>& uv = f.uvs[static_cast<std::size_t>(array.slot)];
  switch (array.attribute) {
  case Attribute::position:
    return put(f.position, to, stride);
  case Attribute::normal:
    return put(f.normal, to, stride);
  case Attribute::dp_dx:
    return put(f.dp_dx, to, stride);
  case Attribute::dp_dy:
    return put(f.dp_dy, to, stride);
  case Attribute::dn_dx:
    return put(f.dn_dx, to, stride);
  case Attribute::dn_dy:
    return put(f.dn_dy, to, stride);
  case Attribute::front_facing:
    return put(select(f.front_facing, one, zero), to);
  case Attribute::normal_is_absent:
    return put(select(f.normal_is_absent, one, zero), to);
  case Attribute::st:
    return put(uv.st, to, stride);
  case Attribute::dst_dx:
    return put(uv.dst_dx, to, stride);
  case Attribute::dst_dy:
    return put(uv.dst_dy, to, stride);
  case Attribute::tangent:
    put(uv.tangent, to, stride);
    return put(uv.sign, to + 3 * stride);
  case Attribute::object_position:
    return put(f.object_position, to, stride);
  case Attribute::world_position:
    return put(world_position(*work.tile->placement, f.object_position), to, stride);
  case Attribute::to_viewer:
    return put(f.to_viewer, to, stride);
  case Attribute::raster:
    return put(f.raster, to, stride);
  }
}

void write_pack(const FragmentWork& work, const std::int32_t* which, const float* x, const float* y, int i) {
  const engine::TileWork& tile = *work.tile;
  const T zero = T(0.0f);
  const T one = T(1.0f);
  const auto fragment = raster::interpolate<T>(tile.setups, which, work.wanted, {load<T>(x), load<T>(y)});
  for (int k = 0; k < work.array_count; ++k) put_attribute(work, work.arrays[k], fragment, i);
  if (work.resolve_sign != nullptr) {
    const T back = tile.back_faces == BackFaces::flip ? -one : one;
    put(select(fragment.front_facing, one, back), work.resolve_sign + i);
  }
  const engine::TileWork::Results& results = tile.results;
  const int at = work.first + i;
  put(fragment.to_viewer, results.to_viewer, at);
  put(select<T>(fragment.normal_is_absent, {zero, zero, zero}, fragment.normal), results.mesh_normal, at);
  const raster::UvFragment<T>& uv = fragment.uvs[results.slot];
  put(uv.tangent, results.tangent, at);
  put(uv.sign, results.sign, at);
  put(uv.st, results.st, at);
}

} // namespace

void write_fragments(const FragmentWork& work) {
  constexpr int lanes = lane_count<T>;
  const engine::TileWork& tile = *work.tile;
  int i = 0;
  for (; i + lanes <= work.count; i += lanes) {
    const int at = work.first + i;
    write_pack(work, tile.which + at, tile.x + at, tile.y + at, i);
  }
  if (i == work.count) return;
  // Lanes beyond the last pixel repeat it.
  std::int32_t which[lanes];
  float x[lanes];
  float y[lanes];
  for (int k = 0; k < lanes; ++k) {
    const int from = work.first + (i + k < work.count ? i + k : work.count - 1);
    which[k] = tile.which[from];
    x[k] = tile.x[from];
    y[k] = tile.y[from];
  }
  write_pack(work, which, x, y, i);
}

} // namespace surfgrad::gpu::SURFGRAD_ISA_NAMESPACE
