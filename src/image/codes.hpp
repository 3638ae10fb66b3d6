#pragma once

#include <cstdint>
#include <span>

namespace surfgrad::image {

/// The nearest integer code to each value: below 0 and NaN give 0, above 1 gives the largest code.
/// `codes` has room for all.
void to_codes(std::span<const float> values, std::uint8_t* codes);
void to_codes(std::span<const float> values, std::uint16_t* codes);

} // namespace surfgrad::image
