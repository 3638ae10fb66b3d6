#pragma once

#include "stack/map.hpp"

#include <optional>

namespace surfgrad::stack {

/// The point of view, y up. By default the camera frames the whole mesh from the direction that yaw and
/// pitch give; with `position` and `target` (always both or neither) it stands where they say and yaw,
/// pitch and zoom do not apply.
struct Camera {
  static constexpr std::string_view format_name = "camera";
  /// About the y axis: 0 looks at the side that faces +z, 90 at the side that faces +x.
  double yaw_deg = 30;
  double pitch_deg = 15; ///< -90 to 90; positive looks from above
  double zoom = 1;       ///< > 0: enlarges the image about its centre; the point of view stays
  double fov_deg = 35;   ///< vertical, > 0 and < 180, before zoom
  std::optional<vec3<double>> position{}; ///< world space
  std::optional<vec3<double>> target{};   ///< world space; differs from position

  static const Fields<Camera>& fields();
};

struct Sun {
  static constexpr std::string_view format_name = "sun";
  vec3<double> direction{0.4, 0.6, 0.7}; ///< world space, towards the sun; any length but zero
  double strength = 3;                   ///< >= 0: irradiance of a surface that faces it

  static const Fields<Sun>& fields();
};

struct Lights {
  static constexpr std::string_view format_name = "lights";
  /// Absent: the default sun, or none where an environment brings its own.
  std::optional<Sun> sun{};
  double sky = 1; ///< >= 0: multiplies the sky's (or the environment's) radiance
  /// An image of the surroundings (latitude and longitude) instead of the built-in sky.
  std::optional<FileName> environment{};

  static const Fields<Lights>& fields();
};

} // namespace surfgrad::stack
