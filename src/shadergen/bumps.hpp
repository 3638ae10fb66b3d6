#pragma once

#include "shadergen/maps.hpp"

namespace surfgrad::shadergen {

/// A function of (vec2 st, vec2 dst_dx, vec2 dst_dy) that gives the derivative along the coordinates, slopes
/// or changes of height.
struct BumpFunction {
  std::string name;
  bool tells_variance = false; ///< MapUse::tells_variance: it gives a vec3

  /// The derivative in what a call gives.
  [[nodiscard]] std::string derivative(const std::string& bump) const {
    return tells_variance ? bump + ".xy" : bump;
  }
  /// The variance in it; empty where there is none.
  [[nodiscard]] std::string variance(const std::string& bump) const {
    return tells_variance ? bump + ".z" : "";
  }
  [[nodiscard]] const char* type() const { return tells_variance ? "vec3" : "vec2"; }
};

/// A projected image of bumps (engine/bump_map.hpp).
///
/// what  names the texture after the layer: `map`, `map_x`
[[nodiscard]] BumpFunction bump_function(Generator& generator, const stack::BumpCodes& bumps,
                                         stack::Content content, const stack::FileName& file,
                                         const std::string& what);

} // namespace surfgrad::shadergen
