#pragma once

#include "bake/bake.hpp"
#include "image/map.hpp"

#include <surfgrad/moments.hpp>

namespace surfgrad::bake {

/// What the samples of a bake say of each texel's slopes in the target's tangent frame, with mip levels down
/// to 1x1. A texel of a level holds the sums of all samples that lie in it, so that its moments are those of
/// one population, whatever layers made the slopes and however they depend on each other.
class SlopeStatistics {
 public:
  /// sums  pictures of three channels, summed over the samples of each texel: slopes along s and t and the
  /// number
  ///       of samples; squares of the slopes and their product
  SlopeStatistics(const image::Image& means, const image::Image& squares);

  [[nodiscard]] int level_count() const { return means_.level_count; }
  [[nodiscard]] int width(int level) const { return means_.width(level); }
  [[nodiscard]] int height(int level) const { return means_.height(level); }
  /// Whether a surface lies in the texel.
  [[nodiscard]] bool covered(int level, int x, int y) const { return means_.value(level, x, y, 2) > 0; }
  /// Of the slopes (n.x / n.z, n.y / n.z) of normals in a covered texel.
  [[nodiscard]] SlopeMoments<double> moments(int level, int x, int y) const;

 private:
  image::Map means_;
  image::Map squares_;
};

/// Composes the scene at the samples of a bake with these options, in tangent space. Samples whose frame
/// cannot be inverted are left out. Keeps 32 bytes a texel, 56 while it works.
///
/// Throws and warns as bake_bands. Same result for any number of threads.
[[nodiscard]] SlopeStatistics slope_statistics(scene::Scene scene, const Options& options,
                                               const Report& report = {});

} // namespace surfgrad::bake
