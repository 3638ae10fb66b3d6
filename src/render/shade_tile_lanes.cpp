// Compiled once for each instruction set.

#include "render/shade_tile.hpp"

#include "render/display.hpp"
#include "simd/object_scalar.hpp"

namespace surfgrad::render::SURFGRAD_ISA_NAMESPACE {
namespace {

using T = simd::ObjectScalar;

vec3<T> at(const vec3<float*>& array, int i) {
  return {load<T>(array.x + i), load<T>(array.y + i), load<T>(array.z + i)};
}

} // namespace

void shade_pixels(const Shading& shading, const engine::TileWork::Results& composed, int count,
                  vec3<float*> radiance) {
  for (int i = 0; i < count; i += lane_count<T>) {
    const vec3<T> light =
        shade(shading, at(composed.normal, i), at(composed.to_viewer, i), load<T>(composed.sunlight + i));
    store(light.x, radiance.x + i);
    store(light.y, radiance.y + i);
    store(light.z, radiance.z + i);
  }
}

void to_display(float* values, int count) {
  for (int i = 0; i < count; i += lane_count<T>) store(display_value(load<T>(values + i)), values + i);
}

} // namespace surfgrad::render::SURFGRAD_ISA_NAMESPACE
