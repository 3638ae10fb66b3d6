#pragma once

#include "shadergen/generator.hpp"

namespace surfgrad::shadergen {

/// Where a function of space is sampled, as expressions (engine/point.hpp).
struct SpacePoint {
  std::string position, dp_dx, dp_dy;
};

/// The footprint in object space or in world space.
[[nodiscard]] SpacePoint in_space(Generator& generator, bool world);

/// The base normal of the pass there.
[[nodiscard]] std::string normal_in_space(Generator& generator, bool world);

/// What a volume gradient there adds to the sum of the pass.
[[nodiscard]] std::string from_gradient_in_space(Generator& generator, bool world,
                                                 const std::string& gradient);

} // namespace surfgrad::shadergen
