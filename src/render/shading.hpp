#pragma once

#include "render/environment.hpp"
#include "stack/view.hpp"

#include <surfgrad/vec.hpp>

#include <array>

namespace surfgrad::render {

/// A plain glazed surface under a sun and a sky: GGX reflection over a diffuse body. It has no
/// texture, so that all one sees is the normal.
class Shading {
 public:
  /// environment  panorama of the surroundings, or null for the built-in sky. It replaces the default
  ///              sun, too: a sun that the lights name shines all the same.
  Shading(const stack::Lights& lights, const image::Image* environment);

  /// Linear radiance towards the viewer. normal and to_viewer are unit; a normal that faces away is
  /// treated as seen edge-on. sunlight is the share of the sun that reaches the point, in [0, 1].
  [[nodiscard]] vec3<double> operator()(vec3<double> normal, vec3<double> to_viewer,
                                        double sunlight = 1) const;

  /// World space, unit; zero where no sun shines.
  [[nodiscard]] vec3<double> to_sun() const { return sun_ > 0 ? to_sun_ : vec3<double>{0, 0, 0}; }

 private:
  [[nodiscard]] vec2<double> reflectance(double cos_view) const;

  Environment environment_;
  vec3<double> to_sun_;
  double sun_ = 0;
  double sky_ = 0;
  /// Directional albedo of the GGX lobe against the cosine of the view: reflection of a white sky is
  /// f0 * x + y.
  std::array<vec2<double>, 65> albedo_{};
};

/// Linear radiance to a display code in [0, 1]: a soft shoulder, then the sRGB curve.
[[nodiscard]] double display_value(double linear);

} // namespace surfgrad::render
