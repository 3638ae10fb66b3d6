#pragma once

/// What a baked map must hold where it is the map it was made from.

#include "bake/bake.hpp"

#include <surfgrad/vec.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace surfgrad::bake::test {

/// Unit normal that a texel of a source stands for: m / |m| of three channels, z reconstructed of two.
/// None where it lies below the surface or is steeper than the slope limit.
inline std::optional<vec3<double>> normal_of_texel(const image::Image& source, bool two_channels, int x,
                                                   int y) {
  vec3<double> m{2.0 * source.at(x, y, 0) - 1, 2.0 * source.at(x, y, 1) - 1, 0};
  m.z = two_channels ? std::sqrt(std::max(0.0, 1 - m.x * m.x - m.y * m.y)) : 2.0 * source.at(x, y, 2) - 1;
  if (!(m.z > 0) || max_abs(vec2<double>{m.x, m.y}) > 128 * m.z) return std::nullopt;
  return normalize_or_zero(m);
}

inline int code16(double value) {
  return static_cast<int>(std::floor(std::clamp(value, 0.0, 1.0) * 65535 + 0.5));
}

/// Largest difference in 16-bit codes between a texel of a baked map and a unit normal.
inline int code_difference(const image::Image& baked, int x, int y, vec3<double> n) {
  const double expected[] = {n.x, n.y, n.z};
  int largest = 0;
  for (int c = 0; c < 3; ++c)
    largest = std::max(largest, std::abs(code16(baked.at(x, y, c)) - code16(0.5 * expected[c] + 0.5)));
  return largest;
}

} // namespace surfgrad::bake::test
