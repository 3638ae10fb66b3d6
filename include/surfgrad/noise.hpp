#pragma once

/// Noise as volume bump maps: values with exact gradients, for from_volume_gradient (section 2.7).
///
/// Sampling at frequency * p multiplies the gradient by frequency.

#include <surfgrad/noise_hash.hpp>
#include <surfgrad/power.hpp>

namespace surfgrad {

/// A function of space at one point.
template <class T>
struct Noise {
  T value;
  vec3<T> gradient; ///< derivatives of the value by the coordinates of the sampling point
};

namespace detail {

/// One of the 12 directions to the edges of a cube, four of them twice: chosen by the low four bits
/// (Perlin 2002).
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> edge_direction(bits_t<T> hash) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T two = T(value_t<T>(2));
  const T choice = bit_field<T>(hash, 0, 4);
  const T first = one - two * bit_field<T>(hash, 0, 1);
  const T second = one - two * bit_field<T>(hash, 1, 1);
  // `first` belongs to x or y, `second` to y, x or z.
  const mask_t<T> first_is_x = choice < constant<T>(8);
  const mask_t<T> second_is_y = choice < constant<T>(4);
  const mask_t<T> is_twelve = choice == constant<T>(12);
  const mask_t<T> is_fourteen = choice == constant<T>(14);
  const mask_t<T> second_is_x = is_twelve | is_fourteen;
  return {select(first_is_x, first, select(second_is_x, second, zero)),
          select(first_is_x, select(second_is_y, second, zero), first),
          select(second_is_y | second_is_x, zero, second)};
}

template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr Noise<T> mix(Noise<T> a, Noise<T> b, T weight) {
  return {a.value + weight * (b.value - a.value), a.gradient + weight * (b.gradient - a.gradient)};
}

} // namespace detail

/// Perlin's gradient noise of 2002 over an exchangeable hash.
///
/// p           sampling point, cell size 1
/// hash        (ix, iy, iz) -> bits, of which the low four are used. A neighbour's index is one more
///             than the cell's: a table must wrap by itself.
/// returns     value and exact gradient; the value is 0 at lattice points. |value| <= 1.0364,
///             |gradient| <= 3.75 (found by maximising over all positions and gradients). Twice
///             continuously differentiable.
/// degenerate  coordinates beyond +-noise_extent and NaN are taken as +-noise_extent: never NaN
/// error       value 32 eps, gradient 128 eps per component, at any distance from the origin: the fade's
///             terms reach 15 and cancel as t nears 1
/// source      Perlin 2002: fade 6t^5 - 15t^4 + 10t^3, 12 directions
template <LaneScalar T, class Hash>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> perlin(vec3<T> p, Hash hash) {
  const T one = T(value_t<T>(1));
  const detail::LatticeCell<T> cell = detail::lattice_cell(p);
  const index_t<T> step = detail::index_constant<T>(1);
  const index_t<T> next_x = cell.x + step;
  const index_t<T> next_y = cell.y + step;
  const index_t<T> next_z = cell.z + step;
  const vec3<T> f = cell.fraction;
  const vec3<T> g{f.x - one, f.y - one, f.z - one};
  const auto corner = [&hash](index_t<T> x, index_t<T> y, index_t<T> z, vec3<T> offset) {
    const vec3<T> direction = detail::edge_direction<T>(hash(x, y, z));
    return Noise<T>{dot(direction, offset), direction};
  };
  const auto fade = [](T t) {
    return t * t * t * (t * (t * constant<T>(6) - constant<T>(15)) + constant<T>(10));
  };
  const auto fade_slope = [one](T t) { return constant<T>(30) * t * t * (t - one) * (t - one); };
  // The weights depend on one coordinate each: a mix along an axis adds slope * difference to that
  // component only.
  const T weight_x = fade(f.x);
  const T slope_x = fade_slope(f.x);
  const auto along_x = [&](index_t<T> y, index_t<T> z, T offset_y, T offset_z) {
    const Noise<T> low = corner(cell.x, y, z, {f.x, offset_y, offset_z});
    const Noise<T> high = corner(next_x, y, z, {g.x, offset_y, offset_z});
    Noise<T> n = detail::mix(low, high, weight_x);
    n.gradient.x = n.gradient.x + slope_x * (high.value - low.value);
    return n;
  };
  const T weight_y = fade(f.y);
  const T slope_y = fade_slope(f.y);
  const auto along_y = [&](index_t<T> z, T offset_z) {
    const Noise<T> low = along_x(cell.y, z, f.y, offset_z);
    const Noise<T> high = along_x(next_y, z, g.y, offset_z);
    Noise<T> n = detail::mix(low, high, weight_y);
    n.gradient.y = n.gradient.y + slope_y * (high.value - low.value);
    return n;
  };
  const Noise<T> low = along_y(cell.z, f.z);
  const Noise<T> high = along_y(next_z, g.z);
  Noise<T> n = detail::mix(low, high, fade(f.z));
  n.gradient.z = n.gradient.z + fade_slope(f.z) * (high.value - low.value);
  return n;
}

