#include "image/pyramid.hpp"

#include "simd/lane.hpp"

#include "image/parallel.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace surfgrad::image {
namespace {

using Texels = std::vector<float>;

/// Texels along one axis over whose footprint one of the next lower level averages. Sides are halved and
/// rounded down, so that it is two texels long, or up to three from an odd side.
struct Footprint {
  std::size_t first;
  std::size_t count;
  std::array<double, 3> weights; // sum to 1
};

std::vector<Footprint> footprints(int from, int to) {
  std::vector<Footprint> result;
  const double scale = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double low = i * scale;
    const double high = (i + 1) * scale;
    const int first = static_cast<int>(low);
    Footprint f{static_cast<std::size_t>(first), 0, {}};
    for (int j = first; j < from && j < high && f.count < 3; ++j)
      f.weights[f.count++] = (std::min<double>(j + 1, high) - std::max<double>(j, low)) / scale;
    result.push_back(f);
  }
  return result;
}

/// Average over a footprint, in double: a sum of up to nine terms stays exact to float rounding.
void halve_row(const float* source, std::size_t row_floats, const Footprint& row,
               const std::vector<Footprint>& columns, std::size_t components, float* result) {
  for (const Footprint& column : columns)
    for (std::size_t c = 0; c < components; ++c) {
      double sum = 0;
      for (std::size_t j = 0; j < row.count; ++j)
        for (std::size_t i = 0; i < column.count; ++i)
          sum += row.weights[j] * column.weights[i] *
                 source[(row.first + j) * row_floats + (column.first + i) * components + c];
      *result++ = static_cast<float>(sum);
    }
}

/// The same where both sides are even: blocks of 2x2.
template <std::size_t components>
void halve_even_row(const float* below, const float* above, std::size_t count, float* result) {
  for (std::size_t x = 0; x < count; ++x)
    for (std::size_t c = 0; c < components; ++c) {
      const std::size_t left = 2 * x * components + c;
      const std::size_t right = left + components;
      result[x * components + c] = static_cast<float>(
          0.25 * ((double{below[left]} + below[right]) + (double{above[left]} + above[right])));
    }
}

Texels halve(const Texels& source, int width, int height, int to_width, int to_height, int components) {
  const auto n = static_cast<std::size_t>(components);
  const std::size_t row_floats = static_cast<std::size_t>(width) * n;
  const std::size_t to_floats = static_cast<std::size_t>(to_width) * n;
  Texels result(to_floats * static_cast<std::size_t>(to_height));
  if (width == 2 * to_width && height == 2 * to_height) {
    constexpr std::array even_rows{halve_even_row<1>, halve_even_row<2>, halve_even_row<3>};
    in_parallel(static_cast<std::size_t>(to_height), to_floats, [&](std::size_t y) {
      const float* below = source.data() + 2 * y * row_floats;
      even_rows[n - 1](below, below + row_floats, static_cast<std::size_t>(to_width), &result[y * to_floats]);
    });
    return result;
  }
  const auto columns = footprints(width, to_width);
  const auto rows = footprints(height, to_height);
  in_parallel(static_cast<std::size_t>(to_height), to_floats, [&](std::size_t y) {
    halve_row(source.data(), row_floats, rows[y], columns, n, &result[y * to_floats]);
  });
  return result;
}

/// Nearest integer, halves away from zero: a slope and its negative have opposite codes.
std::int32_t rounded(double v) { return static_cast<std::int32_t>(v + (v < 0 ? -0.5 : 0.5)); }

/// One row of texels and the copy of its first, as words.
void store_row(const float* texels, std::size_t width, std::size_t components, const TexelCode& code,
               std::uint32_t* words) {
  const double inverse = 1 / code.scale;
  const auto code_of = [&](std::size_t i) {
    return static_cast<std::uint32_t>(rounded(texels[i] * inverse));
  };
  for (std::size_t x = 0; x <= width; ++x) {
    const std::size_t texel = x < width ? x : 0;
    switch (code.format) {
    case TexelFormat::floats:
      for (std::size_t c = 0; c < components; ++c)
        *words++ = std::bit_cast<std::uint32_t>(texels[texel * components + c]);
      break;
    case TexelFormat::slope16:
      *words++ = (code_of(2 * texel) & 0xffffu) | code_of(2 * texel + 1) << 16;
      break;
    case TexelFormat::unorm16:
      *words++ = code_of(texel) | code_of(texel + 1 < width ? texel + 1 : 0) << 16;
      break;
    }
  }
}

