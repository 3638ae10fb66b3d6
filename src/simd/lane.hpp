#pragma once

/// What lanes have to do with each other and with memory beyond the core's needs. A pack supplies `lane` and
/// `same_in_all` in its own namespace, may supply a faster `gather_pair`, and specialises `lane_count`.

#include <surfgrad/scalar.hpp>

#include <array>

namespace surfgrad {

template <class T>
inline constexpr int lane_count = 1;

template <std::floating_point T>
[[nodiscard]] constexpr T lane(T a, int) {
  return a;
}

/// Whether an index is the same in all lanes that are active, and what it is there: 0 where none is.
[[nodiscard]] constexpr bool same_in_all(std::int32_t a, bool active, std::int32_t& value) {
  value = active ? a : 0;
  return true;
}

/// The words at `index` and behind it, as gather reads them.
template <class Index, class Mask>
[[nodiscard]] auto gather_pair(Words words, const Index& index, const Mask& active) {
  return std::array{gather(words, index, active), gather(words, Index(index + Index(1)), active)};
}

} // namespace surfgrad
