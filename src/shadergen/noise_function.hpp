#pragma once

#include "shadergen/generator.hpp"

namespace surfgrad::shadergen {

/// A stack's function of space as a function of (vec3 position, float width) that gives a SurfgradNoise; its
/// name. The layer and `what` begin the names of its parameters.
[[nodiscard]] std::string noise_function(Generator& generator, const stack::NoiseFunction& function,
                                         const std::string& what);

} // namespace surfgrad::shadergen
