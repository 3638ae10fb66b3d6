#include "simd/isa.hpp"

#include "diagnostic/error.hpp"

#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <string>

namespace surfgrad::simd {
namespace {

struct Named {
  std::string_view name;
  Isa isa;
  std::int64_t target; ///< what the processor must have; 0 for plain C++
};

constexpr std::array named {
  Named{"reference", Isa::reference, 0}, Named{"lanes", Isa::lanes, 0}, Named{"float", Isa::one_lane, 0},
#if HWY_ARCH_X86
      Named{"sse4", Isa::sse4, HWY_SSE4}, Named{"avx2", Isa::avx2, HWY_AVX2},
      Named{"avx512", Isa::avx512, HWY_AVX3},
#elif HWY_ARCH_ARM_A64 && !defined(SURFGRAD_NO_VECTOR_ISAS)
      Named{"neon", Isa::neon, HWY_NEON},
#endif
};

/// Asked once: inside a virtual machine the question takes tens of microseconds.
std::int64_t supported_targets() {
#ifdef SURFGRAD_NO_VECTOR_ISAS
  return 0; // compiled without their kernels
#else
  static const std::int64_t targets = hwy::SupportedTargets();
  return targets;
#endif
}

bool runs(const Named& isa) { return isa.target == 0 || (supported_targets() & isa.target) != 0; }

constexpr int nothing_forced = -1;
std::atomic<int> forced{nothing_forced};

const Named& entry_of(Isa isa) {
  return *std::find_if(named.begin(), named.end(), [isa](const Named& n) { return n.isa == isa; });
}

std::string words_of(const std::vector<Isa>& isas) {
  std::string words;
  for (const Isa isa : isas) words += (words.empty() ? "" : ", ") + std::string(name_of(isa));
  return words;
}

[[noreturn]] void fail_lacking(std::string_view name) {
  throw MachineError("SURFGRAD_ISA: this processor has no " + std::string(name) + "; it has " +
                     words_of(available_isas()));
}

/// Asked for by the environment, else the fastest.
Isa wanted() {
  const char* word = std::getenv("SURFGRAD_ISA");
  if (word == nullptr || *word == '\0') {
    static const Isa fastest = available_isas().back();
    return fastest;
  }
  for (const Named& n : named)
    if (n.name == word) {
      if (!runs(n)) fail_lacking(n.name);
      return n.isa;
    }
  throw InputError({.place = "SURFGRAD_ISA",
                    .problem = "\"" + std::string(word) + "\" is no instruction set of this program",
                    .remedy = "use one of " + words_of(available_isas())});
}

} // namespace

std::string_view name_of(Isa isa) { return entry_of(isa).name; }

std::vector<Isa> available_isas() {
  std::vector<Isa> isas;
  for (const Named& n : named)
    if (runs(n)) isas.push_back(n.isa);
  return isas;
}

Isa current_isa() {
  const int f = forced;
  return f == nothing_forced ? wanted() : static_cast<Isa>(f);
}

ForcedIsa::ForcedIsa(Isa isa) : before_(forced) {
  if (!runs(entry_of(isa))) fail_lacking(name_of(isa));
  forced = static_cast<int>(isa);
}

ForcedIsa::~ForcedIsa() { forced = before_; }

} // namespace surfgrad::simd
