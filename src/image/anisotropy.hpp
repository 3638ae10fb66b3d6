#pragma once

/// Anisotropic filtering as texture units do it: trilinear probes along the longer axis of a footprint.

#include "image/sampler.hpp"

#include <surfgrad/screen.hpp>

namespace surfgrad::image {

/// Most probes a footprint may take, as texture units have it.
inline constexpr int most_anisotropy = 16;

/// A pixel's footprint on a map, made of equal probes in a row.
template <class T>
struct Footprint {
  T lod;        ///< of each probe
  vec2<T> axis; ///< over which the probes are spread, their common centre in its middle; in st
  T probes;     ///< an integer, at least 1
};

/// The footprint that a pixel's steps span: as long as the longer of them, as wide as their parallelogram is
/// across that. Its width chooses the level, its length the number of probes; where that would be too many,
/// or more than one a texel, fewer and wider ones.
///
/// dst_dx, dst_dy  steps of st from pixel to pixel
/// size            of level 0, in texels
/// most            probes, 1 to most_anisotropy. 1 has the LOD of texture_lod.
/// degenerate      a zero footprint is one probe. Of one with a component that is not finite the probes lie
///                 in one place.
template <LaneScalar T>
[[nodiscard]] Footprint<T> footprint_of(vec2<T> dst_dx, vec2<T> dst_dy, vec2<T> size, int most) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T limit = T(static_cast<value_t<T>>(most));
  const vec2<T> x = size * dst_dx;
  const vec2<T> y = size * dst_dy;
  const T scale = max(max_abs(x), max_abs(y)); // keeps the squares in range
  const T inverse = reciprocal_or_zero(scale);
  const vec2<T> u = inverse * x;
  const vec2<T> v = inverse * y;
  const T square = max(dot(u, u), dot(v, v));
  const T area = abs(u.x * v.y - u.y * v.x);
  const T length = scale * sqrt(square);
  const T least = T(std::numeric_limits<value_t<T>>::min());
  const T wanted = min(square / max(area, least), max(length, one));
  const T ratio = min(max(wanted, one), limit); // NaN becomes 1
  // A footprint is as good as N long if it is less than a 64th longer: rounding starts no further probe.
  const T probes = max(-floor(constant<T>(1.0 / 64) - ratio), one);
  const auto finite = [&](T a) { return select(a * zero == zero, a, zero); };
  const mask_t<T> longer_y = dot(u, u) < dot(v, v);
  return {texture_lod(dst_dx, dst_dy, size) - log2(ratio),
          {finite(select(longer_y, dst_dy.x, dst_dx.x)), finite(select(longer_y, dst_dy.y, dst_dx.y))},
          min(probes, limit)};
}

/// Average of what the probes of a footprint see.
///
/// active     lanes to sample; others give 0
/// sample_at  std::array<T, N>(vec2<T> offset, mask_t<T> lanes): a probe so far from the footprint's centre
template <int N, LaneScalar T, class SampleAt>
[[nodiscard]] std::array<T, N> average_of_probes(const Footprint<T>& footprint, mask_t<T> active,
                                                 const SampleAt& sample_at) {
  const T half = constant<T>(0.5);
  const T share = T(value_t<T>(1)) / footprint.probes;
  std::array<T, N> sum;
  sum.fill(T(value_t<T>(0)));
  for (int k = 0; k < most_anisotropy; ++k) {
    const mask_t<T> probing = active & (constant<T>(k) < footprint.probes);
    if (!any(probing)) break;
    const T along = constant<T>(k + 0.5) * share - half;
    const std::array<T, N> probe = sample_at(along * footprint.axis, probing);
    for (int c = 0; c < N; ++c) sum[c] = select(probing, sum[c] + probe[c], sum[c]);
  }
  for (T& component : sum) component = component * share;
  return sum;
}

/// The N components of a map over a footprint around st.
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const Map& map, vec2<T> st, const Footprint<T>& footprint, Wraps wrap,
                                      mask_t<T> active) {
  return average_of_probes<N, T>(footprint, active, [&](vec2<T> offset, mask_t<T> lanes) {
    return sample<N, T>(map, st + offset, footprint.lod, wrap, Filter::trilinear, lanes);
  });
}

} // namespace surfgrad::image
