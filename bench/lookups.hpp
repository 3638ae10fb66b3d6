#pragma once

/// What the samplers of the race are asked.

#include <cstddef>
#include <vector>

namespace surfgrad::bench {

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
