#pragma once

/// The scalar concept: what a type must offer so that the library's functions run on it.
///
/// One text serves float and double, SIMD packs (one fragment a lane) and dual numbers. A pack
/// supplies the same free names in its own namespace; they are found by argument-dependent lookup.
/// Functions select with masks and branch only on uniform values.

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>

#if defined(__CUDACC__)
#define SURFGRAD_HOST_DEVICE __host__ __device__
#else
#define SURFGRAD_HOST_DEVICE
#endif

namespace surfgrad {

/// Types that go with a scalar. A pack specialises it.
template <class T>
struct lanes_of;

template <std::floating_point T>
struct lanes_of<T> {
  using value = T;             ///< one lane
  using mask = bool;           ///< result of a comparison
  using index = std::int32_t;  ///< texel and cell indices
  using bits = std::uint32_t;  ///< hashes and packed texels
};

template <class T>
using value_t = typename lanes_of<T>::value;
template <class T>
using mask_t = typename lanes_of<T>::mask;
template <class T>
using index_t = typename lanes_of<T>::index;
template <class T>
using bits_t = typename lanes_of<T>::bits;

/// Texels as whole 32-bit words. An empty map still holds one word, so that idle lanes have a
/// place to read.
struct Words {
  const std::uint32_t* data;
  std::int32_t size;
};

/// a where the mask is set, else b.
template <class V>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr V select(bool m, V a, V b) {
  return m ? a : b;
}

[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bool any(bool m) { return m; }
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bool all(bool m) { return m; }

template <std::floating_point T>
[[nodiscard]] SURFGRAD_HOST_DEVICE inline T sqrt(T a) {
  return std::sqrt(a);
}

template <std::floating_point T>
[[nodiscard]] SURFGRAD_HOST_DEVICE inline T floor(T a) {
  return std::floor(a);
}

/// |a|. NaN stays NaN; -0 becomes 0.
template <std::floating_point T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T abs(T a) {
  return a < T(0) ? -a : a + T(0);
}

/// The smaller of the two; b if either is NaN.
template <std::floating_point T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T min(T a, T b) {
  return a < b ? a : b;
}

/// The larger of the two; b if either is NaN.
template <std::floating_point T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T max(T a, T b) {
  return a > b ? a : b;
}

/// Truncates towards zero, saturates at the ends of int32, NaN gives 0.
template <std::floating_point T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr std::int32_t to_index(T a) {
  // 2^31 is exact in float and double; the largest int32 is not in float.
  if (!(a == a)) return 0;
  if (a >= T(2147483648.0)) return std::numeric_limits<std::int32_t>::max();
  if (a < T(-2147483648.0)) return std::numeric_limits<std::int32_t>::min();
  return static_cast<std::int32_t>(a);
}

/// The word at `index` where the mask is set; unset lanes read nothing and give 0.
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr std::uint32_t gather(Words words, std::int32_t index, bool m) {
  return m ? words.data[index] : 0u;
}

/// Enough for the listings of the paper: arithmetic, comparison and selection.
template <class T>
concept Scalar = requires(T a, mask_t<T> m) {
  T(value_t<T>{});
  { a + a - a * a / -a } -> std::same_as<T>;
  mask_t<T>(a < a);
  mask_t<T>(a == a);
  mask_t<T>(m & m);
  mask_t<T>(m | m);
  mask_t<T>(!m);
  { select(m, a, a) } -> std::same_as<T>;
  { any(m) } -> std::same_as<bool>;
  { all(m) } -> std::same_as<bool>;
  { sqrt(a) } -> std::same_as<T>;
  { abs(a) } -> std::same_as<T>;
  { min(a, a) } -> std::same_as<T>;
  { max(a, a) } -> std::same_as<T>;
};

/// What noise, sampling and layers need besides: integer lanes, hashes and texel fetches.
template <class T>
concept LaneScalar = Scalar<T> && requires(T a, mask_t<T> m, index_t<T> i, bits_t<T> b, Words w) {
  T(i);
  bits_t<T>(i);
  index_t<T>(b);
  { floor(a) } -> std::same_as<T>;
  { to_index(a) } -> std::same_as<index_t<T>>;
  { gather(w, i, m) } -> std::same_as<bits_t<T>>;
  { select(m, i, i) } -> std::same_as<index_t<T>>;
  bits_t<T>((b ^ (b >> 13)) * b + (b << 3));
  index_t<T>(i + i - i);
  index_t<T>(i >> 16);
  mask_t<T>(i < i);
};

/// A constant of the scalar's precision, in every lane.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T constant(double v) {
  return T(static_cast<value_t<T>>(v));
}

/// Distance from 1 to the next value of one lane; the unit of the documented error bounds.
template <Scalar T>
inline constexpr value_t<T> epsilon_v = std::numeric_limits<value_t<T>>::epsilon();

} // namespace surfgrad
