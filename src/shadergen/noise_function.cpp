#include "shadergen/noise_function.hpp"

namespace surfgrad::shadergen {
namespace {

/// The noise at a point.
std::string noise_at(const stack::NoiseFunction& function, const std::string& p) {
  switch (basis_of(function)) {
  case stack::NoiseBasis::simplex:
    return fmt::format("surfgrad_simplex({})", p);
  case stack::NoiseBasis::worley:
    return fmt::format("surfgrad_worley({}, SURFGRAD_WORLEY_KIND_{})", p,
                       function.worley == WorleyKind::f1 ? "F1" : "F2_MINUS_F1");
  case stack::NoiseBasis::perlin:
    break;
  }
  return fmt::format("surfgrad_perlin({})", p);
}

/// What a sum adds up of it; empty where the function is no sum.
std::string octave_of(const stack::NoiseFunction& function, const std::string& noise) {
  switch (function.function) {
  case stack::NoiseKind::fractal_sum:
    return noise;
  case stack::NoiseKind::turbulence:
    return fmt::format("surfgrad_turbulence_octave({})", noise);
  case stack::NoiseKind::ridged:
    return fmt::format("surfgrad_ridged_octave({})", noise);
  case stack::NoiseKind::perlin:
  case stack::NoiseKind::simplex:
  case stack::NoiseKind::worley:
    break;
  }
  return {};
}

} // namespace

std::string noise_function(Generator& g, const stack::NoiseFunction& function, const std::string& what) {
  const std::string frequency = g.parameter("frequency", "cells per unit of the space", function.frequency);
  const vec3<double> moved = function.offset;
  std::string p = "position";
  if (moved.x != 0 || moved.y != 0 || moved.z != 0)
    p = fmt::format("(position - {})", g.parameter("offset", "moves the pattern", moved));
  std::string body;
  const std::string octave = octave_of(function, noise_at(function, "frequency * p"));
  if (octave.empty()) {
    // Like an octave of a sum it fades out as its cells near the pixel.
    body = fmt::format("  float visibility = surfgrad_octave_visibility({} * width);\n"
                       "  SurfgradNoise noise = {};\n"
                       "  noise.value = visibility * noise.value;\n"
                       "  noise.gradient = visibility * noise.gradient;\n",
                       frequency, noise_at(function, "p"));
  } else {
    const std::string lacunarity =
        g.parameter("lacunarity", "frequency of an octave by that of the one before", function.lacunarity);
    const std::string gain =
        g.parameter("gain", "amplitude of an octave by that of the one before", function.gain);
    body = fmt::format("  SurfgradNoise noise;\n"
                       "  noise.value = 0.0;\n"
                       "  noise.gradient = vec3(0.0, 0.0, 0.0);\n"
                       "  float frequency = 1.0;\n"
                       "  float amplitude = 1.0;\n"
                       "  float cells = {} * width;\n"
                       "  for (int i = 0; i < {}; ++i) {{\n"
                       "    if (surfgrad_octave_visibility(frequency * cells) > 0.0 && frequency < "
                       "float(SURFGRAD_NOISE_EXTENT)) {{\n"
                       "      SurfgradNoise octave = {};\n"
                       "      noise = surfgrad_add_octave(noise, octave, frequency, amplitude, cells);\n"
                       "    }}\n"
                       "    frequency = frequency * {};\n"
                       "    amplitude = amplitude * {};\n"
                       "  }}\n",
                       frequency, function.octaves, octave, lacunarity, gain);
  }
  if (function.power != 1)
    body += fmt::format("  noise = surfgrad_power(noise, {});\n",
                        g.parameter("power", "the function is raised to it", function.power));
  return g.function(g.global() + "_" + what, fmt::format("SurfgradNoise @(vec3 position, float width) {{\n"
                                                         "  vec3 p = {} * {};\n"
                                                         "{}"
                                                         "  noise.gradient = {} * noise.gradient;\n"
                                                         "  return noise;\n"
                                                         "}}\n",
                                                         frequency, p, body, frequency));
}

} // namespace surfgrad::shadergen
