#pragma once

#include "image/map.hpp"
#include "simd/lane.hpp"

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

/// A coordinate brought to where the map lies: for Wrap::clamp as it is. NaN stays NaN.
template <LaneScalar T>
[[nodiscard]] T folded(T s, Wrap wrap) {
  return wrap == Wrap::clamp ? s : wrap_coordinate(s, wrap);
}

/// The first of two neighbouring texels along an axis, and the weight of the second.
template <class T>
struct Tap {
  index_t<T> texel; ///< 0 to n - 1
  T fraction;       ///< 0 where the neighbour is neither texel + 1 nor, for Wrap::repeat, its copy
};

/// s is folded; n counts the texels. No NaN passes the maxima, so that no coordinate turns finite texels
/// into NaN; and as n is at most map_most_texels, no position rounds beyond the last texel.
template <LaneScalar T>
[[nodiscard]] Tap<T> linear_tap(T s, T n, Wrap wrap) {
  const T half = constant<T>(0.5);
  const T zero = T(value_t<T>(0));
  const T last = n - T(value_t<T>(1));
  if (wrap == Wrap::repeat) {
    const T x = max(s * n - half, -half);
    const T low = floor(x);
    return {whole_index(select(low < zero, last, low)), x - low};
  }
  // Beyond the centre of a border's texel its copies follow, on mirrored maps too.
  const T x = min(max(s * n - half, zero), last);
  const T low = floor(x);
  return {whole_index(low), x - low};
}

/// The texel that holds the point.
template <LaneScalar T>
[[nodiscard]] index_t<T> nearest_texel(T s, T n) {
  return to_index(min(max(s * n, T(value_t<T>(0))), n - T(value_t<T>(1))));
}

/// A level of a map; in the lanes of a pack the same or not.
template <class T>
struct Level {
  T width, height;
  bits_t<T> row_texels; ///< from a texel to the one above it
  bits_t<T> first_word;
};

template <LaneScalar T>
[[nodiscard]] Level<T> level_of(const Map& map, std::int32_t level) {
  const std::uint32_t* row = &map.level_table[3 * static_cast<std::size_t>(level)];
  // Every bit of them: words of a large map lie beyond the whole numbers that a float holds.
  const auto lanes = [](std::uint32_t v) { return surfgrad::detail::bits_constant<T>(v); };
  return {T(static_cast<value_t<T>>(row[0])), T(static_cast<value_t<T>>(row[1])), lanes(row[0] + 1),
          lanes(row[2])};
}

template <LaneScalar T>
[[nodiscard]] Level<T> levels_of(const Map& map, index_t<T> level, mask_t<T> active) {
  const auto entry = [&](int k) {
    const index_t<T> row = index_t<T>(level + level + level);
    return index_t<T>(gather(map.levels(), index_t<T>(row + index_constant<T>(k)), active));
  };
  const index_t<T> width = entry(0);
  return {T(width), T(entry(1)), bits_t<T>(index_t<T>(width + index_constant<T>(1))), bits_t<T>(entry(2))};
}

/// Word of a texel.
template <int WordsEach, LaneScalar T>
[[nodiscard]] bits_t<T> word_of(const Level<T>& level, index_t<T> x, index_t<T> y) {
  const bits_t<T> texel = bits_t<T>(y) * level.row_texels + bits_t<T>(x);
  if constexpr (WordsEach == 1) return level.first_word + texel;
  return level.first_word + texel * bits_t<T>(index_constant<T>(WordsEach));
}

/// A code without its scale. Slopes come 2^16 times as large: the code stays in the upper half, from where
/// the conversion to float takes it as exactly.
template <TexelFormat format>
inline constexpr double code_unit = format == TexelFormat::slope16 ? 65536.0 : 1.0;

/// A texel, and its neighbour to the right: codes, or floats.
template <int N, class T>
using TexelPair = std::array<std::array<T, N>, 2>;

template <LaneScalar T>
[[nodiscard]] std::array<T, 2> slope_codes(bits_t<T> word) {
  const bits_t<T> upper = bits_t<T>(index_constant<T>(-65536));
  return {T(index_t<T>(word << 16)), T(index_t<T>(word & upper))};
}

/// How texels of a format lie in words: `count` words each. `one` reads a texel, `pair` two neighbours.
template <TexelFormat format, int N>
struct Texels;

