#pragma once

#include "image/image.hpp"

#include <surfgrad/vec.hpp>

#include <vector>

namespace surfgrad::bench {

/// Slopes as a mip pyramid of power-of-two squares, row 0 first; a level is the mean of 2x2 texels of the
/// one above.
struct SlopePyramid {
  struct Level {
    int size;
    std::vector<vec2<float>> texels;
  };
  std::vector<Level> levels;
};

/// Of a tangent-space normal map whose sides are the same power of two: what the peers read.
[[nodiscard]] SlopePyramid make_slope_pyramid(const image::Image& map);

} // namespace surfgrad::bench
