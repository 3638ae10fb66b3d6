#pragma once

#include "engine/layers/influence.hpp"
#include "engine/noise_function.hpp"

#include <surfgrad/resolve.hpp>

#include <optional>

namespace surfgrad::engine {

/// A function of space whose value is a height over the surface.
struct VolumeNoise {
  /// Its scale is 1: neither method is linear in the gradient, so the scale below applies before them.
  Influence influence{};
  stack::NoiseFunction noise{};
  std::optional<stack::VolumeFunction> custom{}; ///< in place of noise
  double scale = 1;
  bool world = false;      ///< sampled in world space, else in object space
  bool perlin1985 = false; ///< adds the raw gradient to the normal, for comparison
};

namespace detail {

/// A gradient that kernels can transform. Slopes beyond 1e18 are vertical in any precision; up to there
/// products with a transform of magnitudes up to 1e12 stay finite in float.
template <Scalar T>
[[nodiscard]] vec3<T> limited_slope(vec3<T> g) {
  const T most = constant<T>(1e18);
  const auto limited = [most](T a) { return max(min(a, most), -most); };
  return {limited(g.x), limited(g.y), limited(g.z)};
}

} // namespace detail

/// Surface gradient of a function of space at a point, sampled at the surface's undisplaced position.
/// What is smaller than a pixel fades out; a custom function is taken as it is.
///
/// degenerate  (out) set where an object-space gradient cannot be brought to world space, its transform
///             having no inverse, and where a custom function has no gradient (NaN); the surface gradient
///             is zero there
template <LaneScalar T>
[[nodiscard]] vec3<T> surface_gradient(const VolumeNoise& layer, const Point<T>& point,
                                       mask_t<T>& degenerate) {
  const T zero = T(value_t<T>(0));
  const SpacePoint<T> at = in_space(point, layer.world);
  // The longer side of the pixel: along the shorter one the function loses detail before it must.
  const T width = max(length(at.dp_dx), length(at.dp_dy));
  const Noise<T> noise = layer.custom ? evaluate(*layer.custom, at.position, at.origin)
                                      : evaluate(layer.noise, at.position, width, at.origin);
  const vec3<T> g = noise.gradient;
  const mask_t<T> absent = !((g.x == g.x) & (g.y == g.y) & (g.z == g.z));
  const mask_t<T> lacking = lacks_space(point, layer.world);
  const mask_t<T> none = absent | lacking;
  degenerate = degenerate | none;
  const vec3<T> scaled = constant<T>(layer.scale) * select<T>(none, vec3<T>{zero, zero, zero}, g);
  const vec3<T> slope = detail::limited_slope(scaled);
  if (!layer.perlin1985) return from_gradient_in_space(point, layer.world, slope);
  const vec3<T> n = point.frame.normal;
  return from_perturbed_normal(n, n - gradient_in_world(point, layer.world, slope));
}

} // namespace surfgrad::engine
