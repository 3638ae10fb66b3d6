#pragma once

/// Detail that a filter takes out of a bump map, kept as roughness.
///
/// The average of slopes says how a footprint leans, not how much it varies. Their second moments, averaged
/// alike (mip levels, filters, weights that sum to 1), say that too.

#include <surfgrad/vec.hpp>

namespace surfgrad {

/// First and second moments of a slope (dh/ds, dh/dt). Average them component by component.
template <class T>
struct SlopeMoments {
  vec2<T> mean;   ///< E[dh/ds], E[dh/dt]
  vec2<T> square; ///< E[(dh/ds)^2], E[(dh/dt)^2]
  T product;      ///< E[(dh/ds) (dh/dt)]
};

/// Moments of a single slope: the start of all averages.
///
/// d           (dh/ds, dh/dt), as derivative_from_normal gives it
/// returns     {d, (d.x^2, d.y^2), d.x * d.y}
/// degenerate  none; NaN and Inf propagate
/// error       half an ulp per component
/// source      own; the moments of Olano and Baker 2010, "LEAN Mapping", without their scale
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr SlopeMoments<T> moments_from_derivative(vec2<T> d) {
  return {d, d * d, d.x * d.y};
}

/// Roughness of a footprint whose slopes have these moments, shaded with the normal of their mean.
///
/// alpha       roughness of the surface between the bumps, in [0, 1]: that of GGX or Beckmann, whose slopes
///             vary by alpha^2 / 2 along every direction
/// m           averaged moments; a bump scale multiplies the mean, and its square the others
/// returns     sqrt(alpha^2 + var(dh/ds) + var(dh/dt)), at most 1: variances add, and an isotropic alpha
///             holds the mean of those along s and t. Exact for Beckmann, the customary match for GGX.
/// degenerate  moments of one slope give alpha; negative variances, as rounding makes them, count as zero;
///             NaN counts as zero variance
/// error       2 eps * (alpha + (m.square.x + m.square.y) / returned): the variance cancels where the mean is
///             steep
/// source      own; Beckmann slope statistics as in Olano and Baker 2010, equation 3, its trace alone
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE T roughness_from_moments(T alpha, const SlopeMoments<T>& m) {
  const T zero = T(value_t<T>(0));
  const T variance =
      max(m.square.x - m.mean.x * m.mean.x, zero) + max(m.square.y - m.mean.y * m.mean.y, zero);
  return min(sqrt(alpha * alpha + variance), T(value_t<T>(1)));
}

} // namespace surfgrad
