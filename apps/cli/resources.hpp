#pragma once

#include <cstdint>

namespace surfgrad::cli {

/// Processor cores that this process may run on, at least 1.
[[nodiscard]] int usable_cores();

/// Bytes that this process can have at most: the machine's, or less where a limit or a container says so.
[[nodiscard]] std::uint64_t usable_memory();

} // namespace surfgrad::cli
