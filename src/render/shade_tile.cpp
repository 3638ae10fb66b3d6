#include "render/shade_tile.hpp"

#include "simd/dispatch.hpp"

namespace surfgrad::render {

SURFGRAD_DECLARE_FOR_EACH_ISA(void, shade_pixels,
                              (const Shading& shading, const engine::TileWork::Results& composed, int count,
                               vec3<float*> radiance))
SURFGRAD_DECLARE_FOR_EACH_ISA(void, to_display, (float* values, int count))

void shade_pixels(const Shading& shading, const engine::TileWork::Results& composed, int count,
                  vec3<float*> radiance) {
  SURFGRAD_FUNCTION_OF_ISA(simd::current_isa(), shade_pixels)(shading, composed, count, radiance);
}

void to_display(float* values, int count) {
  SURFGRAD_FUNCTION_OF_ISA(simd::current_isa(), to_display)(values, count);
}

} // namespace surfgrad::render
