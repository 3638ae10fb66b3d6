#pragma once

/// Texels of a sampled map, read without the sampler.

#include "image/map.hpp"

#include <bit>

namespace surfgrad::test {

inline float texel(const image::Map& map, int level, int x, int y, int component) {
  const auto first = map.level_table[3 * static_cast<std::size_t>(level) + 2];
  const auto index =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width(level)) + static_cast<std::size_t>(x);
  return std::bit_cast<float>(map.words[first + index * static_cast<std::size_t>(map.components) +
                                        static_cast<std::size_t>(component)]);
}

} // namespace surfgrad::test
