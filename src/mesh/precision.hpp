#pragma once

#include <surfgrad/vec.hpp>

namespace surfgrad::mesh {

// Meshes are stored in float and computed with in double.

[[nodiscard]] inline vec2<double> widen(vec2<float> v) { return {v.x, v.y}; }
[[nodiscard]] inline vec3<double> widen(vec3<float> v) { return {v.x, v.y, v.z}; }

[[nodiscard]] inline vec2<float> narrow(vec2<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y)};
}
[[nodiscard]] inline vec3<float> narrow(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

} // namespace surfgrad::mesh
