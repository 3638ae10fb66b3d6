#pragma once

/// What the samplers of the race are asked.

#include <cmath>
#include <cstddef>
#include <vector>

namespace surfgrad::bench {

/// Where the map is read. All wraps repeat.
struct LookupList {
  std::vector<float> s, t;
  std::vector<float> lod;   ///< between 0 and 1
  std::vector<float> width; ///< a texel of that level, in st

  void add(float at_s, float at_t, float level, int map_size) {
    s.push_back(at_s);
    t.push_back(at_t);
    lod.push_back(level);
    width.push_back(std::exp2(level) / static_cast<float>(map_size));
  }
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
