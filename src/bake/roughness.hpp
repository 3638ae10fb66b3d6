#pragma once

#include "bake/bake.hpp"
#include "bake/slope_statistics.hpp"
#include "image/image.hpp"

namespace surfgrad::bake {

/// Roughness of the surface between the bumps, as glTF, Unreal and Godot keep it: its square is the alpha of
/// GGX.
class BaseRoughness {
 public:
  /// One value everywhere, within [0, 1].
  explicit BaseRoughness(double value) : value_(value) {}
  /// A map over the UV set that is baked: the green channel of three (glTF's packing), else the first.
  explicit BaseRoughness(const image::Image& map);

  /// Alpha of a texel of a map of this size. Its square is the mean over the footprint: twice the variance of
  /// slopes, which adds up as other variances do.
  [[nodiscard]] double alpha(int x, int y, int width, int height) const;

 private:
  double value_ = 0;
  image::Map squared_alphas_{};
};

/// What lost detail does to the reflection of a texel.
struct Lobe {
  double alpha_along = 0;       ///< along the direction in which slopes vary most
  double alpha_across = 0;      ///< across it
  vec2<double> direction{1, 0}; ///< that direction, unit, in the map's s and t
};

/// Widens alpha by the variance of slopes. Their covariance has the direction; along each of its axes GGX and
/// Beckmann vary by alpha^2 / 2, so that alpha'^2 = alpha^2 + 2 variance, at most 1.
///
/// source  Olano and Baker 2010, equations 3 and 4: covariance of moments; own for its use with GGX
[[nodiscard]] Lobe widened(double alpha, const SlopeMoments<double>& moments);

/// The roughness of each texel of a level: one channel, isotropic (roughness_from_moments), or, beside an
/// anisotropy_map, that across the direction. Texels where no surface lies are padded as the options say,
/// else 1.
[[nodiscard]] image::Image roughness_map(const SlopeStatistics& slopes, int level, const BaseRoughness& base,
                                         const Options& options, bool is_anisotropic);

/// Direction and strength as KHR_materials_anisotropy keeps them: (direction / 2 + 1/2, strength), where the
/// alpha along the direction is that across it, moved towards 1 by strength^2.
[[nodiscard]] image::Image anisotropy_map(const SlopeStatistics& slopes, int level, const BaseRoughness& base,
                                          const Options& options);

/// A mip level of the normal map: the mean slopes of all that lies in a texel, encoded and padded as the
/// options say.
[[nodiscard]] image::Image normal_level(const SlopeStatistics& slopes, int level, const Options& options);

} // namespace surfgrad::bake
