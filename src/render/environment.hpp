#pragma once

#include "image/cube_map.hpp"
#include "image/image.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::render {

/// Radiance from every direction, already blurred for one surface: by the cosine for diffuse light
/// and by the GGX lobe of one roughness for reflections.
class Environment {
 public:
  /// Nothing around; must not be sampled.
  Environment() = default;
  /// panorama   latitude-longitude image, y up, its middle column seen towards -z
  /// roughness  perceptual, 0 to 1: alpha = roughness^2
  Environment(const image::Image& panorama, double roughness);

  /// Irradiance / pi on a surface with this normal, of any length but 0.
  template <LaneScalar T>
  [[nodiscard]] vec3<T> diffuse(vec3<T> normal) const {
    return look_up(diffuse_, normal);
  }
  /// Mean radiance around a mirror direction of any length but 0.
  template <LaneScalar T>
  [[nodiscard]] vec3<T> specular(vec3<T> mirror) const {
    return look_up(specular_, mirror);
  }

 private:
  /// Black in a direction that is zero or not finite.
  template <LaneScalar T>
  [[nodiscard]] static vec3<T> look_up(const image::CubeMap& light, vec3<T> direction) {
    const T finest = T(value_t<T>(0));
    return image::sample_cube<T>(light, direction, finest, finest == finest);
  }

  image::CubeMap diffuse_{};
  image::CubeMap specular_{};
};

/// The built-in sky: bright above, warm at the horizon, a dim ground.
[[nodiscard]] image::Image built_in_sky();

} // namespace surfgrad::render
