#pragma once

#include "simd/lane.hpp"
#include "stack/noise_function.hpp"
#include "stack/volume_function.hpp"

#include <surfgrad/fractal.hpp>
#include <surfgrad/worley.hpp>

#include <concepts>

namespace surfgrad::engine {

struct SimplexBasis {
  template <LaneScalar T>
  [[nodiscard]] Noise<T> operator()(vec3<T> p) const {
    return simplex(p);
  }
};

struct WorleyBasis {
  WorleyKind kind = WorleyKind::f1;

  template <LaneScalar T>
  [[nodiscard]] Noise<T> operator()(vec3<T> p) const {
    return worley(p, kind);
  }
};

namespace detail {

/// A noise, or a sum of its octaves, at a point in cells of the first octave. A noise alone is a sum
/// of one octave, so that it fades like one as its cells near the pixel.
template <LaneScalar T, class Basis>
[[nodiscard]] Noise<T> sum(const stack::NoiseFunction& function, vec3<T> p, T width, Basis basis) {
  using V = value_t<T>;
  const Fractal<V> fractal{function.octaves, static_cast<V>(function.lacunarity),
                           static_cast<V>(function.gain)};
  switch (function.function) {
  case stack::NoiseKind::fractal_sum:
    return fractal_sum(p, fractal, width, basis);
  case stack::NoiseKind::turbulence:
    return turbulence(p, fractal, width, basis);
  case stack::NoiseKind::ridged:
    return ridged(p, fractal, width, basis);
  case stack::NoiseKind::perlin:
  case stack::NoiseKind::simplex:
  case stack::NoiseKind::worley:
    break;
  }
  return fractal_sum(p, {1}, width, basis);
}

[[nodiscard]] inline stack::NoiseBasis basis_of(const stack::NoiseFunction& function) {
  switch (function.function) {
  case stack::NoiseKind::perlin:
    return stack::NoiseBasis::perlin;
  case stack::NoiseKind::simplex:
    return stack::NoiseBasis::simplex;
  case stack::NoiseKind::worley:
    return stack::NoiseBasis::worley;
  case stack::NoiseKind::fractal_sum:
  case stack::NoiseKind::turbulence:
  case stack::NoiseKind::ridged:
    break;
  }
  return function.basis;
}

} // namespace detail

/// Value and gradient of a stack's noise function.
///
/// position  in the function's space
/// width     size of a pixel there: octaves fade out as their cells near it; 0 leaves all whole
/// returns   the filtered function raised to its power, and the exact gradient of that by the position
///           for the given width. Both saturate instead of becoming infinite; never NaN.
template <LaneScalar T>
[[nodiscard]] Noise<T> evaluate(const stack::NoiseFunction& function, vec3<T> position, T width) {
  const T frequency = constant<T>(function.frequency);
  const vec3<T> offset{constant<T>(function.offset.x), constant<T>(function.offset.y),
                       constant<T>(function.offset.z)};
  const vec3<T> p = frequency * (position - offset);
  const T cells_per_pixel = frequency * width;
  Noise<T> noise;
  switch (detail::basis_of(function)) {
  case stack::NoiseBasis::perlin:
    noise = detail::sum(function, p, cells_per_pixel, PerlinBasis{});
    break;
  case stack::NoiseBasis::simplex:
    noise = detail::sum(function, p, cells_per_pixel, SimplexBasis{});
    break;
  case stack::NoiseBasis::worley:
    noise = detail::sum(function, p, cells_per_pixel, WorleyBasis{function.worley});
    break;
  }
  if (function.power != 1) noise = power(noise, static_cast<value_t<T>>(function.power));
  return {noise.value, saturated(frequency * noise.gradient)};
}

/// Value and gradient of a program's own function. It knows one point at a time and no pixel size: lanes
/// call it one by one.
template <LaneScalar T>
[[nodiscard]] Noise<T> evaluate(const stack::VolumeFunction& function, vec3<T> position) {
  using V = value_t<T>;
  const T zero = T(V(0));
  Noise<T> result{zero, {zero, zero, zero}};
  for (int i = 0; i < lane_count<T>; ++i) {
    const Noise<double> n =
        function({double(lane(position.x, i)), double(lane(position.y, i)), double(lane(position.z, i))});
    result.value = with_lane(result.value, i, static_cast<V>(n.value));
    result.gradient = {with_lane(result.gradient.x, i, static_cast<V>(n.gradient.x)),
                       with_lane(result.gradient.y, i, static_cast<V>(n.gradient.y)),
                       with_lane(result.gradient.z, i, static_cast<V>(n.gradient.z))};
  }
  return result;
}

} // namespace surfgrad::engine
