#pragma once

#include "bake/bake.hpp"
#include "bake/normal_statistics.hpp"
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

/// Alpha of an isotropic lobe that reflects like surfaces of this alpha whose unit normals have this mean:
/// sqrt(alpha^2 + 1 - |mean|^2), at most 1. Base and detail add up as variances do. 1 - |mean|^2 is that of
/// the normals, which for small slopes is var(s) + var(t). Steep slopes outweigh all others in theirs: over
/// real maps what lobes by slopes reflect is off by 6 to 11 %, by normals 3 % (specular_energy_test.cpp).
///
/// source  own; |mean| as the measure is Toksvig's (2005), the sum Olano and Baker's (2010)
[[nodiscard]] double widened_alpha(double alpha, vec3<double> mean);

/// The same with a direction.
struct Lobe {
  double alpha_along = 0;       ///< along the direction in which normals vary most
  double alpha_across = 0;      ///< across it
  vec2<double> direction{1, 0}; ///< that direction, unit, in the map's s and t
};

/// Shares the widening between the axes of the normals' covariance across their mean: the squares of both
/// alphas have the mean of widened_alpha's, as long as none of them reaches 1.
[[nodiscard]] Lobe widened(double alpha, const NormalMoments& moments);

/// The roughness of each texel of a level: one channel, isotropic (widened_alpha), or, beside an
/// anisotropy_map, that across the direction. Texels where no surface lies are padded as the options say,
/// else 1.
[[nodiscard]] image::Image roughness_map(const NormalStatistics& normals, int level,
                                         const BaseRoughness& base, const Options& options,
                                         bool is_anisotropic);

/// Direction and strength as KHR_materials_anisotropy keeps them: (direction / 2 + 1/2, strength), where the
/// alpha along the direction is that across it, moved towards 1 by strength^2.
[[nodiscard]] image::Image anisotropy_map(const NormalStatistics& normals, int level,
                                          const BaseRoughness& base, const Options& options);

/// A mip level of the normal map: the mean direction of all normals in a texel, encoded and padded as the
/// options say. Shading shows each sample alike, however steep: the mean normal has their mean diffuse light,
/// and the lobe of roughness_map lies around it.
[[nodiscard]] image::Image normal_level(const NormalStatistics& normals, int level, const Options& options);

} // namespace surfgrad::bake
