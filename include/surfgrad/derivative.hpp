#pragma once

/// Slopes of a bump map: the two-component form in which maps are filtered, blended and scaled.
///
/// A derivative is (dh/ds, dh/dt). Texture origin lower left, t up, green along +t: a map with green
/// down is converted where it is loaded (section 2.1), never here.

#include <surfgrad/vec.hpp>

namespace surfgrad {

/// Slopes steeper than this are clamped: 89.55 degrees, exact in every precision (listing 4).
inline constexpr int max_slope = 128;

/// Derivative of a tangent-space normal given by three channels.
///
/// m           normal in [-1, 1]^3, of any length: only its direction counts
/// returns     -m.xy / max(|m.z|, max(|m.x|, |m.y|) / 128), each component within [-128, 128]
/// degenerate  (0, 0, 0) and (0, 0, z) give zero; m.z <= 0 is treated as |m.z|; NaN propagates. A vector
///             of subnormal components may count as zero.
/// error       1 ulp per component (a division)
/// source      Mikkelsen 2019, equation 4, with the clamp of listing 4
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> derivative_from_normal(vec3<T> m) {
  const T zero = T(value_t<T>(0));
  const T steepest = max(abs(m.x), abs(m.y)) * constant<T>(1.0 / max_slope);
  const T z = max(steepest, abs(m.z));
  const mask_t<T> flat = z == zero;
  const T divisor = select(flat, T(value_t<T>(1)), z);
  return {select(flat, zero, -(m.x / divisor)), select(flat, zero, -(m.y / divisor))};
}

/// Derivative of a tangent-space normal given by two channels, the third reconstructed.
///
/// m           channels x, y in [-1, 1] of a unit normal
/// returns     -m / sqrt(max(1 - |m|^2, (max(|m.x|, |m.y|) / 128)^2)), within [-128, 128]
/// degenerate  zero gives zero; |m| >= 1 gives the steepest slope in the direction of m; NaN propagates
/// error       2 eps + eps / (1 - |m|^2), relative: the reconstruction cancels as |m| nears 1
/// source      Mikkelsen 2019, listing 4, equation 5
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec2<T> derivative_from_normal(vec2<T> m) {
  const vec2<T> squared = m * m;
  const T z_squared = T(value_t<T>(1)) - squared.x - squared.y;
  const T least = max(squared.x, squared.y) * constant<T>(1.0 / (max_slope * max_slope));
  const T inverse_z = T(value_t<T>(1)) / sqrt(max(z_squared, least));
  return {-(inverse_z * m.x), -(inverse_z * m.y)};
}

/// Unit tangent-space normal of a derivative: the inverse of derivative_from_normal.
///
/// returns     normalize(-d.x, -d.y, 1)
/// degenerate  no finite derivative is; NaN and Inf give NaN
/// error       4 eps per component
/// source      Mikkelsen 2019, equation 4
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> normal_from_derivative(vec2<T> d) {
  return normalize_or_zero(vec3<T>{-d.x, -d.y, T(value_t<T>(1))});
}

/// Screen-space derivative of a height from three taps: better than differences across a pixel quad.
///
/// h, h_x, h_y  heights at st, st + dst_dx, st + dst_dy
/// returns      (dh/dx, dh/dy) per pixel, for from_height_derivative
/// degenerate   equal heights give zero; NaN propagates, as does the difference of infinities
/// error        half an ulp of the difference
/// source       Mikkelsen 2019, listing 9
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> derivative_from_heights(T h, T h_x, T h_y) {
  return {h_x - h, h_y - h};
}

/// Derivative of the uniform cubic B-spline through (not interpolating) 4x4 heights: smooth where a
/// height map is magnified.
///
/// texels      rows along t (row x lowest), columns along s; the point lies between the second and
///             third of each
/// fraction    position in [0, 1]^2 from the second texel towards the third
/// returns     (dh/ds, dh/dt) per texel, for from_texel_derivative
/// degenerate  equal texels give zero to rounding; NaN in any texel propagates. A fraction outside
///             [0, 1] continues the patch's polynomial, without the error bound.
/// error       8 eps * the largest |texel|
/// source      the bicubic option of the paper's reference implementation, as a formula
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> derivative_from_bicubic(const mat4<T>& texels,
                                                                             vec2<T> fraction) {
  struct Basis {
    SURFGRAD_HOST_DEVICE static constexpr vec4<T> weights(T f) {
      const T g = T(value_t<T>(1)) - f;
      const T sixth = constant<T>(1.0 / 6.0);
      const T four = T(value_t<T>(4));
      const T three = T(value_t<T>(3));
      const T six = T(value_t<T>(6));
      return {g * g * g * sixth, (four - f * f * (six - three * f)) * sixth,
              (four - g * g * (six - three * g)) * sixth, f * f * f * sixth};
    }
    SURFGRAD_HOST_DEVICE static constexpr vec4<T> slopes(T f) {
      const T half = constant<T>(0.5);
      const T g = T(value_t<T>(1)) - f;
      const T middle = f * (constant<T>(1.5) * f - T(value_t<T>(2)));
      const T other = g * (constant<T>(1.5) * g - T(value_t<T>(2)));
      return {-(half * g * g), middle, -other, half * f * f};
    }
  };
  const vec4<T> along_s_slope{
      dot(texels.x, Basis::slopes(fraction.x)), dot(texels.y, Basis::slopes(fraction.x)),
      dot(texels.z, Basis::slopes(fraction.x)), dot(texels.w, Basis::slopes(fraction.x))};
  const vec4<T> along_s{dot(texels.x, Basis::weights(fraction.x)), dot(texels.y, Basis::weights(fraction.x)),
                        dot(texels.z, Basis::weights(fraction.x)), dot(texels.w, Basis::weights(fraction.x))};
  return {dot(along_s_slope, Basis::weights(fraction.y)), dot(along_s, Basis::slopes(fraction.y))};
}

/// Bump scale applied to a derivative.
///
/// degenerate  none: zero gives zero; NaN and Inf propagate
/// error       half an ulp per component
/// source      Mikkelsen 2019, listing 3
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> scale_bump(T scale, vec2<T> deriv) {
  return scale * deriv;
}

} // namespace surfgrad
