#include "gpu/fragments.hpp"

#include "simd/dispatch.hpp"

namespace surfgrad::gpu {

SURFGRAD_DECLARE_FOR_EACH_ISA(void, write_fragments, (const FragmentWork& work))

void write_fragments(const FragmentWork& work) {
  SURFGRAD_FUNCTION_OF_ISA(simd::current_isa(), write_fragments)(work);
}

int floats_of(Attribute attribute) {
  switch (attribute) {
  case Attribute::front_facing:
  case Attribute::normal_is_absent:
    return 1;
  case Attribute::st:
  case Attribute::dst_dx:
  case Attribute::dst_dy:
  case Attribute::raster:
    return 2;
  case Attribute::tangent:
    return 4;
  default:
    return 3;
  }
}

} // namespace surfgrad::gpu
