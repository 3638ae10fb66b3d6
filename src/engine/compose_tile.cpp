#include "engine/reference.hpp"
#include "engine/tiles.hpp"
#include "simd/dispatch.hpp"

namespace surfgrad::engine {

SURFGRAD_DECLARE_FOR_EACH_ISA(void, compose_tile, (const TileWork& work))

void compose_tile(const TileWork& work) {
  const simd::Isa isa = simd::current_isa();
  if (isa == simd::Isa::reference)
    compose_tile_reference(work);
  else
    SURFGRAD_FUNCTION_OF_ISA(isa, compose_tile)(work);
}

} // namespace surfgrad::engine
