#pragma once

/// A pack of eight float lanes in plain C++: no intrinsics, the same bits everywhere.
///
/// It proves that the core runs on packs, stands in where a vector unit is missing, and is the
/// reference that vector packs are compared with. Every operation is the one-lane operation of the
/// core's scalar, lane by lane.

#include "simd/lane.hpp"

#include <array>
#include <bit>
#include <surfgrad/scalar.hpp>

namespace surfgrad::simd {

inline constexpr int emulated_width = 8;

/// Eight lanes of one kind. Tag keeps masks, indices and bits apart, as vector registers do.
template <class Value, class Tag>
struct EmulatedLanes {
  std::array<Value, emulated_width> lane{};

  constexpr EmulatedLanes() = default;
  /// The same value in every lane.
  explicit constexpr EmulatedLanes(Value v) { lane.fill(v); }
  /// Lane by lane conversion: index to float, index to bits, bits to index (modulo 2^32).
  template <class From, class FromTag>
  explicit constexpr EmulatedLanes(const EmulatedLanes<From, FromTag>& from) {
    for (int i = 0; i < emulated_width; ++i) lane[i] = static_cast<Value>(from.lane[i]);
  }
};

using EmulatedFloat = EmulatedLanes<float, struct FloatLanes>;
using EmulatedMask = EmulatedLanes<bool, struct MaskLanes>;
using EmulatedIndex = EmulatedLanes<std::int32_t, struct IndexLanes>;
using EmulatedBits = EmulatedLanes<std::uint32_t, struct BitsLanes>;

namespace detail {

/// Applies a one-lane function to each lane of its arguments.
template <class Result, class Function, class... Lanes>
[[nodiscard]] constexpr Result each_lane(Function f, const Lanes&... a) {
  Result r;
  for (int i = 0; i < emulated_width; ++i) r.lane[i] = f(a.lane[i]...);
  return r;
}

} // namespace detail

// clang-format off
constexpr EmulatedFloat operator+(const EmulatedFloat& a, const EmulatedFloat& b) { return detail::each_lane<EmulatedFloat>([](float x, float y) { return x + y; }, a, b); }
constexpr EmulatedFloat operator-(const EmulatedFloat& a, const EmulatedFloat& b) { return detail::each_lane<EmulatedFloat>([](float x, float y) { return x - y; }, a, b); }
constexpr EmulatedFloat operator*(const EmulatedFloat& a, const EmulatedFloat& b) { return detail::each_lane<EmulatedFloat>([](float x, float y) { return x * y; }, a, b); }
constexpr EmulatedFloat operator/(const EmulatedFloat& a, const EmulatedFloat& b) { return detail::each_lane<EmulatedFloat>([](float x, float y) { return x / y; }, a, b); }
constexpr EmulatedFloat operator-(const EmulatedFloat& a) { return detail::each_lane<EmulatedFloat>([](float x) { return -x; }, a); }
constexpr EmulatedMask operator<(const EmulatedFloat& a, const EmulatedFloat& b) { return detail::each_lane<EmulatedMask>([](float x, float y) { return x < y; }, a, b); }
constexpr EmulatedMask operator==(const EmulatedFloat& a, const EmulatedFloat& b) { return detail::each_lane<EmulatedMask>([](float x, float y) { return x == y; }, a, b); }

constexpr EmulatedMask operator&(const EmulatedMask& a, const EmulatedMask& b) { return detail::each_lane<EmulatedMask>([](bool x, bool y) { return x && y; }, a, b); }
constexpr EmulatedMask operator|(const EmulatedMask& a, const EmulatedMask& b) { return detail::each_lane<EmulatedMask>([](bool x, bool y) { return x || y; }, a, b); }
constexpr EmulatedMask operator!(const EmulatedMask& a) { return detail::each_lane<EmulatedMask>([](bool x) { return !x; }, a); }

// Integer lanes wrap, as vector registers do.
constexpr EmulatedIndex operator+(const EmulatedIndex& a, const EmulatedIndex& b) { return EmulatedIndex(detail::each_lane<EmulatedBits>([](std::int32_t x, std::int32_t y) { return static_cast<std::uint32_t>(x) + static_cast<std::uint32_t>(y); }, a, b)); }
constexpr EmulatedIndex operator-(const EmulatedIndex& a, const EmulatedIndex& b) { return EmulatedIndex(detail::each_lane<EmulatedBits>([](std::int32_t x, std::int32_t y) { return static_cast<std::uint32_t>(x) - static_cast<std::uint32_t>(y); }, a, b)); }
constexpr EmulatedIndex operator*(const EmulatedIndex& a, const EmulatedIndex& b) { return EmulatedIndex(detail::each_lane<EmulatedBits>([](std::int32_t x, std::int32_t y) { return static_cast<std::uint32_t>(x) * static_cast<std::uint32_t>(y); }, a, b)); }
constexpr EmulatedIndex operator&(const EmulatedIndex& a, const EmulatedIndex& b) { return detail::each_lane<EmulatedIndex>([](std::int32_t x, std::int32_t y) { return x & y; }, a, b); }
constexpr EmulatedIndex operator>>(const EmulatedIndex& a, int n) { return detail::each_lane<EmulatedIndex>([n](std::int32_t x) { return x >> n; }, a); }
constexpr EmulatedMask operator<(const EmulatedIndex& a, const EmulatedIndex& b) { return detail::each_lane<EmulatedMask>([](std::int32_t x, std::int32_t y) { return x < y; }, a, b); }
constexpr EmulatedMask operator==(const EmulatedIndex& a, const EmulatedIndex& b) { return detail::each_lane<EmulatedMask>([](std::int32_t x, std::int32_t y) { return x == y; }, a, b); }

constexpr EmulatedBits operator+(const EmulatedBits& a, const EmulatedBits& b) { return detail::each_lane<EmulatedBits>([](std::uint32_t x, std::uint32_t y) { return x + y; }, a, b); }
constexpr EmulatedBits operator*(const EmulatedBits& a, const EmulatedBits& b) { return detail::each_lane<EmulatedBits>([](std::uint32_t x, std::uint32_t y) { return x * y; }, a, b); }
constexpr EmulatedBits operator^(const EmulatedBits& a, const EmulatedBits& b) { return detail::each_lane<EmulatedBits>([](std::uint32_t x, std::uint32_t y) { return x ^ y; }, a, b); }
constexpr EmulatedBits operator&(const EmulatedBits& a, const EmulatedBits& b) { return detail::each_lane<EmulatedBits>([](std::uint32_t x, std::uint32_t y) { return x & y; }, a, b); }
constexpr EmulatedBits operator|(const EmulatedBits& a, const EmulatedBits& b) { return detail::each_lane<EmulatedBits>([](std::uint32_t x, std::uint32_t y) { return x | y; }, a, b); }
constexpr EmulatedBits operator>>(const EmulatedBits& a, int n) { return detail::each_lane<EmulatedBits>([n](std::uint32_t x) { return x >> n; }, a); }
constexpr EmulatedBits operator<<(const EmulatedBits& a, int n) { return detail::each_lane<EmulatedBits>([n](std::uint32_t x) { return x << n; }, a); }
// clang-format on

/// Lane by lane, a where the mask is set, else b.
template <class Value, class Tag>
[[nodiscard]] constexpr EmulatedLanes<Value, Tag>
select(const EmulatedMask& m, const EmulatedLanes<Value, Tag>& a, const EmulatedLanes<Value, Tag>& b) {
  return detail::each_lane<EmulatedLanes<Value, Tag>>([](bool s, Value x, Value y) { return s ? x : y; }, m,
                                                      a, b);
}

[[nodiscard]] constexpr bool any(const EmulatedMask& m) {
  for (const bool set : m.lane)
    if (set) return true;
  return false;
}
[[nodiscard]] constexpr bool all(const EmulatedMask& m) { return !any(!m); }

[[nodiscard]] inline EmulatedFloat sqrt(const EmulatedFloat& a) {
  return detail::each_lane<EmulatedFloat>([](float x) { return surfgrad::sqrt(x); }, a);
}
[[nodiscard]] inline EmulatedFloat floor(const EmulatedFloat& a) {
  return detail::each_lane<EmulatedFloat>([](float x) { return surfgrad::floor(x); }, a);
}
[[nodiscard]] constexpr EmulatedFloat abs(const EmulatedFloat& a) {
  return detail::each_lane<EmulatedFloat>([](float x) { return surfgrad::abs(x); }, a);
}
/// b where either is NaN.
[[nodiscard]] constexpr EmulatedFloat min(const EmulatedFloat& a, const EmulatedFloat& b) {
  return detail::each_lane<EmulatedFloat>([](float x, float y) { return surfgrad::min(x, y); }, a, b);
}
/// b where either is NaN.
[[nodiscard]] constexpr EmulatedFloat max(const EmulatedFloat& a, const EmulatedFloat& b) {
  return detail::each_lane<EmulatedFloat>([](float x, float y) { return surfgrad::max(x, y); }, a, b);
}
[[nodiscard]] constexpr float lane(const EmulatedFloat& a, int i) { return a.lane[i]; }
[[nodiscard]] constexpr std::int32_t lane(const EmulatedIndex& a, int i) { return a.lane[i]; }
[[nodiscard]] constexpr EmulatedFloat with_lane(EmulatedFloat a, int i, float x) {
  a.lane[i] = x;
  return a;
}
/// Whether an index is the same in all lanes that are active, and what it is there: 0 where none is.
[[nodiscard]] constexpr bool same_in_all(const EmulatedIndex& a, const EmulatedMask& active,
                                         std::int32_t& value) {
  value = 0;
  bool met = false;
  for (int i = 0; i < emulated_width; ++i) {
    if (!active.lane[i]) continue;
    if (met && a.lane[i] != value) return false;
    value = a.lane[i];
    met = true;
  }
  return true;
}
/// Truncates; saturates; NaN gives 0.
[[nodiscard]] constexpr EmulatedIndex to_index(const EmulatedFloat& a) {
  return detail::each_lane<EmulatedIndex>([](float x) { return surfgrad::to_index(x); }, a);
}
/// The floats whose bits these are.
template <std::same_as<EmulatedFloat> T>
[[nodiscard]] constexpr T float_from_bits(const EmulatedBits& a) {
  return detail::each_lane<T>([](std::uint32_t x) { return std::bit_cast<float>(x); }, a);
}
/// Unset lanes read nothing and give 0.
[[nodiscard]] constexpr EmulatedBits gather(Words words, const EmulatedIndex& index, const EmulatedMask& m) {
  return detail::each_lane<EmulatedBits>(
      [words](std::int32_t i, bool set) { return surfgrad::gather(words, i, set); }, index, m);
}

} // namespace surfgrad::simd

namespace surfgrad {

template <>
struct lanes_of<simd::EmulatedFloat> {
  using value = float;
  using mask = simd::EmulatedMask;
  using index = simd::EmulatedIndex;
  using bits = simd::EmulatedBits;
};

static_assert(LaneScalar<simd::EmulatedFloat>);

template <>
inline constexpr int lane_count<simd::EmulatedFloat> = simd::emulated_width;

template <>
struct LaneArrays<simd::EmulatedFloat> {
  static constexpr simd::EmulatedFloat load(const float* from) {
    return lanes_of_array<simd::EmulatedFloat>(from);
  }
  static constexpr simd::EmulatedIndex load_index(const std::int32_t* from) {
    return lanes_of_array<simd::EmulatedIndex>(from);
  }
  static constexpr void store(const simd::EmulatedFloat& a, float* to) {
    for (const float x : a.lane) *to++ = x;
  }

 private:
  template <class Lanes, class Value>
  static constexpr Lanes lanes_of_array(const Value* from) {
    Lanes r;
    for (Value& x : r.lane) x = *from++;
    return r;
  }
};

} // namespace surfgrad