void store_level(const Texels& texels, Map& map, int level) {
  const auto width = static_cast<std::size_t>(map.width(level));
  const int height = map.height(level);
  const auto components = static_cast<std::size_t>(map.components);
  in_parallel(static_cast<std::size_t>(height) + 1, width, [&](std::size_t y) {
    const std::size_t row = y < static_cast<std::size_t>(height) ? y : 0;
    store_row(texels.data() + row * width * components, width, components, {map.format, map.scale},
              map.words.data() + map.word(level, 0, static_cast<int>(y)));
  });
}

/// Largest of f over all values; the order in which they are met does not matter.
template <class F>
double largest(const std::vector<float>& values, const F& f) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, values.size(), 32768), 0.0,
      [&](const tbb::blocked_range<std::size_t>& block, double most) {
        for (std::size_t i = block.begin(); i != block.end(); ++i) most = std::max(most, f(values[i]));
        return most;
      },
      [](double a, double b) { return std::max(a, b); });
}

} // namespace

std::int64_t words_of_map(int width, int height, int texel_words) {
  std::int64_t words = 0;
  for (;;) {
    words += (std::int64_t{width} + 1) * (std::int64_t{height} + 1) * texel_words;
    if (width == 1 && height == 1) return words;
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
}

double Map::value(int level, int x, int y, int component) const {
  const std::size_t at = word(level, x, y);
  switch (format) {
  case TexelFormat::slope16:
    return scale * static_cast<std::int16_t>(words[at] >> (16 * component));
  case TexelFormat::unorm16:
    return scale * static_cast<std::uint16_t>(words[at]);
  case TexelFormat::floats:
    break;
  }
  return std::bit_cast<float>(words[at + static_cast<std::size_t>(component)]);
}

TexelCode code_for_slopes(const std::vector<float>& slopes) {
  const double steepest = largest(slopes, [](float d) { return std::abs(double{d}); });
  constexpr double most_code = 32767;
  constexpr double coarsest = 0x1p-13; // rounds by half of it, 2^-14
  if (!(steepest <= most_code * coarsest)) return {};
  // Finer than 2^-40 there is nothing to be gained, and a flat map needs some scale.
  double scale = 0x1p-40;
  while (steepest > most_code * scale) scale *= 2;
  return {TexelFormat::slope16, scale};
}

TexelCode code_for_scalars(const std::vector<float>& values) {
  // A code over 65535, rounded to float, is off by at most 2^-25 * 65535 = 0.002 codes.
  const double off = largest(values, [](float v) {
    const double code = 65535.0 * v;
    const bool within = v >= 0 && v <= 1;
    return within ? std::abs(code - rounded(code)) : 1.0;
  });
  return off < 0.004 ? TexelCode{TexelFormat::unorm16, 1.0 / 65535} : TexelCode{};
}

Map with_pyramid(Texels texels, int width, int height, int components, TexelCode code) {
  assert(std::max(width, height) <= map_most_texels);
  Map map;
  map.components = components;
  map.format = code.format;
  map.scale = code.scale;
  const std::int64_t words = words_of_map(width, height, map.texel_words());
  assert(words <= std::numeric_limits<std::int32_t>::max() - words_read_ahead);
  map.words.resize(static_cast<std::size_t>(words + words_read_ahead));
  for (std::int64_t first = 0;;) {
    map.level_table.insert(map.level_table.end(),
                           {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                            static_cast<std::uint32_t>(first)});
    store_level(texels, map, map.level_count++);
    if (width == 1 && height == 1) return map;
    first += (std::int64_t{width} + 1) * (std::int64_t{height} + 1) * map.texel_words();
    const int to_width = std::max(1, width / 2);
    const int to_height = std::max(1, height / 2);
    texels = halve(texels, width, height, to_width, to_height, components);
    width = to_width;
    height = to_height;
  }
}

} // namespace surfgrad::image
