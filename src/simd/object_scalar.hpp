#pragma once

/// The scalar of a source that is compiled once for each instruction set (surfgrad_for_each_isa in CMake).
/// Such a source defines its functions in a namespace SURFGRAD_ISA_NAMESPACE; simd/dispatch.hpp calls the
/// one of the instruction set in use.

#if SURFGRAD_ISA_IS_PLAIN
#include "simd/emulated_lanes.hpp"
namespace surfgrad::simd {
namespace one_lane {
using Float = float;
}
namespace lanes {
using Float = EmulatedFloat;
}
} // namespace surfgrad::simd
#else
#include "simd/pack.hpp"
#endif

namespace surfgrad::simd {
using ObjectScalar = SURFGRAD_ISA_NAMESPACE::Float;
}
