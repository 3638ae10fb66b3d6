#pragma once

/// From linear light to codes of a display.

#include <surfgrad/scalar.hpp>

namespace surfgrad::render {

namespace detail {

/// v^(5/12), the sRGB curve's power of 1 / 2.4, for v in [0.0031308, 1] where that curve is a power.
///
/// Three roots bring v to z in [0.486, 1], and v^(5/12) = z^(10/3) = 0.75^(10/3) (1 + t / 0.75)^(10/3) by
/// the binomial series in t = z - 0.75, |t| < 0.264, an exact difference. Far fewer operations than a
/// logarithm and a power of any argument take, and no less exact.
///
/// error  5 eps relative: that of z, 1.75 half-eps, times 10/3, and 2 eps of the series
template <Scalar T>
[[nodiscard]] T srgb_power(T v) {
  const T z = sqrt(sqrt(sqrt(v)));
  const T t = z - constant<T>(0.75);
  // The terms left out sum to less than half an ulp.
  constexpr int terms = std::numeric_limits<value_t<T>>::digits <= 24 ? 10 : 27;
  T series = T(value_t<T>(1));
  // (1 + x)^k = 1 + k x (1 + (k - 1) / 2 x (1 + (k - 2) / 3 x (...))) with x = t / 0.75
  for (int n = terms; n >= 1; --n)
    series = T(value_t<T>(1)) + series * t * constant<T>((10.0 / 3 - (n - 1)) / (0.75 * n));
  constexpr double middle = 0.383298875050529453; // 0.75^(10/3)
  return constant<T>(middle) * series;
}

} // namespace detail

/// Linear radiance to a display code in [0, 1]: a soft shoulder, then the sRGB curve.
///
/// degenerate  negative light and NaN are black, infinite light is white
/// error       6 eps times the code plus 0.055, which the curve subtracts: the shoulder's rounding and
///             that of the power
template <Scalar T>
[[nodiscard]] T display_value(T linear) {
  // Straight up to the shoulder, then bent towards 1 with a matching slope.
  constexpr double shoulder = 0.7;
  const T one = T(value_t<T>(1));
  const T start = constant<T>(shoulder);
  const T x = max(linear, T(value_t<T>(0)));
  const T bent =
      one - constant<T>((1 - shoulder) * (1 - shoulder)) / (max(x, start) - constant<T>(2 * shoulder - 1));
  const T y = select(start < x, bent, x);
  const T curve = constant<T>(1.055) * detail::srgb_power(y) - constant<T>(0.055);
  return select(constant<T>(0.0031308) < y, curve, constant<T>(12.92) * y);
}

} // namespace surfgrad::render
