#pragma once

/// From linear light to codes of a display.

#include <surfgrad/power.hpp>

#include <array>
#include <limits>

namespace surfgrad::render {

namespace detail {

inline constexpr double srgb_exponent = 5.0 / 12; // 1 / 2.4

/// Coefficients of (1.5 + t)^(5/12) by powers of t: the binomial series.
template <std::size_t count>
[[nodiscard]] consteval std::array<double, count> srgb_series() {
  std::array<double, count> coefficients{1.18405358737520858}; // 1.5^(5/12)
  for (std::size_t n = 1; n < count; ++n)
    coefficients[n] =
        coefficients[n - 1] * (srgb_exponent - (static_cast<double>(n) - 1)) / (1.5 * static_cast<double>(n));
  return coefficients;
}

/// v^(5/12) for v in [0.0031308, 1], where the sRGB curve is that power.
///
/// v = m / 2^k with m in [1, 2) and k up to 9, and v^(5/12) = m^(5/12) 2^(-5 k / 12): a series in m - 1.5, which
/// is exact, times one of ten constants. Roots, which would bring v into so small a range as well, take vector
/// units longer than all of it.
///
/// error  3 eps relative: 2 of the series and half an eps for the constant and for the product
template <Scalar T>
[[nodiscard]] T srgb_power(T v) {
  constexpr std::array scales{1.0,
                              0.749153538438340749,
                              0.561231024154686491,
                              0.420448207626857272,
                              0.314980262473718291,
                              0.235968578170423374,
                              0.176776695296636881,
                              0.132432886794911908,
                              0.0992125657480124672,
                              0.0743254446876700667}; // 2^(-5 k / 12)
  // What is left out is below a quarter of an ulp: |t / 1.5|^n <= 3^-n.
  constexpr std::size_t count = std::numeric_limits<value_t<T>>::digits <= 24 ? 13 : 30;
  constexpr std::array<double, count> coefficients = srgb_series<count>();
  T m = v;
  T exponent = T(value_t<T>(0));
  surfgrad::detail::take_exponent<8>(m, exponent);
  const T t = m - constant<T>(1.5);
  T series = constant<T>(coefficients[count - 1]);
  for (std::size_t n = count - 1; n-- > 0;) series = constant<T>(coefficients[n]) + t * series;
  T scale = constant<T>(scales[0]);
  for (std::size_t k = 1; k < scales.size(); ++k)
    scale = select(exponent == constant<T>(-static_cast<double>(k)), constant<T>(scales[k]), scale);
  return scale * series;
}

} // namespace detail

/// Linear radiance to a display code in [0, 1]: a soft shoulder, then the sRGB curve.
///
/// degenerate  negative light and NaN are black, infinite light is white
/// error       4 eps times the code plus 0.055, which the curve subtracts: the shoulder's rounding and
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
