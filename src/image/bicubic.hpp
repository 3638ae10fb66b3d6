#pragma once

#include "image/sampler.hpp"

#include <surfgrad/derivative.hpp>

namespace surfgrad::image {

/// Uniform cubic B-spline of 4x4 texels: what derivative_from_bicubic is the derivative of.
///
/// texels      rows along t (row x lowest), columns along s
/// fraction    position in [0, 1]^2 from the second texel towards the third
/// degenerate  equal texels give their value to rounding; NaN in any texel propagates
/// error       8 eps * the largest |texel|
template <Scalar T>
[[nodiscard]] T value_from_bicubic(const mat4<T>& texels, vec2<T> fraction) {
  const auto weights = [](T f) -> vec4<T> {
    const T g = T(value_t<T>(1)) - f;
    const T sixth = constant<T>(1.0 / 6.0);
    const T four = T(value_t<T>(4));
    const T half = constant<T>(0.5);
    return {g * g * g * sixth, four * sixth - f * f * (T(value_t<T>(1)) - half * f),
            four * sixth - g * g * (T(value_t<T>(1)) - half * g), f * f * f * sixth};
  };
  return dot(texels * weights(fraction.x), weights(fraction.y));
}

/// A smooth height and its slopes.
template <class T>
struct BicubicSample {
  T value;
  vec2<T> derivative; ///< (dh/ds, dh/dt) per texel of level 0: for from_texel_derivative
};

namespace detail {

/// Four neighbouring texels along an axis; the point lies `fraction` past the second.
template <class T>
struct CubicTaps {
  std::array<index_t<T>, 4> texel;
  T fraction;
  T direction; ///< -1 on a reflected copy, where texels run against the coordinate
};

template <LaneScalar T>
[[nodiscard]] CubicTaps<T> cubic_taps(T s, int size, Wrap wrap) {
  const T n = T(static_cast<value_t<T>>(size));
  const T half = constant<T>(0.5);
  const T one = T(value_t<T>(1));
  // A clamped coordinate goes on until all four texels are the border's: the spline ends level there,
  // without the kink it would have if it stopped at the border. NaN becomes the lower end.
  const T x = wrap == Wrap::clamp ? min(max(s * n - half, constant<T>(-2)), n + one)
                                  : wrap_coordinate(s, wrap) * n - half;
  const T low = floor(x);
  CubicTaps<T> taps{{}, max(x - low, T(value_t<T>(0))), one}; // max: NaN becomes 0, as in linear_taps
  for (int k = 0; k < 4; ++k)
    taps.texel[k] = wrap_index<T>(to_index(low + constant<T>(k - 1)), index_constant<T>(size), wrap);
  if (wrap == Wrap::mirror) taps.direction = select(one < mirror_phase(s), -one, one);
  return taps;
}

} // namespace detail

/// The uniform cubic B-spline of a height map's level 0: 16 texels, twice continuously differentiable
/// across texel borders and the map's own, hence the choice where a map is magnified. It does not pass
/// through the texels: it smooths by (1, 4, 1) / 6 along each axis.
///
/// map      of one component
/// st       normalised, lower-left origin; texel centres lie at (i + 0.5) / size
/// active   lanes to sample; others give 0
/// returns  value and derivative of the same function, along st also on reflected copies
/// NaN      and infinite coordinates read some texels; the derivative is finite wherever texels are
/// error    8 eps * the largest difference between the texel left and below and the 15 others, for the
///          derivative; for the value an ulp more. Equal texels have the derivative 0 exactly.
template <LaneScalar T>
[[nodiscard]] BicubicSample<T> sample_bicubic(const Map& map, vec2<T> st, Wraps wraps, mask_t<T> active) {
  const detail::CubicTaps<T> x = detail::cubic_taps(st.x, map.width(), wraps.s);
  const detail::CubicTaps<T> y = detail::cubic_taps(st.y, map.height(), wraps.t);
  const detail::Level<T> level = detail::level_of<T>(map, 0);
  const auto texel = [&](int i, int j) {
    const bits_t<T> word = detail::word_of<1, T>(level, x.texel[i], y.texel[j]);
    return map.format == TexelFormat::unorm16
               ? detail::Texels<TexelFormat::unorm16, 1>::one<T>(map.texels(), word, active)[0]
               : detail::Texels<TexelFormat::floats, 1>::one<T>(map.texels(), word, active)[0];
  };
  // Heights relative to one of them: a plateau far above zero keeps the precision of its relief.
  const T pivot = texel(1, 1);
  const auto row = [&](int j) -> vec4<T> {
    return {texel(0, j) - pivot, texel(1, j) - pivot, texel(2, j) - pivot, texel(3, j) - pivot};
  };
  const mat4<T> relief{row(0), row(1), row(2), row(3)};
  const vec2<T> fraction{x.fraction, y.fraction};
  const vec2<T> direction{x.direction, y.direction};
  const T scale = constant<T>(map.scale);
  return {scale * (pivot + value_from_bicubic(relief, fraction)),
          scale * (direction * derivative_from_bicubic(relief, fraction))};
}

} // namespace surfgrad::image
