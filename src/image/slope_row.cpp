#include "image/slope_row.hpp"

#include "simd/dispatch.hpp"

namespace surfgrad::image {

SURFGRAD_DECLARE_FOR_EACH_ISA(int, slope_row, (const SlopeRow& row))

int slope_row(const SlopeRow& row) { return SURFGRAD_FUNCTION_OF_ISA(simd::current_isa(), slope_row)(row); }

} // namespace surfgrad::image
