#pragma once

/// Sums of octaves of a noise, with the frequency clamping that replaces mip maps (section 4).

#include <surfgrad/noise.hpp>

namespace surfgrad {

/// Octave i samples the basis at frequency lacunarity^i with amplitude gain^i. All uniform.
template <class V>
struct Fractal {
  int octaves = 4;
  /// Positive. At exactly 2 every octave of Perlin noise vanishes at the lattice points of the first;
  /// a value near 2 hides the lattice.
  V lacunarity = V(2);
  V gain = V(0.5); ///< gain^octaves must be finite
};

/// perlin as a function object: the default basis of the sums.
struct PerlinBasis {
  template <LaneScalar T>
  [[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> operator()(vec3<T> p) const {
    return perlin(p);
  }
};

namespace detail {

/// What remains of an octave: 1 - smoothstep(0.25, 0.75, cells per pixel). From 3/4 of a cell a pixel
/// on the octave would only alias; NaN and negative widths leave it whole.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T octave_visibility(T cells_per_pixel) {
  const T one = T(value_t<T>(1));
  const T t = min(max(constant<T>(2) * cells_per_pixel - constant<T>(0.5), T(value_t<T>(0))), one);
  return one - t * t * (constant<T>(3) - constant<T>(2) * t);
}

template <LaneScalar T, class Basis>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> basis_at(const Basis& basis, vec3<T> p, int octave) {
  if constexpr (requires { basis(p, octave); })
    return Noise<T>(basis(p, octave));
  else
    return Noise<T>(basis(p));
}

/// Sum over octaves of `octave`, a function of the sampling point and the octave's number.
template <LaneScalar T, class Octave>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> sum_octaves(vec3<T> p, Fractal<value_t<T>> fractal, T width,
                                                        Octave octave) {
  const T zero = T(value_t<T>(0));
  Noise<T> sum{zero, {zero, zero, zero}};
  value_t<T> frequency = 1;
  value_t<T> amplitude = 1;
  // Past noise_extent even a point at distance 1 from the origin would leave the lattice.
  for (int i = 0; i < fractal.octaves && frequency < value_t<T>(noise_extent); ++i) {
    const T visibility = octave_visibility(T(frequency) * width);
    if (any(zero < visibility)) {
      const Noise<T> n = octave(T(frequency) * p, i);
      const T weight = T(amplitude) * visibility;
      sum.value = sum.value + weight * n.value;
      sum.gradient = sum.gradient + (weight * T(frequency)) * n.gradient;
    }
    frequency *= fractal.lacunarity;
    amplitude *= fractal.gain;
  }
  return sum;
}

} // namespace detail

/// Fractal sum: sum of gain^i * basis(lacunarity^i * p).
///
/// p           sampling point of the first octave
/// fractal     uniform; octaves <= 0 gives zero; octaves at noise_extent cells a unit and above are
///             left out
/// width       size of a pixel in units of p: octaves fade out as their cells near it, so that the sum
///             stays free of aliasing. 0 leaves all octaves whole.
/// basis       vec3<T> -> Noise<T> with unit cells: perlin by default, any of the noises or one's own. If it
///             takes an int besides, that is the octave's number i.
/// returns     value, and the exact gradient of this filtered function for the given width (treated as
///             constant)
/// degenerate  as the basis
/// error       that of the basis times the sum of (lacunarity * gain)^i, and 2 eps an octave of the
///             largest term
/// source      Mikkelsen 2019, section 4; Perlin 1985
template <LaneScalar T, class Basis = PerlinBasis>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> fractal_sum(vec3<T> p, Fractal<value_t<T>> fractal = {},
                                                        T width = T(value_t<T>(0)), Basis basis = {}) {
  return detail::sum_octaves(
      p, fractal, width, [&basis](vec3<T> q, int octave) { return detail::basis_at<T>(basis, q, octave); });
}

/// Turbulence: sum of gain^i * |basis(lacunarity^i * p)|.
///
/// returns     as fractal_sum. A faded octave contributes 0, not its mean: only differences count for
///             bumps.
/// kinks       where an octave is 0: the gradient of the positive side
/// parameters, degenerate, error  as fractal_sum
/// source      Perlin 1985 (gain = 1 / lacunarity)
template <LaneScalar T, class Basis = PerlinBasis>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> turbulence(vec3<T> p, Fractal<value_t<T>> fractal = {},
                                                       T width = T(value_t<T>(0)), Basis basis = {}) {
  return detail::sum_octaves(p, fractal, width, [&basis](vec3<T> q, int octave) {
    const Noise<T> n = detail::basis_at<T>(basis, q, octave);
    const T one = T(value_t<T>(1));
    return Noise<T>{abs(n.value), select(n.value < T(value_t<T>(0)), -one, one) * n.gradient};
  });
}

/// Ridges: sum of gain^i * (1 - |basis(lacunarity^i * p)|)^2, sharp crests where an octave is 0.
///
/// kinks       on the crests: the gradient of the side where the octave is positive
/// parameters, returns, degenerate, error  as turbulence
/// source      Musgrave's ridged sum without its feedback between octaves
template <LaneScalar T, class Basis = PerlinBasis>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> ridged(vec3<T> p, Fractal<value_t<T>> fractal = {},
                                                   T width = T(value_t<T>(0)), Basis basis = {}) {
  return detail::sum_octaves(p, fractal, width, [&basis](vec3<T> q, int octave) {
    const Noise<T> n = detail::basis_at<T>(basis, q, octave);
    const T one = T(value_t<T>(1));
    const T two = T(value_t<T>(2));
    const T crest = one - abs(n.value);
    return Noise<T>{crest * crest, (select(n.value < T(value_t<T>(0)), two, -two) * crest) * n.gradient};
  });
}

} // namespace surfgrad