template <int N>
struct Texels<TexelFormat::floats, N> {
  static constexpr int words = N;
  template <LaneScalar T>
  static std::array<T, N> one(Words map, bits_t<T> word, mask_t<T> active) {
    std::array<T, N> result;
    for (int c = 0; c < N; ++c)
      result[c] =
          float_from_bits<T>(gather(map, index_t<T>(index_t<T>(word) + index_constant<T>(c)), active));
    return result;
  }
  template <LaneScalar T>
  static TexelPair<N, T> pair(Words map, bits_t<T> word, mask_t<T> active) {
    // Both texels are 2 N words one after the other.
    TexelPair<N, T> result;
    const auto put = [&](int first, const auto& read) {
      for (int k = 0; k < static_cast<int>(read.size()); ++k)
        result[(first + k) / N][(first + k) % N] = float_from_bits<T>(read[k]);
    };
    const auto at = [&](int k) { return index_t<T>(index_t<T>(word) + index_constant<T>(k)); };
    if constexpr (N == 1) {
      put(0, gather_words<2>(map, at(0), active));
    } else {
      put(0, gather_words<4>(map, at(0), active));
      if constexpr (N == 3) put(4, gather_words<2>(map, at(4), active));
    }
    return result;
  }
};

template <>
struct Texels<TexelFormat::slope16, 2> {
  static constexpr int words = 1;
  template <LaneScalar T>
  static std::array<T, 2> one(Words map, bits_t<T> word, mask_t<T> active) {
    return slope_codes<T>(gather(map, index_t<T>(word), active));
  }
  template <LaneScalar T>
  static TexelPair<2, T> pair(Words map, bits_t<T> word, mask_t<T> active) {
    const auto two = gather_words<2>(map, index_t<T>(word), active);
    return {slope_codes<T>(two[0]), slope_codes<T>(two[1])};
  }
};

template <>
struct Texels<TexelFormat::unorm16, 1> {
  static constexpr int words = 1;
  template <LaneScalar T>
  static std::array<T, 1> one(Words map, bits_t<T> word, mask_t<T> active) {
    return pair<T>(map, word, active)[0];
  }
  template <LaneScalar T>
  static TexelPair<1, T> pair(Words map, bits_t<T> word, mask_t<T> active) {
    const bits_t<T> both = gather(map, index_t<T>(word), active);
    const bits_t<T> lower = bits_t<T>(index_constant<T>(65535));
    return {std::array<T, 1>{T(index_t<T>(both & lower))}, std::array<T, 1>{T(index_t<T>(both >> 16))}};
  }
};

template <int N, class T>
[[nodiscard]] std::array<T, N> mix(const std::array<T, N>& a, const std::array<T, N>& b, T t) {
  std::array<T, N> result;
  for (int c = 0; c < N; ++c) result[c] = a[c] + t * (b[c] - a[c]);
  return result;
}

template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> select_each(mask_t<T> m, const std::array<T, N>& a,
                                           const std::array<T, N>& b) {
  std::array<T, N> result;
  for (int c = 0; c < N; ++c) result[c] = select(m, a[c], b[c]);
  return result;
}

/// The four texels around a folded coordinate, weighted; without the scale.
template <TexelFormat format, int N, LaneScalar T>
[[nodiscard]] std::array<T, N> filter_level(const Map& map, const Level<T>& level, vec2<T> st, Wraps wrap,
                                            mask_t<T> active) {
  using Format = Texels<format, N>;
  const Tap<T> x = linear_tap(st.x, level.width, wrap.s);
  const Tap<T> y = linear_tap(st.y, level.height, wrap.t);
  const bits_t<T> lower = word_of<Format::words, T>(level, x.texel, y.texel);
  const bits_t<T> row = word_of<Format::words, T>(
      {level.width, level.height, level.row_texels, bits_t<T>(index_constant<T>(0))}, index_constant<T>(0),
      index_constant<T>(1));
  const TexelPair<N, T> below = Format::template pair<T>(map.texels(), lower, active);
  const TexelPair<N, T> above = Format::template pair<T>(map.texels(), lower + row, active);
  return mix<N, T>(mix<N, T>(below[0], below[1], x.fraction), mix<N, T>(above[0], above[1], x.fraction),
                   y.fraction);
}

