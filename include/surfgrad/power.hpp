#pragma once

/// log2, exp2 and pow of any Scalar, without libm: the same bits on every machine and lane.
///
/// Powers of two are split off first, exactly; the series then run over a fixed, small range. A Scalar offers
/// no access to exponent bits: a ladder of selections splits them off. One that has them may supply
/// split_exponent and split_whole, as those for float and double below.

#include <surfgrad/scalar.hpp>

#include <bit>

namespace surfgrad {

namespace detail {

/// Terms after which the series below have fallen under half an ulp.
template <Scalar T>
inline constexpr bool single_precision = std::numeric_limits<value_t<T>>::digits <= 24;

/// 2^n for an integer n whose power is a normal number.
template <class Value>
[[nodiscard]] SURFGRAD_HOST_DEVICE consteval Value power_of_two(int n) {
  Value result = 1;
  for (int i = 0; i < (n < 0 ? -n : n); ++i) result *= n < 0 ? Value(0.5) : Value(2);
  return result;
}

/// One rung of log2's ladder: m into [1, 2^step) by powers of two, which go to the exponent.
template <int step, Scalar T>
SURFGRAD_HOST_DEVICE constexpr void extract_exponent(T& m, T& exponent) {
  const T up = T(power_of_two<value_t<T>>(step));
  const T down = T(power_of_two<value_t<T>>(-step));
  const T s = T(static_cast<value_t<T>>(step));
  const mask_t<T> large = !(m < up);
  m = select(large, m * down, m);
  exponent = select(large, exponent + s, exponent);
  // m * up < 2 keeps m within [1, 2) at the end: it stops where the next lower rung takes over.
  const mask_t<T> small = m * up < constant<T>(2);
  m = select(small, m * up, m);
  exponent = select(small, exponent - s, exponent);
  if constexpr (step > 1) extract_exponent<step / 2>(m, exponent);
}

/// One rung of exp2's ladder: rest into (-step, step), its whole part into the power.
template <int step, Scalar T>
SURFGRAD_HOST_DEVICE constexpr void extract_power(T& rest, T& power) {
  const T s = T(static_cast<value_t<T>>(step));
  const mask_t<T> large = !(rest < s);
  power = select(large, power * T(power_of_two<value_t<T>>(step)), power);
  rest = select(large, rest - s, rest);
  const mask_t<T> small = !(-s < rest);
  power = select(small, power * T(power_of_two<value_t<T>>(-step)), power);
  rest = select(small, rest + s, rest);
  if constexpr (step > 1) extract_power<step / 2>(rest, power);
}

/// The integer that holds a float's bits, and where its exponent lies in it.
template <std::floating_point V>
using float_bits = std::conditional_t<sizeof(V) == 4, std::uint32_t, std::uint64_t>;
template <std::floating_point V>
inline constexpr int fraction_bits = std::numeric_limits<V>::digits - 1;

/// m, a normal positive number, into [1, 2); its exponent is added to `exponent`.
template <std::floating_point V>
SURFGRAD_HOST_DEVICE constexpr void split_exponent(V& m, V& exponent) {
  constexpr int bias = std::numeric_limits<V>::max_exponent - 1;
  const auto bits = std::bit_cast<float_bits<V>>(m);
  const auto fraction = bits & ((float_bits<V>(1) << fraction_bits<V>)-1);
  exponent += static_cast<V>(static_cast<int>(bits >> fraction_bits<V>) - bias);
  m = std::bit_cast<V>(fraction | (float_bits<V>(bias) << fraction_bits<V>));
}

/// rest, whose power of two is a normal number, into (-1, 1); power is multiplied by 2 to its whole part.
template <std::floating_point V>
SURFGRAD_HOST_DEVICE constexpr void split_whole(V& rest, V& power) {
  constexpr int bias = std::numeric_limits<V>::max_exponent - 1;
  const int whole = static_cast<int>(rest);
  rest -= static_cast<V>(whole);
  power *= std::bit_cast<V>(static_cast<float_bits<V>>(whole + bias) << fraction_bits<V>);
}

/// The same of any Scalar, by its own split_exponent or by a ladder: right from 2^(1 - 2 widest) to 2^(2 widest).
template <int widest, Scalar T>
SURFGRAD_HOST_DEVICE constexpr void take_exponent(T& m, T& exponent) {
  if constexpr (requires { split_exponent(m, exponent); })
    split_exponent(m, exponent);
  else
    extract_exponent<widest>(m, exponent);
}

} // namespace detail

/// Base-2 logarithm.
///
/// a           positive
/// degenerate  zero, negative, subnormal and NaN arguments give the logarithm of the smallest normal
///             number (about -126 or -1022): a finite LOD or power is wanted there, never -Inf
/// error       2 eps * max(1, |log2(a)|)
/// source      own; series as derived in the body
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T log2(T a) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  [[maybe_unused]] constexpr int widest = detail::single_precision<T> ? 64 : 512;
  T m = max(a, T(std::numeric_limits<value_t<T>>::min()));
  m = min(m, T(std::numeric_limits<value_t<T>>::max()));
  T exponent = zero;
  detail::take_exponent<widest>(m, exponent);
  // Centre the range on 1: m in [sqrt(1/2), sqrt(2)), where log2(m) = 2/ln2 * atanh((m-1)/(m+1)).
  const mask_t<T> upper = constant<T>(1.41421356237309514547) < m;
  m = select(upper, m * constant<T>(0.5), m);
  exponent = select(upper, exponent + one, exponent);
  const T z = (m - one) / (m + one);
  const T z2 = z * z;
  // z2 <= 0.0295: 0.0295^n / (2n + 1) is below 2^-24 from n = 4 and below 2^-53 from n = 10 on.
  constexpr int terms = detail::single_precision<T> ? 5 : 11;
  T series = zero;
  for (int n = terms; n >= 1; --n) series = (series + constant<T>(1.0 / (2 * n + 1))) * z2;
  constexpr double two_over_ln2 = 2.88539008177792681472;
  return exponent + constant<T>(two_over_ln2) * (z + z * series);
}

