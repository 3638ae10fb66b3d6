#pragma once

#include "engine/lattice_origin.hpp"
#include "simd/lane.hpp"
#include "stack/noise_function.hpp"
#include "stack/volume_function.hpp"

#include <surfgrad/fractal.hpp>
#include <surfgrad/worley.hpp>

#include <concepts>

namespace surfgrad::engine {

namespace detail {

/// A noise at a point of an octave, relative to the noise's origin: `at` samples it with a hash.
template <LaneScalar T, class At>
[[nodiscard]] Noise<T> from_origin(const NoiseOrigin& origin, vec3<T> p, int octave, bool skewed,
                                   const At& at) {
  const LatticeOrigin from = lattice_origin(origin, octave, skewed);
  const vec3<T> rest{constant<T>(from.rest.x), constant<T>(from.rest.y), constant<T>(from.rest.z)};
  return at(rest + p, MovedLatticeHash<T>{from.start});
}

} // namespace detail

// Noises that octaves are sums of. They take positions relative to an origin.

struct PerlinAt {
  NoiseOrigin origin{};

  template <LaneScalar T>
  [[nodiscard]] Noise<T> operator()(vec3<T> p, int octave) const {
    if (!origin.moved()) return perlin(p);
    return detail::from_origin(origin, p, octave, false,
                               [](vec3<T> q, auto hash) { return perlin(q, hash); });
  }
};

struct SimplexAt {
  NoiseOrigin origin{};

  template <LaneScalar T>
  [[nodiscard]] Noise<T> operator()(vec3<T> p, int octave) const {
    if (!origin.moved()) return simplex(p);
    return detail::from_origin(origin, p, octave, true,
                               [](vec3<T> q, auto hash) { return simplex(q, hash); });
  }
};

struct WorleyAt {
  NoiseOrigin origin{};
  WorleyKind kind = WorleyKind::f1;

  template <LaneScalar T>
  [[nodiscard]] Noise<T> operator()(vec3<T> p, int octave) const {
    if (!origin.moved()) return worley(p, kind);
    return detail::from_origin(origin, p, octave, false,
                               [this](vec3<T> q, auto hash) { return worley(q, kind, hash); });
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

} // namespace detail

/// Value and gradient of a stack's noise function.
///
/// position  in the function's space, relative to the origin
/// width     size of a pixel there: octaves fade out as their cells near it; 0 leaves all whole
/// origin    uniform: near it the function is as exact as where the space begins, however far from there
/// returns   the filtered function raised to its power, and the exact gradient of that by the position
///           for the given width. Both saturate instead of becoming infinite; never NaN.
template <LaneScalar T>
[[nodiscard]] Noise<T> evaluate(const stack::NoiseFunction& function, vec3<T> position, T width,
                                vec3<double> origin = {0, 0, 0}) {
  const T frequency = constant<T>(function.frequency);
  const NoiseOrigin from{function.frequency * (origin - function.offset), function.lacunarity};
  const vec3<T> p = frequency * position;
  const T cells_per_pixel = frequency * width;
  Noise<T> noise;
  switch (basis_of(function)) {
  case stack::NoiseBasis::perlin:
    noise = detail::sum(function, p, cells_per_pixel, PerlinAt{from});
    break;
  case stack::NoiseBasis::simplex:
    noise = detail::sum(function, p, cells_per_pixel, SimplexAt{from});
    break;
  case stack::NoiseBasis::worley:
    noise = detail::sum(function, p, cells_per_pixel, WorleyAt{from, function.worley});
    break;
  }
  if (function.power != 1) noise = power(noise, static_cast<value_t<T>>(function.power));
  return {noise.value, saturated(frequency * noise.gradient)};
}

/// Value and gradient of a program's own function. It knows one point at a time and no pixel size: lanes
/// call it one by one.
///
/// position  relative to the origin
template <LaneScalar T>
[[nodiscard]] Noise<T> evaluate(const stack::VolumeFunction& function, vec3<T> position,
                                vec3<double> origin = {0, 0, 0}) {
  using V = value_t<T>;
  const T zero = T(V(0));
  Noise<T> result{zero, {zero, zero, zero}};
  for (int i = 0; i < lane_count<T>; ++i) {
    const Noise<double> n =
        function({origin.x + double(lane(position.x, i)), origin.y + double(lane(position.y, i)),
                  origin.z + double(lane(position.z, i))});
    result.value = with_lane(result.value, i, static_cast<V>(n.value));
    result.gradient = {with_lane(result.gradient.x, i, static_cast<V>(n.gradient.x)),
                       with_lane(result.gradient.y, i, static_cast<V>(n.gradient.y)),
                       with_lane(result.gradient.z, i, static_cast<V>(n.gradient.z))};
  }
  return result;
}

} // namespace surfgrad::engine
