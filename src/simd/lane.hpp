#pragma once

/// Single lanes of a scalar, for what cannot be done in lanes: lookups in data structures. A pack
/// supplies `lane` in its own namespace and specialises `lane_count`.

#include <surfgrad/scalar.hpp>

namespace surfgrad {

template <class T>
inline constexpr int lane_count = 1;

template <std::floating_point T>
[[nodiscard]] constexpr T lane(T a, int) {
  return a;
}

} // namespace surfgrad
