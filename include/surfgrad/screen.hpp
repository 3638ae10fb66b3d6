#pragma once

/// Screen-space derivatives without differences across pixels, and the mip level they select.

#include <surfgrad/power.hpp>
#include <surfgrad/vec.hpp>

namespace surfgrad {

template <class T>
struct ScreenDerivatives {
  vec3<T> dp_dx, dp_dy;
};

template <class T>
struct TextureDerivatives {
  vec2<T> dst_dx, dst_dy;
};

/// Screen-space derivatives of the position on the tangent plane at a fragment, analytically: for
/// parallax-displaced surfaces and depth edges, where differences between pixels mean nothing.
///
/// position           of the fragment
/// normal             of the plane, any length. Where it faces away from the viewer in direction v,
///                    n - 2 dot(v, n) v may serve better (section 2.11).
/// world_from_screen  takes (x, y, depth, 1) in pixels to the space of position and normal, before
///                    the division by w
/// x, y               fragment coordinate (pixel centres at .5)
/// returns            dp_dx, dp_dy per pixel; both lie in the plane
/// degenerate         plane seen edge-on: its depth coefficient on the screen is clamped to eps of the
///                    plane's largest, which bounds the result. w = 0 gives zero; a zero normal gives
///                    the derivatives at depth 0; NaN propagates; a result beyond the scalar's range
///                    saturates. No result depends on the scale of the scene, the normal or the matrix.
/// error              16 eps * the same formulas with every term taken by magnitude, but the two
///                    divisors as they are: cancellation in the depth coefficient and in w amplifies
///                    rounding (some 1e-5 of the result in float, for a clip distance of 1 / 100 of the
///                    point's)
/// source             Mikkelsen 2019, listing 17
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE ScreenDerivatives<T>
screen_derivatives(vec3<T> position, vec3<T> normal, const mat4<T>& world_from_screen, T x, T y) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const vec3<T> n = normalize_or_zero(normal);
  const vec4<T> plane{n.x, n.y, n.z, -dot(position, n)};
  const mat4<T> columns = transpose(world_from_screen);
  // Plane in screen space: A x + B y + C z + D = 0, so z = -(A x + B y + D) / C.
  const vec4<T> on_screen = columns * plane;
  const T size = max(max(abs(on_screen.x), abs(on_screen.y)), max(abs(on_screen.z), abs(on_screen.w)));
  const T least = max(T(epsilon_v<T>) * size, T(std::numeric_limits<value_t<T>>::min()));
  const T depth_slope = select(on_screen.z < zero, -one, one) * max(least, abs(on_screen.z));
  const T ac = -(on_screen.x / depth_slope);
  const T bc = -(on_screen.y / depth_slope);
  const T dc = -(on_screen.w / depth_slope);
  const vec4<T> v0 = columns.x + ac * columns.z;
  const vec4<T> v1 = columns.y + bc * columns.z;
  const vec4<T> v2 = columns.w + dc * columns.z;
  const vec4<T> hit = x * v0 + y * v1 + v2; // homogeneous point of the plane under (x, y)
  // (f / w)' = (f' - (f / w) w') / w, with one division by w at a time: w * w may underflow.
  const T inverse_w = reciprocal_or_zero(hit.w);
  const vec3<T> p = saturated(inverse_w * vec3<T>{hit.x, hit.y, hit.z});
  return {saturated(inverse_w * (vec3<T>{v0.x, v0.y, v0.z} - v0.w * p)),
          saturated(inverse_w * (vec3<T>{v1.x, v1.y, v1.z} - v1.w * p))};
}

/// Screen-space derivatives of a projected texture coordinate from its volume gradients.
///
/// grad_s, grad_t  gradients of s and t in space, e.g. decal axes times the tiling
/// returns         dst_dx, dst_dy: right on displaced surfaces and across depth edges
/// degenerate      zero gradients or zero dp give zero; NaN and Inf propagate
/// error           1.5 eps * the sum of the magnitudes of the terms
/// source          Mikkelsen 2019, section 2.9: s and t are functions of space
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr TextureDerivatives<T>
projected_derivatives(vec3<T> grad_s, vec3<T> grad_t, vec3<T> dp_dx, vec3<T> dp_dy) {
  return {{dot(grad_s, dp_dx), dot(grad_t, dp_dx)}, {dot(grad_s, dp_dy), dot(grad_t, dp_dy)}};
}

/// Mip level of an isotropic fetch: log2 of the longer footprint axis in texels.
///
/// size        width and height of the map's level 0, in texels
/// returns     may be negative (magnification); the sampler clamps it
/// degenerate  a zero footprint gives the logarithm of the smallest normal number: level 0
/// error       4 eps * max(1, |lod|)
/// source      Mikkelsen 2019, section 3: compute it from the coordinate before a parallax correction,
///             sample with it after
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE T texture_lod(vec2<T> dst_dx, vec2<T> dst_dy, vec2<T> size) {
  const vec2<T> x = size * dst_dx;
  const vec2<T> y = size * dst_dy;
  const T square = max(dot(x, x), dot(y, y));
  const mask_t<T> usual = (T(detail::least_square<T>) < square) & (square < T(detail::most_square<T>));
  const T half = constant<T>(0.5);
  const T lod = half * log2(square);
  if (all(usual)) return lod;
  // The scale keeps the squares in range.
  const T scale = max(max_abs(x), max_abs(y));
  const T inverse = reciprocal_or_zero(scale);
  const vec2<T> u = inverse * x;
  const vec2<T> v = inverse * y;
  return select(usual, lod, log2(scale * sqrt(max(half, max(dot(u, u), dot(v, v))))));
}

} // namespace surfgrad
