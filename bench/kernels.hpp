#pragma once

/// The loops that are raced on every instruction set. Each is one text, compiled once for the one-lane
/// float, for emulated lanes and for each vector unit.

#include "image/sampler.hpp"
#include "simd/dispatch.hpp"

#include <array>

namespace surfgrad::bench {

/// Floats of one pixel of the compose race, each in an array of its own: normal, dp_dx, dp_dy, three times
/// dst_dx and dst_dy, three slopes.
inline constexpr int planes_in = 3 + 3 + 3 + 3 * (2 + 2) + 3 * 2;
inline constexpr int planes_out = 3;

/// Arrays aligned to 64 bytes, as many pixels as the caller says.
struct Planes {
  std::array<const float*, planes_in> in{};
  std::array<float*, planes_out> out{};
};

enum class Stores {
  cached,    ///< results are wanted soon
  streaming, ///< results go past the caches to memory; in plain C++ the same as cached
};

/// Texture lookups and where their two components go, one array each.
struct Lookups {
  const float* s;
  const float* t;
  const float* lod;
  const float* width; ///< of the footprint's short axis, in st
  float* first;
  float* second;
};

/// Words of a map that lookups read, two neighbours at each index, and where their sums go.
struct WordPairs {
  std::array<const std::int32_t*, 4> at{};
  int count = 0; ///< of the four arrays
  float* sums = nullptr;
};

// Pixels and lookups [begin, end): both multiples of 16.
// clang-format off
SURFGRAD_DECLARE_FOR_EACH_ISA(void, compose_planes, (const Planes&, int begin, int end, Stores))
/// As many streams as compose_planes reads and writes, and one addition for each: memory alone.
SURFGRAD_DECLARE_FOR_EACH_ISA(void, sum_planes, (const Planes&, int begin, int end, Stores))
SURFGRAD_DECLARE_FOR_EACH_ISA(void, sample_map, (const image::Map&, const Lookups&, image::Filter, int begin, int end))
/// The footprint is `anisotropy` times as long along s as its width along t.
SURFGRAD_DECLARE_FOR_EACH_ISA(void, sample_anisotropic, (const image::Map&, const Lookups&, int anisotropy, int begin, int end))
/// The loads of texels that sample_map makes, and nothing else.
SURFGRAD_DECLARE_FOR_EACH_ISA(void, gather_pairs, (Words, const WordPairs&, int begin, int end))
// clang-format on

} // namespace surfgrad::bench
