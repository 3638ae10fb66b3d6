#pragma once

#include "image/map.hpp"

#include <surfgrad/noise_hash.hpp>
#include <surfgrad/vec.hpp>

#include <array>
#include <bit>

namespace surfgrad::image {

/// What lies outside [0, 1] in texture coordinates.
enum class Wrap { repeat, mirror, clamp };

/// One wrap for each axis.
struct Wraps {
  Wrap s = Wrap::repeat;
  Wrap t = Wrap::repeat;
};

/// nearest and bilinear read level 0; trilinear blends the two levels around the LOD.
enum class Filter { nearest, bilinear, trilinear };

/// A word holding a float, as a scalar. A pack supplies the overload for its own bits.
template <std::floating_point T>
[[nodiscard]] inline T float_from_bits(std::uint32_t bits) {
  return static_cast<T>(std::bit_cast<float>(bits));
}

namespace detail {

using surfgrad::detail::index_constant;

/// Two neighbouring texel indices and the weight of the second.
template <class T>
struct Taps {
  index_t<T> first, second;
  T fraction;
};

/// i brought into [0, n): by one period, by one reflection or to the border. Right for -n <= i < 2 n
/// and, where n is 1, for any i. The upper limit also holds for NaN coordinates, whose index is 0.
template <LaneScalar T>
[[nodiscard]] index_t<T> wrap_index(index_t<T> i, index_t<T> n, Wrap wrap) {
  const index_t<T> zero = index_constant<T>(0);
  const index_t<T> last = n - index_constant<T>(1);
  if (wrap == Wrap::repeat) {
    i = select(i < zero, index_t<T>(i + n), i);
    i = select(last < i, index_t<T>(i - n), i);
  } else if (wrap == Wrap::mirror) {
    i = select(i < zero, index_t<T>(zero - i - index_constant<T>(1)), i);
    i = select(last < i, index_t<T>(last + n - i), i);
  }
  i = select(i < zero, zero, i);
  return select(last < i, last, i);
}

/// s modulo 2, where a mirrored coordinate repeats; its image lies the wrong way round beyond 1.
template <LaneScalar T>
[[nodiscard]] T mirror_phase(T s) {
  return s - T(value_t<T>(2)) * floor(s * constant<T>(0.5));
}

template <LaneScalar T>
[[nodiscard]] T wrap_coordinate(T s, Wrap wrap) {
  const T one = T(value_t<T>(1));
  if (wrap == Wrap::repeat) return s - floor(s);
  if (wrap == Wrap::clamp) return min(max(s, T(value_t<T>(0))), one);
  const T phase = mirror_phase(s);
  return select(one < phase, T(value_t<T>(2)) - phase, phase);
}

template <LaneScalar T>
[[nodiscard]] Taps<T> linear_taps(T s, index_t<T> n, Wrap wrap) {
  const T x = wrap_coordinate(s, wrap) * T(n) - constant<T>(0.5);
  const T low = floor(x);
  const index_t<T> i = to_index(low);
  // The maximum replaces NaN, so that no coordinate turns finite texels into NaN.
  return {wrap_index<T>(i, n, wrap), wrap_index<T>(index_t<T>(i + index_constant<T>(1)), n, wrap),
          max(x - low, T(value_t<T>(0)))};
}

template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> fetch(const Map& map, index_t<T> first_word, index_t<T> texel,
                                     mask_t<T> active) {
  const index_t<T> word =
      index_t<T>(bits_t<T>(first_word) + bits_t<T>(texel) * bits_t<T>(index_constant<T>(N)));
  std::array<T, N> result;
  for (int c = 0; c < N; ++c)
    result[c] = float_from_bits<T>(gather(map.texels(), index_t<T>(word + index_constant<T>(c)), active));
  return result;
}

template <int N, class T>
[[nodiscard]] std::array<T, N> mix(const std::array<T, N>& a, const std::array<T, N>& b, T t) {
  std::array<T, N> result;
  for (int c = 0; c < N; ++c) result[c] = a[c] + t * (b[c] - a[c]);
  return result;
}

template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample_level(const Map& map, vec2<T> st, index_t<T> level, Wraps wrap,
                                            bool linear, mask_t<T> active) {
  const auto entry = [&](int k) {
    const index_t<T> row = index_t<T>(level + level + level);
    return index_t<T>(gather(map.levels(), index_t<T>(row + index_constant<T>(k)), active));
  };
  const index_t<T> width = entry(0);
  const index_t<T> height = entry(1);
  const index_t<T> first_word = entry(2);
  const auto texel = [&](index_t<T> x, index_t<T> y) {
    const index_t<T> row = index_t<T>(bits_t<T>(y) * bits_t<T>(width));
    return fetch<N, T>(map, first_word, index_t<T>(row + x), active);
  };
  if (!linear) {
    const auto nearest = [&](T s, index_t<T> n, Wrap w) {
      return wrap_index<T>(to_index(floor(wrap_coordinate(s, w) * T(n))), n, w);
    };
    return texel(nearest(st.x, width, wrap.s), nearest(st.y, height, wrap.t));
  }
  const Taps<T> x = linear_taps<T>(st.x, width, wrap.s);
  const Taps<T> y = linear_taps<T>(st.y, height, wrap.t);
  return mix<N, T>(mix<N, T>(texel(x.first, y.first), texel(x.second, y.first), x.fraction),
                   mix<N, T>(texel(x.first, y.second), texel(x.second, y.second), x.fraction), y.fraction);
}

/// Blend of the two levels around a LOD, which is clamped to the pyramid; NaN is level 0.
template <int N, LaneScalar T, class SampleLevel>
[[nodiscard]] std::array<T, N> between_levels(int level_count, T lod, mask_t<T> active,
                                              SampleLevel sample_at) {
  const T last = T(static_cast<value_t<T>>(level_count - 1));
  const T clamped = min(max(lod, T(value_t<T>(0))), last);
  const T low = floor(clamped);
  const T fraction = clamped - low;
  const index_t<T> level = to_index(low);
  const std::array<T, N> fine = sample_at(level);
  const mask_t<T> between = active & (T(value_t<T>(0)) < fraction);
  if (!any(between)) return fine;
  const index_t<T> next = select(between, index_t<T>(level + index_constant<T>(1)), level);
  return mix<N, T>(fine, sample_at(next), fraction);
}

} // namespace detail

/// The N components of a map at a texture coordinate.
///
/// st      normalised, lower-left origin; texel centres lie at (i + 0.5) / size
/// lod     mip level, clamped to the pyramid; only trilinear uses it
/// active  lanes to sample; others give 0
/// NaN     and infinite coordinates read some texel; a NaN lod reads level 0
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const Map& map, vec2<T> st, T lod, Wraps wrap, Filter filter,
                                      mask_t<T> active) {
  const index_t<T> base = detail::index_constant<T>(0);
  if (filter != Filter::trilinear)
    return detail::sample_level<N, T>(map, st, base, wrap, filter == Filter::bilinear, active);
  return detail::between_levels<N, T>(map.level_count, lod, active, [&](index_t<T> level) {
    return detail::sample_level<N, T>(map, st, level, wrap, true, active);
  });
}

} // namespace surfgrad::image
