#pragma once

/// Single lanes of a scalar, and what all its lanes have in common: for lookups in data structures and
/// for arrays of lanes. A pack supplies these in its own namespace and specialises `lane_count`.

#include <surfgrad/scalar.hpp>

namespace surfgrad {

template <class T>
inline constexpr int lane_count = 1;

/// No scalar has more lanes. Arrays that are read and written in packs are padded to a multiple of it.
inline constexpr int most_lanes = 16;

template <std::floating_point T>
[[nodiscard]] constexpr T lane(T a, int) {
  return a;
}
[[nodiscard]] constexpr std::int32_t lane(std::int32_t a, int) { return a; }

/// a with lane i replaced.
template <std::floating_point T>
[[nodiscard]] constexpr T with_lane(T, int, T x) {
  return x;
}

/// Whether all lanes hold the same index; `value` is then that.
[[nodiscard]] constexpr bool same_in_all(std::int32_t a, std::int32_t& value) {
  value = a;
  return true;
}

/// How lanes go to and from arrays. A pack specialises it.
template <class T>
struct LaneArrays;

template <std::floating_point V>
struct LaneArrays<V> {
  static constexpr V load(const V* from) { return *from; }
  static constexpr std::int32_t load_index(const std::int32_t* from) { return *from; }
  static constexpr void store(V a, V* to) { *to = a; }
};

/// lane_count values from an array, which need not be aligned.
template <class T>
[[nodiscard]] constexpr T load(const value_t<T>* from) {
  return LaneArrays<T>::load(from);
}
template <class T>
[[nodiscard]] constexpr index_t<T> load_index(const std::int32_t* from) {
  return LaneArrays<T>::load_index(from);
}
/// lane_count values to an array.
template <class T>
constexpr void store(T a, value_t<T>* to) {
  LaneArrays<T>::store(a, to);
}

} // namespace surfgrad
