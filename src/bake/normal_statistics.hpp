#pragma once

#include "bake/bake.hpp"
#include "image/map.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::bake {

/// First and second moments of unit normals n. Average them component by component.
struct NormalMoments {
  vec3<double> mean{0, 0, 1}; ///< E[n]: the shorter, the more they differ
  vec2<double> square{0, 0};  ///< E[n.x^2], E[n.y^2]
  double product = 0;         ///< E[n.x n.y]
};

/// What the samples of a bake say of each texel's normals in the target's tangent frame, with mip levels down
/// to 1x1. A texel of a level holds the sums of all samples that lie in it, so that its moments are those of
/// one population, whatever layers made the normals and however they depend on each other.
class NormalStatistics {
 public:
  /// sums     pictures, summed over the samples of each texel: normals, three channels
  /// squares  n.x^2, n.y^2, n.x n.y and the number of samples
  NormalStatistics(const image::Image& sums, const image::Image& squares);

  [[nodiscard]] int level_count() const { return sums_.level_count; }
  [[nodiscard]] int width(int level) const { return sums_.width(level); }
  [[nodiscard]] int height(int level) const { return sums_.height(level); }
  /// Whether a surface lies in the texel.
  [[nodiscard]] bool covered(int level, int x, int y) const { return squares_.value(level, x, y, 3) > 0; }
  /// Of the normals in a covered texel.
  [[nodiscard]] NormalMoments moments(int level, int x, int y) const;

 private:
  image::Map sums_;
  image::Map squares_;
};

/// Composes the scene at the samples of a bake with these options, in tangent space. Samples whose frame
/// cannot be inverted are left out. Keeps 38 bytes a texel, 66 while it works.
///
/// Throws and warns as bake_bands. Same result for any number of threads.
[[nodiscard]] NormalStatistics normal_statistics(scene::Scene scene, const Options& options,
                                                 const Report& report = {});

} // namespace surfgrad::bake
