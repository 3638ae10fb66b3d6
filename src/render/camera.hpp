#pragma once

#include "scene/scene.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::render {

/// A pinhole: where it stands, where it looks and how large a pixel is.
struct Pinhole {
  vec3<double> eye;                ///< world space
  vec3<double> right, up, forward; ///< orthonormal
  double focal_px = 1;             ///< pixels per unit of tangent
  double near = 1e-3;              ///< what is nearer than this is not seen

  /// Takes positions relative to the eye to (x w, y w, unused, w) in pixels of a picture of this
  /// size, y up, w the distance along `forward`.
  [[nodiscard]] mat4<double> screen_from_relative(int width, int height) const;

  /// Takes (x, y, 1 / w, 1) in pixels back to homogeneous positions relative to the eye.
  [[nodiscard]] mat4<double> relative_from_screen(int width, int height) const;
};

/// The pinhole of a scene's camera for a picture of this size. Without a position it frames every
/// vertex of the scene, as seen from yaw and pitch.
[[nodiscard]] Pinhole place_camera(const scene::Scene& scene, int width, int height);

} // namespace surfgrad::render
