#pragma once

/// A texture sampler as one writes it without further thought of speed, but without waste either: scalar
/// floats, texels side by side, no virtual calls. The yardstick of the sampler race.

#include "lookups.hpp"
#include "slope_pyramid.hpp"

#include <cmath>

namespace surfgrad::bench {

class NaiveSampler {
 public:
  explicit NaiveSampler(const SlopePyramid& map) : levels_(map.levels) {}

  [[nodiscard]] vec2<float> bilinear(float s, float t, std::size_t level = 0) const {
    const SlopePyramid::Level& map = levels_[level];
    const Tap x = tap(s, map.size);
    const Tap y = tap(t, map.size);
    const vec2<float>* low = map.texels.data() + static_cast<std::size_t>(y.first) * map.size;
    const vec2<float>* high = map.texels.data() + static_cast<std::size_t>(y.second) * map.size;
    return mix(mix(low[x.first], low[x.second], x.fraction), mix(high[x.first], high[x.second], x.fraction),
               y.fraction);
  }

  [[nodiscard]] vec2<float> trilinear(float s, float t, float lod) const {
    const float last = static_cast<float>(levels_.size() - 1);
    const float clamped = lod < 0 ? 0 : lod > last ? last : lod;
    const auto level = static_cast<std::size_t>(clamped);
    const float fraction = clamped - static_cast<float>(level);
    if (fraction == 0) return bilinear(s, t, level);
    return mix(bilinear(s, t, level), bilinear(s, t, level + 1), fraction);
  }

  /// A footprint `anisotropy` times as long along s as along t; lod is that of its short axis.
  [[nodiscard]] vec2<float> anisotropic(float s, float t, float lod) const {
    const float length = anisotropy * std::exp2(lod) / static_cast<float>(levels_[0].size);
    vec2<float> sum{0, 0};
    for (int k = 0; k < anisotropy; ++k) {
      const float along = (static_cast<float>(k) + 0.5F) / anisotropy - 0.5F;
      sum = sum + trilinear(s + along * length, t, lod);
    }
    return (1.0F / anisotropy) * sum;
  }

 private:
  struct Tap {
    int first, second;
    float fraction;
  };
  [[nodiscard]] static Tap tap(float s, int size) {
    const float x = (s - std::floor(s)) * static_cast<float>(size) - 0.5F;
    const float low = std::floor(x);
    const int i = static_cast<int>(low);
    return {i < 0 ? size - 1 : i, i + 1 == size ? 0 : i + 1, x - low};
  }
  [[nodiscard]] static vec2<float> mix(vec2<float> a, vec2<float> b, float f) { return a + f * (b - a); }

  const std::vector<SlopePyramid::Level>& levels_;
};

} // namespace surfgrad::bench
