#pragma once

#include "bake/bake.hpp"

#include <surfgrad/vec.hpp>

#include <algorithm>
#include <vector>

namespace surfgrad::bake {

/// Sums over the samples of each texel of a tile, and their means.
class SampleMeans {
 public:
  /// samples        along a side of a texel
  /// width, height  of the tile in texels
  void start(Space space, int samples, int width, int height) {
    slopes_ = space == Space::tangent;
    samples_ = samples;
    width_ = width;
    texels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {});
  }

  /// pixel     of the sample in the tile of samples, row by row
  /// normal    unit; z > 0 in tangent space
  /// singular  it only covers
  void add(int pixel, vec3<float> normal, bool singular) {
    const int row = samples_ * width_;
    const int texel = pixel / row / samples_ * width_ + pixel % row / samples_;
    Texel& t = texels_[static_cast<std::size_t>(texel)];
    t.covered = true;
    if (singular) return;
    const vec3<double> n{normal.x, normal.y, normal.z};
    if (!slopes_) {
      t.sum = t.sum + n;
      return;
    }
    const vec2<double> slope{n.x / n.z, n.y / n.z};
    t.sum = t.sum + vec3<double>{slope.x, slope.y, 1.0};
    t.squares = t.squares + vec3<double>{slope.x * slope.x, slope.y * slope.y, slope.x * slope.y};
  }
  /// In tangent space: slopes (n.x / n.z, n.y / n.z) and how many there are; their squares and product.
  [[nodiscard]] vec3<double> sum(std::size_t texel) const { return texels_[texel].sum; }
  [[nodiscard]] vec3<double> squares(std::size_t texel) const { return texels_[texel].squares; }
  [[nodiscard]] bool covered(std::size_t texel) const { return texels_[texel].covered; }
  /// Unit. (0, 0, 1) where all samples are singular or cancel out.
  [[nodiscard]] vec3<float> mean(std::size_t texel) const {
    const vec3<double> n = normalize_or_zero(texels_[texel].sum); // its length tells only how many they are
    if (max_abs(n) == 0) return {0, 0, 1};
    return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  }

 private:
  struct Texel {
    vec3<double> sum{0, 0, 0};
    vec3<double> squares{0, 0, 0};
    bool covered = false;
  };
  bool slopes_ = true;
  int samples_ = 1;
  int width_ = 0;
  std::vector<Texel> texels_{};
};

} // namespace surfgrad::bake
