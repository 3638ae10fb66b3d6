#pragma once

#include "bake/bake.hpp"

#include <surfgrad/vec.hpp>

#include <vector>

namespace surfgrad::bake {

/// Where the samples of a tile lie among its texels.
struct SampleGrid {
  int samples = 1; ///< along a side of a texel
  int width = 0;   ///< of the tile in texels
  int height = 0;

  [[nodiscard]] std::size_t texel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  /// pixel  of the sample in the tile of samples, row by row
  [[nodiscard]] std::size_t texel_of(int pixel) const {
    const int row = samples * width;
    return static_cast<std::size_t>(pixel / row / samples * width + pixel % row / samples);
  }
};

/// The normal of each texel of a tile, of the mean slope of its samples in tangent space, else of their mean.
class SampleMeans {
 public:
  void start(Space space, const SampleGrid& grid) {
    slopes_ = space == Space::tangent;
    grid_ = grid;
    texels_.assign(grid.texel_count(), {});
  }

  /// normal    unit; z > 0 in tangent space
  /// singular  it only covers
  void add(int pixel, vec3<float> normal, bool singular) {
    Texel& t = texels_[grid_.texel_of(pixel)];
    t.covered = true;
    if (singular) return;
    const vec3<double> n{normal.x, normal.y, normal.z};
    t.sum = t.sum + (slopes_ ? vec3<double>{n.x / n.z, n.y / n.z, 1.0} : n);
  }
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
    bool covered = false;
  };
  bool slopes_ = true;
  SampleGrid grid_{};
  std::vector<Texel> texels_{};
};

/// The sums over the samples of each texel of a tile that NormalStatistics takes.
class SampleSums {
 public:
  static constexpr int channels = 7; ///< three of the normals, then four of their squares

  void start(const SampleGrid& grid) {
    grid_ = grid;
    texels_.assign(grid.texel_count(), {});
  }
  void add(int pixel, vec3<float> normal) {
    const vec3<double> n{normal.x, normal.y, normal.z};
    Texel& t = texels_[grid_.texel_of(pixel)];
    t.normals = t.normals + n;
    t.squares = t.squares + vec3<double>{n.x * n.x, n.y * n.y, n.x * n.y};
    ++t.count;
  }
  void put(std::size_t texel, float* to) const {
    const Texel& t = texels_[texel];
    for (const double value :
         {t.normals.x, t.normals.y, t.normals.z, t.squares.x, t.squares.y, t.squares.z, 1.0 * t.count})
      *to++ = static_cast<float>(value);
  }

 private:
  struct Texel {
    vec3<double> normals{0, 0, 0};
    vec3<double> squares{0, 0, 0};
    int count = 0;
  };
  SampleGrid grid_{};
  std::vector<Texel> texels_{};
};

} // namespace surfgrad::bake
