#include "bake/encode.hpp"

#include "simd/dispatch.hpp"

namespace surfgrad::bake {

SURFGRAD_DECLARE_FOR_EACH_ISA(void, encode_pixels, (const EncodeWork& work))

void encode_pixels(const EncodeWork& work) {
  SURFGRAD_FUNCTION_OF_ISA(simd::current_isa(), encode_pixels)(work);
}

} // namespace surfgrad::bake
