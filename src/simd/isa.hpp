#pragma once

#include <string_view>
#include <vector>

namespace surfgrad::simd {

/// What the kernels of the program run on. All but the reference give the same bytes.
enum class Isa {
  reference, ///< double, one fragment at a time: the truth that the others are tested against
  one_lane,  ///< float, one fragment at a time
  lanes,     ///< eight emulated lanes in plain C++
  sse4,
  avx2,
  avx512,
  neon,
};

[[nodiscard]] std::string_view name_of(Isa isa);

/// Those that this program holds and this processor runs, slowest first.
[[nodiscard]] std::vector<Isa> available_isas();

/// The one in use: the fastest, unless the environment variable SURFGRAD_ISA names another or a
/// ForcedIsa is alive. Throws InputError where that is no instruction set, MachineError where the processor
/// lacks it.
[[nodiscard]] Isa current_isa();

/// Makes every thread use one instruction set while it lives. Throws MachineError where the processor
/// lacks it.
class ForcedIsa {
 public:
  explicit ForcedIsa(Isa isa);
  ~ForcedIsa();
  ForcedIsa(const ForcedIsa&) = delete;
  ForcedIsa& operator=(const ForcedIsa&) = delete;

 private:
  int before_;
};

} // namespace surfgrad::simd
