#pragma once

namespace surfgrad::stage::test {

/// How often this program has asked for memory by new since it started.
[[nodiscard]] long allocations();

} // namespace surfgrad::stage::test
