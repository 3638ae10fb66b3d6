#pragma once

#include <surfgrad/vec.hpp>

#include <optional>

namespace surfgrad::engine {

/// What does not change over the fragments of one object in one picture.
struct Placement {
  mat4<double> world_from_object{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  vec3<double> origin{0, 0, 0}; ///< world position that the fragments' positions are relative to
  /// Takes (x, y, depth, 1) in pixels to the fragments' space, before the division by w. Absent where
  /// the raster is no screen.
  std::optional<mat4<double>> relative_from_screen{};
  vec3<double> to_sun{0, 0, 0}; ///< world space, unit; zero where no sun shines

  /// Linear parts of the object's transform and of its inverse; the latter zero where there is none.
  mat3<double> linear{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mat3<double> inverse_linear{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};

/// Placement of an object, the linear parts filled in.
[[nodiscard]] Placement place(const mat4<double>& world_from_object, vec3<double> origin);

} // namespace surfgrad::engine
