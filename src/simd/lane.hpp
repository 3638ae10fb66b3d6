#pragma once

/// What lanes have to do with each other and with memory beyond the core's needs. A pack supplies `lane`,
/// `with_lane` and `same_in_all` in its own namespace, may supply a faster `whole_index` and `gather_words`,
/// and specialises `lane_count` and `LaneArrays`.

#include <surfgrad/scalar.hpp>

#include <array>

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

/// Whether a small index, 0 or more, is the same in all lanes that are active, and what it is there: 0 where
/// none is.
[[nodiscard]] constexpr bool same_in_all(std::int32_t a, bool active, std::int32_t& value) {
  value = active ? a : 0;
  return true;
}

/// to_index of a whole number from 0 to 2^22: it needs no care for what is beyond the range, or no number.
template <class T>
[[nodiscard]] constexpr index_t<T> whole_index(T a) {
  return to_index(a);
}

/// Words that packs may read beyond those asked for: arrays end with as many that nobody uses.
inline constexpr int words_read_ahead = 3;

/// The words at `index` and behind it, two or four, as gather reads them.
template <int Count, class Index, class Mask>
[[nodiscard]] auto gather_words(Words words, const Index& index, const Mask& active) {
  std::array<decltype(gather(words, index, active)), Count> result;
  for (int k = 0; k < Count; ++k) result[k] = gather(words, Index(index + Index(k)), active);
  return result;
}

} // namespace surfgrad
