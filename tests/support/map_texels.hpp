#pragma once

/// Texels of a sampled map, read without the sampler.

#include "image/map.hpp"

namespace surfgrad::test {

/// As double samples it: of integer files' weights and heights not rounded to float.
inline double texel_value(const image::Map& map, int level, int x, int y, int component = 0) {
  return map.value(level, x, y, component);
}

inline float texel(const image::Map& map, int level, int x, int y, int component) {
  return static_cast<float>(texel_value(map, level, x, y, component));
}

} // namespace surfgrad::test
