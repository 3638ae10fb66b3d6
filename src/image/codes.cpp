#include "image/codes.hpp"

#include <cstddef>
#include <limits>

namespace surfgrad::image {
namespace {

// Compiled with -fno-trapping-math: gcc makes vector code of these selects only where it need not mind
// which comparisons raise exceptions.
template <class Code>
void nearest_codes(std::span<const float> values, Code* codes) {
  constexpr float largest = static_cast<float>(std::numeric_limits<Code>::max());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float not_below = values[i] > 0.0f ? values[i] : 0.0f; // also NaN
    const float clamped = not_below < 1.0f ? not_below : 1.0f;
    codes[i] = static_cast<Code>(static_cast<std::int32_t>(clamped * largest + 0.5f));
  }
}

} // namespace

void to_codes(std::span<const float> values, std::uint8_t* codes) { nearest_codes(values, codes); }
void to_codes(std::span<const float> values, std::uint16_t* codes) { nearest_codes(values, codes); }

} // namespace surfgrad::image
