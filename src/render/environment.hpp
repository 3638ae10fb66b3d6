#pragma once

#include "image/image.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::render {

/// Radiance from every direction, already blurred for one surface: by the cosine for diffuse light
/// and by the GGX lobe of one roughness for reflections.
class Environment {
 public:
  /// panorama   latitude-longitude image, y up, its middle column seen towards -z
  /// roughness  perceptual, 0 to 1: alpha = roughness^2
  Environment(const image::Image& panorama, double roughness);

  /// Irradiance / pi on a surface with this unit normal.
  [[nodiscard]] vec3<double> diffuse(vec3<double> normal) const { return look_up(diffuse_, normal); }
  /// Mean radiance around a unit mirror direction.
  [[nodiscard]] vec3<double> specular(vec3<double> mirror) const { return look_up(specular_, mirror); }

 private:
  [[nodiscard]] static vec3<double> look_up(const image::Image& panorama, vec3<double> direction);

  image::Image diffuse_;
  image::Image specular_;
};

/// The built-in sky: bright above, warm at the horizon, a dim ground.
[[nodiscard]] image::Image built_in_sky();

} // namespace surfgrad::render
