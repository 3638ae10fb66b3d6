#pragma once

/// What the samplers are asked, and the map they read, in plain arrays.

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

/// Where the map is read. All wraps repeat.
struct LookupList {
  std::vector<float> s, t;
  std::vector<float> lod; ///< between 0 and 1
};

enum class Filtering { bilinear, trilinear, anisotropic };

/// Results of a run, one entry a lookup.
struct Samples {
  explicit Samples(std::size_t count) : first(count), second(count) {}
  std::vector<float> first, second;
};

/// Anisotropic lookups stretch the footprint along s by this much.
inline constexpr int anisotropy = 8;

} // namespace surfgrad::bench