/// Perlin's gradient noise of 2002 over lattice_hash: no period that can be seen.
///
/// p, returns, degenerate, error, source  as above
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> perlin(vec3<T> p) {
  return perlin(p, LatticeHash<T>{});
}

/// Gradient noise over the simplicial lattice: 4 corners instead of 8.
///
/// p           sampling point; the lattice has 6 simplices a unit cell
/// hash        (ix, iy, iz) -> bits, of which the low four are used, of an index of the skewed lattice: where
/// p
///             moves by integers x, y, z whose sum is 3 n, indices move by x + n, y + n, z + n
/// returns     value and exact gradient. |value| <= 1, |gradient| <= 6.97 (found by maximising over
///             all positions and gradients). Three times continuously differentiable: each corner's
///             falloff (1/2 - r^2)^4 ends at r^2 = 1/2, the distance of a corner from the far face of
///             its simplices. (The common 0.6 reaches past it and leaves jumps.)
/// degenerate  coordinates beyond +-noise_extent and NaN are taken as +-noise_extent: never NaN
/// error       value 64 eps * (1 + |p|), gradient 512 eps * (1 + |p|): the skewed lattice rounds at the
///             magnitude of p
/// source      Perlin 2001, with the 12 directions of Perlin 2002
template <LaneScalar T, class Hash>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> simplex(vec3<T> p, Hash hash) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T sixth = constant<T>(1.0 / 6.0);
  // The inverse of the largest sum of corner contributions, 0.01300716, rounded down.
  const T scale = constant<T>(76.88);
  const vec3<T> q = detail::saturate_to_lattice(p);
  const T skew = (q.x + q.y + q.z) * constant<T>(1.0 / 3.0);
  const vec3<T> cell{floor(q.x + skew), floor(q.y + skew), floor(q.z + skew)};
  const T unskew = (cell.x + cell.y + cell.z) * sixth;
  const vec3<T> d{q.x - (cell.x - unskew), q.y - (cell.y - unskew), q.z - (cell.z - unskew)};
  const index_t<T> ix = to_index(cell.x);
  const index_t<T> iy = to_index(cell.y);
  const index_t<T> iz = to_index(cell.z);
  const index_t<T> none = detail::index_constant<T>(0);
  const index_t<T> step = detail::index_constant<T>(1);

  Noise<T> sum{zero, {zero, zero, zero}};
  // The corner at (x, y, z) steps from the cell's, whose diagonal lies `back` sixths behind.
  const auto add_corner = [&](mask_t<T> x, mask_t<T> y, mask_t<T> z, T back) {
    const vec3<T> r{d.x - select(x, one, zero) + back, d.y - select(y, one, zero) + back,
                    d.z - select(z, one, zero) + back};
    const vec3<T> direction = detail::edge_direction<T>(
        hash(ix + select(x, step, none), iy + select(y, step, none), iz + select(z, step, none)));
    const T ramp = dot(direction, r);
    const T t = max(constant<T>(0.5) - dot(r, r), zero);
    const T t2 = t * t;
    const T falloff = t2 * t2;
    sum.value = sum.value + falloff * ramp;
    sum.gradient = sum.gradient + (falloff * direction - (constant<T>(8) * t2 * t * ramp) * r);
  };
  // From the first corner along the axis of the largest component, then the middle, then the least.
  const mask_t<T> x_from_y = !(d.x < d.y);
  const mask_t<T> x_from_z = !(d.x < d.z);
  const mask_t<T> y_from_z = !(d.y < d.z);
  const mask_t<T> always = zero == zero;
  add_corner(!always, !always, !always, zero);
  add_corner(x_from_y & x_from_z, (!x_from_y) & y_from_z, (!x_from_z) & (!y_from_z), sixth);
  add_corner(x_from_y | x_from_z, (!x_from_y) | y_from_z, (!x_from_z) | (!y_from_z), constant<T>(2) * sixth);
  add_corner(always, always, always, constant<T>(0.5));
  return {scale * sum.value, scale * sum.gradient};
}

