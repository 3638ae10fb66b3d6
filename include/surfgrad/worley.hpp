#pragma once

/// Cellular noise: distances to scattered feature points.

#include <surfgrad/noise.hpp>

namespace surfgrad {

enum class WorleyKind {
  f1,          ///< distance to the nearest feature point
  f2_minus_f1, ///< excess of the distance to the second nearest: 0 on the cells' borders
};

/// Worley's cellular noise with one feature point a unit cell.
///
/// p           sampling point
/// kind        uniform
/// hash        (ix, iy, iz) -> bits, of which the low thirty are used
/// returns     value in [0, 1] and exact gradient. Distances count as 1 from 1 on: points outside the
///             3 x 3 x 3 cells searched are at least that far, so the function is continuous and not
///             an approximation. The gradient is a unit vector (f1) or the difference of two (f2_minus_f1,
///             length up to 2), a capped distance counting as constant.
/// kinks       f1 at feature points and between cells, f2_minus_f1 also where the second nearest
///             changes; where a distance reaches 1. There the gradient of one side is given, zero
///             at a feature point for its own distance.
/// degenerate  coordinates beyond +-noise_extent and NaN are taken as +-noise_extent: never NaN
/// error       value 4 eps, gradient 8 eps / distance per component, beyond the rounding of p itself
/// source      Worley 1996; feature points at multiples of 1/1024 from 10 bits of lattice_hash an axis
template <LaneScalar T, class Hash>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> worley(vec3<T> p, WorleyKind kind, Hash hash) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const detail::LatticeCell<T> cell = detail::lattice_cell(p);
  // Squared distances, and offsets from the feature points to p. Starting at the cap leaves the zero
  // offset, hence no gradient, where nothing is nearer.
  T nearest = one, second = one;
  vec3<T> from_nearest{zero, zero, zero}, from_second{zero, zero, zero};
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const bits_t<T> h = hash(cell.x + detail::index_constant<T>(x), cell.y + detail::index_constant<T>(y),
                                 cell.z + detail::index_constant<T>(z));
        const auto feature = [&](int cell_step, int first_bit) {
          return constant<T>(cell_step + 0.5 / 1024) +
                 detail::bit_field<T>(h, first_bit, 10) * constant<T>(1.0 / 1024);
        };
        const vec3<T> offset{cell.fraction.x - feature(x, 0), cell.fraction.y - feature(y, 10),
                             cell.fraction.z - feature(z, 20)};
        const T squared = dot(offset, offset);
        const mask_t<T> is_nearest = squared < nearest;
        const mask_t<T> is_second = squared < second;
        from_second = select<T>(is_nearest, from_nearest, select<T>(is_second, offset, from_second));
        second = select(is_nearest, nearest, select(is_second, squared, second));
        from_nearest = select<T>(is_nearest, offset, from_nearest);
        nearest = select(is_nearest, squared, nearest);
      }
    }
  }
  const T f1 = sqrt(nearest);
  const vec3<T> f1_gradient = reciprocal_or_zero(f1) * from_nearest;
  if (kind == WorleyKind::f1) return {f1, f1_gradient};
  const T f2 = sqrt(second);
  return {f2 - f1, reciprocal_or_zero(f2) * from_second - f1_gradient};
}

/// The same over lattice_hash.
///
/// p, kind, returns, degenerate, error, source  as above
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> worley(vec3<T> p, WorleyKind kind = WorleyKind::f1) {
  return worley(p, kind, LatticeHash<T>{});
}

} // namespace surfgrad