/// A LOD brought into the pyramid: the level below it and the weight of the next. NaN is level 0.
template <class T>
struct LevelBlend {
  index_t<T> level;
  T fraction;
  mask_t<T> between; ///< active lanes whose next level has a weight
};

template <LaneScalar T>
[[nodiscard]] LevelBlend<T> level_blend(int level_count, T lod, mask_t<T> active) {
  const T zero = T(value_t<T>(0));
  const T clamped = min(max(lod, zero), T(static_cast<value_t<T>>(level_count - 1)));
  const T low = floor(clamped);
  const T fraction = clamped - low;
  return {whole_index(low), fraction, mask_t<T>(active & (zero < fraction))};
}

/// The two levels around a LOD, blended. A level that has no weight in a lane is not read there.
template <int N, LaneScalar T, class SampleLevel>
[[nodiscard]] std::array<T, N> between_levels(const LevelBlend<T>& blend, const SampleLevel& sample_at) {
  const std::array<T, N> fine = sample_at(0);
  if (!any(blend.between)) return fine;
  return select_each<N, T>(blend.between, mix<N, T>(fine, sample_at(1), blend.fraction), fine);
}

template <TexelFormat format, int N, LaneScalar T>
[[nodiscard]] std::array<T, N> filtered(const Map& map, vec2<T> st, T lod, Wraps wrap, Filter filter,
                                        mask_t<T> active) {
  if (filter == Filter::nearest) {
    const Level<T> level = level_of<T>(map, 0);
    using Format = Texels<format, N>;
    const bits_t<T> word =
        word_of<Format::words, T>(level, nearest_texel(st.x, level.width), nearest_texel(st.y, level.height));
    return Format::template one<T>(map.texels(), word, active);
  }
  if (filter == Filter::bilinear)
    return filter_level<format, N, T>(map, level_of<T>(map, 0), st, wrap, active);
  const LevelBlend<T> blend = level_blend(map.level_count, lod, active);
  std::int32_t level = 0;
  if (same_in_all(blend.level, active, level))
    return between_levels<N, T>(blend, [&](int k) {
      return filter_level<format, N, T>(map, level_of<T>(map, level + k), st, wrap,
                                        k == 0 ? active : blend.between);
    });
  return between_levels<N, T>(blend, [&](int k) {
    const mask_t<T> lanes = k == 0 ? active : blend.between;
    const index_t<T> levels = index_t<T>(blend.level + index_constant<T>(k));
    return filter_level<format, N, T>(map, levels_of<T>(map, levels, lanes), st, wrap, lanes);
  });
}

template <TexelFormat format, int N, LaneScalar T>
[[nodiscard]] std::array<T, N> scaled(const Map& map, std::array<T, N> codes) {
  if constexpr (format != TexelFormat::floats)
    for (T& code : codes) code = constant<T>(map.scale / code_unit<format>) * code;
  return codes;
}

} // namespace detail

/// The N components of a map at a texture coordinate.
///
/// st      normalised, lower-left origin; texel centres lie at (i + 0.5) / size
/// lod     mip level, clamped to the pyramid; only trilinear uses it
/// active  lanes to sample; others give 0
/// NaN     and infinite coordinates read some texel; a NaN lod reads level 0
template <int N, LaneScalar T>
[[nodiscard]] std::array<T, N> sample(const Map& map, const vec2<T>& st, T lod, Wraps wrap, Filter filter,
                                      mask_t<T> active) {
  const vec2<T> at{detail::folded(st.x, wrap.s), detail::folded(st.y, wrap.t)};
  if constexpr (N == 1)
    if (map.format == TexelFormat::unorm16)
      return detail::scaled<TexelFormat::unorm16, N, T>(
          map, detail::filtered<TexelFormat::unorm16, N, T>(map, at, lod, wrap, filter, active));
  if constexpr (N == 2)
    if (map.format == TexelFormat::slope16)
      return detail::scaled<TexelFormat::slope16, N, T>(
          map, detail::filtered<TexelFormat::slope16, N, T>(map, at, lod, wrap, filter, active));
  return detail::filtered<TexelFormat::floats, N, T>(map, at, lod, wrap, filter, active);
}

} // namespace surfgrad::image
