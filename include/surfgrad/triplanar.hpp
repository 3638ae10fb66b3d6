#pragma once

/// Triplanar and planar projection as volume bump maps (section 2.8).

#include <surfgrad/gradient.hpp>
#include <surfgrad/power.hpp>

namespace surfgrad {

enum class Handedness { left, right };
enum class TextureOrigin { lower_left, upper_left };

/// Which position components each plane samples.
enum class TriplanarPlanes {
  mikkelsen, ///< x-plane (z, y), y-plane (x, z), z-plane (x, y): listing 13
  golubev,   ///< x-plane (y, z), y-plane (z, x), z-plane (x, y): Golubev, equation 46
};

/// One value gives coordinates and gradients, so that they cannot disagree.
struct TriplanarConvention {
  /// Right-handed spaces sample the x-plane of listing 13 at -z and its y-plane at -z, so that no
  /// image appears mirrored from outside. Golubev's planes turn with the axes and need no change.
  Handedness handedness = Handedness::left;
  /// Upper-left textures are sampled at 1 - t (here: -t, the period being 1).
  TextureOrigin origin = TextureOrigin::lower_left;
  TriplanarPlanes planes = TriplanarPlanes::mikkelsen;
};

/// Texture coordinates of the three planes at one point.
template <class T>
struct TriplanarCoordinates {
  vec2<T> x_plane, y_plane, z_plane;
};

/// Axis along which a plane is projected.
enum class PlaneAxis { x, y, z };

namespace detail {

/// -1 where the convention negates a position component or the second texture coordinate.
struct TriplanarSigns {
  int z;
  int t;
};
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr TriplanarSigns signs(TriplanarConvention c) {
  const bool negate_z = c.planes == TriplanarPlanes::mikkelsen && c.handedness == Handedness::right;
  return {negate_z ? -1 : 1, c.origin == TextureOrigin::upper_left ? -1 : 1};
}

} // namespace detail

/// Blend weights from the base normal.
///
/// normal      unit base normal
/// k           sharpness, uniform, positive
/// returns     weights that sum to 1: max(0, |n| - 0.2)^k, normalised
/// degenerate  zero normal gives 1/3 each; a NaN component counts as zero. The largest term is divided
///             out before the power, so no k underflows to 0 / 0.
/// error       (5 + 4k) eps: a ratio r of two terms has rounded by 2 eps, which its power k times r^(k-1)
///             multiplies; pow adds 4 + 2 |log2(r^k)| relative, whose product with r^k stays under 5 eps
/// source      Mikkelsen 2019, listing 14
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> triplanar_weights(vec3<T> normal,
                                                                       value_t<T> k = value_t<T>(3)) {
  const T zero = T(value_t<T>(0));
  const T offset = constant<T>(0.2);
  // max gives its second operand for NaN.
  const vec3<T> w{max(abs(normal.x) - offset, zero), max(abs(normal.y) - offset, zero),
                  max(abs(normal.z) - offset, zero)};
  const T largest = max_abs(w);
  // A unit normal has a component of at least 1/sqrt(3) > 0.2; only the zero normal has none.
  const mask_t<T> none = largest == zero;
  const T inverse = reciprocal_or_zero(largest);
  const vec3<T> p{pow(w.x * inverse, T(k)), pow(w.y * inverse, T(k)), pow(w.z * inverse, T(k))};
  const T sum = select(none, T(value_t<T>(1)), p.x + p.y + p.z);
  const T third = constant<T>(1.0 / 3.0);
  return select<T>(none, vec3<T>{third, third, third}, vec3<T>{p.x / sum, p.y / sum, p.z / sum});
}

/// Texture coordinates that a convention samples at position p (in texture units).
///
/// degenerate  none; a component's NaN or Inf stays in the coordinates made of it
/// error       none: components are copied or negated
/// source      Mikkelsen 2019, section 2.8; Golubev, equation 46
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr TriplanarCoordinates<T>
triplanar_coordinates(vec3<T> p, TriplanarConvention convention = {}) {
  const detail::TriplanarSigns sign = detail::signs(convention);
  const T z = sign.z < 0 ? -p.z : p.z;
  const auto st = [&](T s, T t) { return vec2<T>{s, sign.t < 0 ? -t : t}; };
  if (convention.planes == TriplanarPlanes::golubev) return {st(p.y, p.z), st(p.z, p.x), st(p.x, p.y)};
  return {st(z, p.y), st(p.x, z), st(p.x, p.y)};
}

/// Volume gradient of one planar projection along an axis: no normal needed.
///
/// deriv       (dh/ds, dh/dt) sampled at that plane's coordinate of triplanar_coordinates
/// returns     gradient with respect to the position; the component along the axis is zero
/// degenerate  none; NaN and Inf stay in the components made of them
/// error       none: components are copied or negated
/// source      Mikkelsen 2019, section 2.8; Golubev, equations 44, 50
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> planar_gradient(PlaneAxis axis, vec2<T> deriv,
                                                                     TriplanarConvention convention = {}) {
  const T zero = T(value_t<T>(0));
  const detail::TriplanarSigns sign = detail::signs(convention);
  const T s = deriv.x;
  const T t = sign.t < 0 ? -deriv.y : deriv.y;
  const T s_of_z = sign.z < 0 ? -s : s;
  const T t_of_z = sign.z < 0 ? -t : t;
  if (axis == PlaneAxis::z) return {s, t, zero};
  if (convention.planes == TriplanarPlanes::golubev) {
    return axis == PlaneAxis::x ? vec3<T>{zero, s, t} : vec3<T>{t, zero, s};
  }
  return axis == PlaneAxis::x ? vec3<T>{zero, t, s_of_z} : vec3<T>{s, zero, t_of_z};
}

/// Volume gradient of a triplanar projection under a convention: no normal needed.
///
/// weights     triplanar_weights, constant over the neighbourhood of the point (section 2.8)
/// deriv_*     derivatives sampled at triplanar_coordinates(p, convention)
/// returns     gradient with respect to p; multiply by the texture's frequency for that of the position
/// degenerate  zero weights give zero; NaN and Inf propagate, even from a plane of weight 0
/// error       3 eps * the sum of the magnitudes of the terms
/// source      Mikkelsen 2019, listing 13; Golubev, equation 49
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> triplanar_gradient(vec3<T> weights, vec2<T> deriv_x,
                                                                        vec2<T> deriv_y, vec2<T> deriv_z,
                                                                        TriplanarConvention convention) {
  return weights.x * planar_gradient(PlaneAxis::x, deriv_x, convention) +
         weights.y * planar_gradient(PlaneAxis::y, deriv_y, convention) +
         weights.z * planar_gradient(PlaneAxis::z, deriv_z, convention);
}

/// The same under the convention of listing 13: left-handed, lower-left origin, (z,y), (x,z), (x,y).
///
/// parameters, returns, degenerate, error, source  as above
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> triplanar_gradient(vec3<T> weights, vec2<T> deriv_x,
                                                                        vec2<T> deriv_y, vec2<T> deriv_z) {
  return triplanar_gradient(weights, deriv_x, deriv_y, deriv_z, TriplanarConvention{});
}

/// Surface gradient of a triplanar projection.
///
/// normal      unit base normal: the interpolated one, or a resolved one in a later pass
/// returns     from_volume_gradient(normal, triplanar_gradient(...))
/// degenerate  as these two: zero weights give zero, a zero normal leaves the volume gradient
/// error       8 eps * (weights.x |deriv_x| + weights.y |deriv_y| + weights.z |deriv_z|)
/// source      Mikkelsen 2019, listing 13
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T>
from_triplanar(vec3<T> normal, vec3<T> weights, vec2<T> deriv_x, vec2<T> deriv_y, vec2<T> deriv_z,
               TriplanarConvention convention = {}) {
  return from_volume_gradient(normal, triplanar_gradient(weights, deriv_x, deriv_y, deriv_z, convention));
}

} // namespace surfgrad
