#pragma once

#include "shadergen/generator.hpp"

namespace surfgrad::shadergen {

/// A convention of the library, as an expression.
[[nodiscard]] std::string convention_of(Generator& generator, const TriplanarConvention& convention);

/// Where a point of space lies on the three planes and the footprint there: names of
/// SurfgradTriplanarCoordinates.
struct Planes {
  std::string st, dst_dx, dst_dy;

  /// Arguments of a function of a map on a plane.
  [[nodiscard]] std::string arguments(char axis) const {
    return fmt::format("{0}.{3}_plane, {1}.{3}_plane, {2}.{3}_plane", st, dst_dx, dst_dy, axis);
  }
};
[[nodiscard]] Planes planes_of(Generator& generator, bool world, const std::string& convention);

} // namespace surfgrad::shadergen