/// The same over lattice_hash.
///
/// p, returns, degenerate, error, source  as above
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE Noise<T> simplex(vec3<T> p) {
  return simplex(p, LatticeHash<T>{});
}

/// A noise raised to a power: sharpens dents, g(x) = x^k.
///
/// k           uniform, normally >= 1. For smaller k the gradient grows without bound as the value
///             falls to 0.
/// returns     value^k and k * value^(k-1) * gradient
/// degenerate  where the value is not positive: zero, with zero gradient. Results beyond the scalar's range
///             saturate.
/// error       that of pow for k - 1, and 2 eps, relative
/// source      Mikkelsen 2019, section 4 (after Gritz)
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr Noise<T> power(Noise<T> noise, value_t<T> k) {
  const T less = pow(noise.value, T(k - value_t<T>(1)));
  // The slope saturates before it meets a zero component, which infinity would turn into NaN.
  const T slope = saturated(T(k) * less);
  return {saturated(noise.value * less), saturated(slope * noise.gradient)};
}

namespace detail {

/// change / run, the run being what rounding left of the wanted step; 0 where it left nothing.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T difference_quotient(T change, T run) {
  return change * reciprocal_or_zero(run);
}

} // namespace detail

/// Gradient of a function that only gives values, from 6 evaluations (central differences).
///
/// f           vec3<T> -> T
/// step        distance to each side, in units of p: about eps^(1/3) times the scale of f's detail
/// returns     gradient of f
/// degenerate  a step that vanishes beside p (rounding) gives 0 along that axis
/// error       step^2 / 6 * |third derivative| + eps * |f| / step
/// source      Gustavson
template <Scalar T, class Function>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> gradient_by_differences(Function f, vec3<T> p, value_t<T> step) {
  const T h = T(step);
  const T x1 = p.x + h, x0 = p.x - h;
  const T y1 = p.y + h, y0 = p.y - h;
  const T z1 = p.z + h, z0 = p.z - h;
  return {detail::difference_quotient(f(vec3<T>{x1, p.y, p.z}) - f(vec3<T>{x0, p.y, p.z}), x1 - x0),
          detail::difference_quotient(f(vec3<T>{p.x, y1, p.z}) - f(vec3<T>{p.x, y0, p.z}), y1 - y0),
          detail::difference_quotient(f(vec3<T>{p.x, p.y, z1}) - f(vec3<T>{p.x, p.y, z0}), z1 - z0)};
}

/// The same from 3 evaluations beside the known value at p (forward differences).
///
/// value       f(p)
/// step        about sqrt(eps) times the scale of f's detail
/// returns, degenerate  as gradient_by_differences
/// error       step / 2 * |second derivative| + 2 eps * |f| / step
/// source      Gustavson
template <Scalar T, class Function>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> gradient_by_forward_differences(Function f, vec3<T> p, T value,
                                                                           value_t<T> step) {
  const T h = T(step);
  const T x1 = p.x + h;
  const T y1 = p.y + h;
  const T z1 = p.z + h;
  return {detail::difference_quotient(f(vec3<T>{x1, p.y, p.z}) - value, x1 - p.x),
          detail::difference_quotient(f(vec3<T>{p.x, y1, p.z}) - value, y1 - p.y),
          detail::difference_quotient(f(vec3<T>{p.x, p.y, z1}) - value, z1 - p.z)};
}

} // namespace surfgrad
