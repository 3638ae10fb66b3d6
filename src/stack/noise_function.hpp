#pragma once

#include "stack/words.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::stack {

template <class T>
class Fields;

/// A function of space: f(p) = g(noise(frequency * (p - offset))), g(x) = x^power.
struct NoiseFunction {
  NoiseKind function = NoiseKind::perlin;
  NoiseBasis basis = NoiseBasis::perlin; ///< what the sums add up
  WorleyKind worley = WorleyKind::f1;    ///< where function or basis is worley
  int octaves = 4;                       ///< 1 to 16; of the sums, like the two below
  double lacunarity = 2;                 ///< frequency of an octave by that of the one before; above 1
  double gain = 0.5;                     ///< amplitude of an octave by that of the one before; 0 to 1
  double power = 1;                      ///< positive; unless 1, values below 0 count as 0
  double frequency = 1;                  ///< cells of the first octave per unit of the space; positive
  vec3<double> offset{0, 0, 0};          ///< moves the pattern, in units of the space

  static const Fields<NoiseFunction>& fields();
};

/// The noise that a function is, or is summed from.
[[nodiscard]] inline NoiseBasis basis_of(const NoiseFunction& function) {
  switch (function.function) {
  case NoiseKind::perlin:
    return NoiseBasis::perlin;
  case NoiseKind::simplex:
    return NoiseBasis::simplex;
  case NoiseKind::worley:
    return NoiseBasis::worley;
  case NoiseKind::fractal_sum:
  case NoiseKind::turbulence:
  case NoiseKind::ridged:
    break;
  }
  return function.basis;
}

} // namespace surfgrad::stack