/// 2 to the power a.
///
/// degenerate  saturates: at and below the smallest normal exponent the result is 0, above the largest it
///             is the largest finite number; NaN gives 0
/// error       4 eps relative
/// source      own; series as derived in the body
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T exp2(T a) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  [[maybe_unused]] constexpr int widest = detail::single_precision<T> ? 64 : 512;
  constexpr int lowest = std::numeric_limits<value_t<T>>::min_exponent - 1;
  constexpr int highest = std::numeric_limits<value_t<T>>::max_exponent;
  const mask_t<T> vanishes = !(T(static_cast<value_t<T>>(lowest)) < a);
  const mask_t<T> saturates = !(a < T(static_cast<value_t<T>>(highest)));
  // NaN is in both masks; the selection below lets vanishes win.
  T rest = select(vanishes | saturates, zero, a);
  T power = one;
  using detail::split_whole;
  if constexpr (requires { split_whole(rest, power); })
    split_whole(rest, power);
  else
    detail::extract_power<widest>(rest, power);
  // rest in (-1, 1): square the exponential of half of it, so that the series converges fast.
  constexpr double half_ln2 = 0.34657359027997264311;
  const T x = rest * constant<T>(half_ln2);
  // |x| <= 0.347: x^n / n! is below 2^-24 from n = 8 and below 2^-53 from n = 14 on.
  constexpr int terms = detail::single_precision<T> ? 8 : 14;
  T series = one;
  for (int n = terms; n >= 1; --n) series = one + x * series * constant<T>(1.0 / n);
  return select(vanishes, zero,
                select(saturates, T(std::numeric_limits<value_t<T>>::max()), power * (series * series)));
}

/// a to the power k, for a >= 0.
///
/// degenerate  a zero, negative or NaN gives 0, whatever k; NaN in k gives 0; saturates as exp2
/// error       (4 + 2 * |k * log2(a)|) eps relative: the logarithm's error is raised too
/// source      own: 2^(k * log2(a))
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T pow(T a, T k) {
  return select(T(value_t<T>(0)) < a, exp2(k * log2(a)), T(value_t<T>(0)));
}

} // namespace surfgrad
