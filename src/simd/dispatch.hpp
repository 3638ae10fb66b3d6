#pragma once

/// Calls to sources that are compiled once for each instruction set (surfgrad_for_each_isa in CMake).
///
///   SURFGRAD_DECLARE_FOR_EACH_ISA(void, shade, (const Work&));
///   const auto shade = SURFGRAD_FUNCTION_OF_ISA(simd::current_isa(), shade);
///
/// The reference is no kernel of its own: what runs it asks for it first; here it is the one-lane float.

#include "simd/isa.hpp"

#include <hwy/detect_targets.h>

// clang-format off
#define SURFGRAD_DECLARE_IN(isa, result, name, parameters) namespace isa { result name parameters; }
#define SURFGRAD_CASE_OF(isa, name) case ::surfgrad::simd::Isa::isa: return &isa::name;

#if HWY_ARCH_X86 && !defined(SURFGRAD_NO_VECTOR_ISAS)
#define SURFGRAD_DECLARE_IN_VECTORS(result, name, parameters) \
  SURFGRAD_DECLARE_IN(sse4, result, name, parameters)         \
  SURFGRAD_DECLARE_IN(avx2, result, name, parameters)         \
  SURFGRAD_DECLARE_IN(avx512, result, name, parameters)
#define SURFGRAD_CASES_OF_VECTORS(name) \
  SURFGRAD_CASE_OF(sse4, name) SURFGRAD_CASE_OF(avx2, name) SURFGRAD_CASE_OF(avx512, name)
#elif HWY_ARCH_ARM_A64 && !defined(SURFGRAD_NO_VECTOR_ISAS)
#define SURFGRAD_DECLARE_IN_VECTORS(result, name, parameters) SURFGRAD_DECLARE_IN(neon, result, name, parameters)
#define SURFGRAD_CASES_OF_VECTORS(name) SURFGRAD_CASE_OF(neon, name)
#else
#define SURFGRAD_DECLARE_IN_VECTORS(result, name, parameters)
#define SURFGRAD_CASES_OF_VECTORS(name)
#endif

#define SURFGRAD_DECLARE_FOR_EACH_ISA(result, name, parameters) \
  SURFGRAD_DECLARE_IN(one_lane, result, name, parameters)       \
  SURFGRAD_DECLARE_IN(lanes, result, name, parameters)          \
  SURFGRAD_DECLARE_IN_VECTORS(result, name, parameters)

#define SURFGRAD_FUNCTION_OF_ISA(isa, name)      \
  [](::surfgrad::simd::Isa which) {              \
    switch (which) {                             \
      SURFGRAD_CASE_OF(lanes, name)              \
      SURFGRAD_CASES_OF_VECTORS(name)            \
    default:                                     \
      return &one_lane::name;                    \
    }                                            \
  }(isa)
// clang-format on
