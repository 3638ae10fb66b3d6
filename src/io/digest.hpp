#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace surfgrad::io {

/// 32 hexadecimal digits that tell contents apart: XXH3's 128 bits, the same on every machine. No proof
/// against whoever wants two contents to look the same.
[[nodiscard]] std::string digest(std::span<const std::byte> bytes);

} // namespace surfgrad::io
