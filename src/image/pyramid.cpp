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
#include <cstring>
#include <limits>
#include <utility>

namespace surfgrad::image {
namespace {

using Floats = UninitialisedVector<float>;

/// Floats along one axis over whose footprint one of the next lower level averages. Sides are halved and
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

/// Average over a footprint, in double: a sum of up to nine terms stays exact to float rounding. The source
/// begins with the footprint's first row.
void halve_row(const float* source, std::size_t row_floats, const Footprint& row,
               const std::vector<Footprint>& columns, std::size_t components, float* result) {
  for (const Footprint& column : columns)
    for (std::size_t c = 0; c < components; ++c) {
      double sum = 0;
      for (std::size_t j = 0; j < row.count; ++j)
        for (std::size_t i = 0; i < column.count; ++i)
          sum += row.weights[j] * column.weights[i] *
                 source[j * row_floats + (column.first + i) * components + c];
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

/// Nearest integer, halves away from zero: a slope and its negative have opposite codes.
std::int32_t rounded(double v) { return static_cast<std::int32_t>(v + (v < 0 ? -0.5 : 0.5)); }

/// One row of texels and the copy of its first, as words.
void store_row(const float* texels, std::size_t width, std::size_t components, const TexelCode& code,
               std::uint32_t* words) {
  const double inverse = 1 / code.scale;
  const auto code_of = [&](std::size_t i) {
    return static_cast<std::uint32_t>(rounded(texels[i] * inverse));
  };
  switch (code.format) {
  case TexelFormat::floats:
    std::memcpy(words, texels, width * components * sizeof(float));
    std::memcpy(words + width * components, texels, components * sizeof(float));
    break;
  case TexelFormat::slope16:
    for (std::size_t x = 0; x < width; ++x) words[x] = (code_of(2 * x) & 0xffffu) | code_of(2 * x + 1) << 16;
    words[width] = words[0];
    break;
  case TexelFormat::unorm16:
    for (std::size_t x = 0; x < width; ++x) words[x] = code_of(x) | code_of(x + 1 < width ? x + 1 : 0) << 16;
    words[width] = words[0];
    break;
  }
}

/// The texels of a level: those of level 0 are made when they are asked for, a band of rows at a time.
struct Level {
  int width;
  int height;
  std::size_t row_floats;
  const TexelRows* rows;          ///< null for those that lie in `texels`
  const RowsRead* read = nullptr; ///< of `rows`
  Floats texels{};

  /// The first of these rows, which follow each other.
  const float* band(std::size_t first, std::size_t end, Floats& scratch) const {
    if (rows == nullptr) return texels.data() + first * row_floats;
    scratch.resize((end - first) * row_floats);
    for (std::size_t y = first; y < end; ++y)
      (*rows)(static_cast<int>(y), scratch.data() + (y - first) * row_floats);
    return scratch.data();
  }
};

/// A row of a level as words, and the first one also as the copy above the last.
void store(const float* texels, std::size_t y, int level, Map& map) {
  const auto store_at = [&](int row) {
    store_row(texels, static_cast<std::size_t>(map.width(level)), static_cast<std::size_t>(map.components),
              {map.format, map.scale}, map.words.data() + map.word(level, 0, row));
  };
  store_at(static_cast<int>(y));
  if (y == 0) store_at(map.height(level));
}

// A band of about so many floats stays in the second-level cache between being made, stored and halved.
constexpr std::size_t band_floats = 32768;

/// How often both sides can be halved without a rest, up to `most`.
int even_halvings(int width, int height, int most) {
  int count = 0;
  while (count < most && width % 2 == 0 && height % 2 == 0) {
    width /= 2;
    height /= 2;
    ++count;
  }
  return count;
}

/// Level `index` of a map, yet to be filled.
Level empty_level(const Map& map, int index) {
  Level level{map.width(index), map.height(index), 0, nullptr};
  level.row_floats = static_cast<std::size_t>(level.width) * static_cast<std::size_t>(map.components);
  level.texels.resize(level.row_floats * static_cast<std::size_t>(level.height));
  return level;
}

/// Stores a level and those above it, `count` in all, which have even sides, and returns the one after them.
/// All of them are made of a band while it lies in the cache, and none of them is kept as floats.
Level store_and_halve_evenly(const Level& level, int index, int count, Map& map) {
  constexpr std::array halve_row{halve_even_row<1>, halve_even_row<2>, halve_even_row<3>, halve_even_row<4>};
  const auto halve = halve_row[static_cast<std::size_t>(map.components - 1)];
  Level last = empty_level(map, index + count);
  const std::size_t rows_a_row = std::size_t{1} << count; // of `level`, to one of the last
  const std::size_t rows = std::max<std::size_t>(1, band_floats / (level.row_floats * rows_a_row));
  const auto last_rows = static_cast<std::size_t>(last.height);
  in_parallel((last_rows + rows - 1) / rows, band_floats, [&](std::size_t band) {
    std::size_t first = band * rows * rows_a_row;
    std::size_t end = std::min(last_rows, (band + 1) * rows) * rows_a_row;
    std::size_t row_floats = level.row_floats;
    thread_local Floats made;
    thread_local std::array<Floats, 2> halved;
    const float* texels = level.band(first, end, made);
    // An odd side would have rows that two bands read: its maps keep theirs.
    if (level.read != nullptr && *level.read) (*level.read)(static_cast<int>(first), static_cast<int>(end));
    for (int i = 0; i < count; ++i) {
      for (std::size_t y = first; y < end; ++y) store(texels + (y - first) * row_floats, y, index + i, map);
      first /= 2;
      end /= 2;
      Floats& scratch = halved[static_cast<std::size_t>(i % 2)];
      if (i + 1 < count) scratch.resize((end - first) * row_floats / 2);
      float* result = i + 1 < count ? scratch.data() : last.texels.data() + first * last.row_floats;
      for (std::size_t y = 0; y < end - first; ++y)
        halve(texels + 2 * y * row_floats, texels + (2 * y + 1) * row_floats,
              static_cast<std::size_t>(map.width(index + i + 1)), result + y * row_floats / 2);
      texels = result;
      row_floats /= 2;
    }
  });
  return last;
}

/// Stores a level of any sides and returns the next.
Level store_and_halve(const Level& level, int index, Map& map) {
  Level next = empty_level(map, index + 1);
  const auto columns = footprints(level.width, next.width);
  const auto rows = footprints(level.height, next.height);
  const std::size_t band = std::max<std::size_t>(1, band_floats / (2 * level.row_floats));
  const std::size_t bands = (rows.size() + band - 1) / band;
  in_parallel(bands, band_floats, [&](std::size_t b) {
    const std::size_t first_row = b * band;
    const std::size_t end_row = std::min(rows.size(), first_row + band);
    // Footprints of an odd side share rows; of a band's rows those are its own that start below the next's.
    const std::size_t first = rows[first_row].first;
    const std::size_t end = rows[end_row - 1].first + rows[end_row - 1].count;
    const std::size_t own_end = end_row < rows.size() ? rows[end_row].first : end;
    thread_local Floats scratch;
    const float* texels = level.band(first, end, scratch);
    for (std::size_t y = first; y < own_end; ++y)
      store(texels + (y - first) * level.row_floats, y, index, map);
    for (std::size_t y = first_row; y < end_row; ++y)
      halve_row(texels + (rows[y].first - first) * level.row_floats, level.row_floats, rows[y], columns,
                static_cast<std::size_t>(map.components), next.texels.data() + y * next.row_floats);
  });
  return next;
}

/// Largest of what f(row of floats, their number) gives for the rows; in which order they are met does not
/// matter.
template <class F>
auto largest(const TexelRows& rows, int width, int height, int components, const F& f) {
  const std::size_t floats = static_cast<std::size_t>(width) * static_cast<std::size_t>(components);
  using Value = decltype(f(std::declval<const float*>(), floats));
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, height, std::max<std::size_t>(1, 32768 / floats)), Value{0},
      [&](const tbb::blocked_range<int>& block, Value most) {
        Floats row(floats);
        for (int y = block.begin(); y != block.end(); ++y) {
          rows(y, row.data());
          most = std::max(most, f(row.data(), floats));
        }
        return most;
      },
      [](Value a, Value b) { return std::max(a, b); });
}

/// The bits of a float without its sign, which order magnitudes; integers are compared many at a time.
std::int32_t steepest_bits(const float* slopes, std::size_t count) {
  std::int32_t most = 0;
  for (std::size_t i = 0; i < count; ++i)
    most = std::max(most, std::bit_cast<std::int32_t>(slopes[i]) & std::numeric_limits<std::int32_t>::max());
  return most;
}

/// How far values are from codes of 16 bits, in codes; 1 for those beyond [0, 1].
double farthest_from_codes(const float* values, std::size_t count) {
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double code = 65535.0 * values[i];
    const bool within = values[i] >= 0 && values[i] <= 1;
    most = std::max(most, within ? std::abs(code - rounded(code)) : 1.0);
  }
  return most;
}

/// Writes down where the levels of a map lie.
void add_levels(int width, int height, Map& map) {
  for (std::int64_t first = 0;;) {
    map.level_table.insert(map.level_table.end(),
                           {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                            static_cast<std::uint32_t>(first)});
    ++map.level_count;
    if (width == 1 && height == 1) return;
    first += (std::int64_t{width} + 1) * (std::int64_t{height} + 1) * map.texel_words();
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
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

TexelCode code_for_slopes(const TexelRows& slopes, int width, int height) {
  const double steepest = std::bit_cast<float>(largest(slopes, width, height, 2, steepest_bits));
  constexpr double most_code = 32767;
  constexpr double coarsest = 0x1p-13; // rounds by half of it, 2^-14
  if (!(steepest <= most_code * coarsest)) return {};
  // Finer than 2^-40 there is nothing to be gained, and a flat map needs some scale.
  double scale = 0x1p-40;
  while (steepest > most_code * scale) scale *= 2;
  return {TexelFormat::slope16, scale};
}

TexelCode code_for_scalars(const TexelRows& values, int width, int height) {
  // A code over 65535, rounded to float, is off by at most 2^-25 * 65535 = 0.002 codes.
  const double off = largest(values, width, height, 1, farthest_from_codes);
  return off < 0.004 ? TexelCode{TexelFormat::unorm16, 1.0 / 65535} : TexelCode{};
}

TexelRows rows_of(const std::vector<float>& texels, int width, int components) {
  const std::size_t floats = static_cast<std::size_t>(width) * static_cast<std::size_t>(components);
  return [&texels, floats](int y, float* row) {
    std::copy_n(texels.data() + static_cast<std::size_t>(y) * floats, floats, row);
  };
}

Map with_pyramid(const TexelRows& rows, int width, int height, int components, TexelCode code,
                 const RowsRead& read) {
  assert(std::max(width, height) <= map_most_texels);
  Map map;
  map.components = components;
  map.format = code.format;
  map.scale = code.scale;
  const std::int64_t words = words_of_map(width, height, map.texel_words());
  assert(words <= std::numeric_limits<std::int32_t>::max() - words_read_ahead);
  map.words.resize(static_cast<std::size_t>(words + words_read_ahead));
  std::fill(map.words.end() - words_read_ahead, map.words.end(), 0);
  add_levels(width, height, map);
  Level level{width, height, static_cast<std::size_t>(width) * static_cast<std::size_t>(components), &rows,
              &read};
  for (int index = 0; index + 1 < map.level_count;) {
    // Three of them: the floats of the fourth are the first to be kept, a sixty-fourth of all texels.
    const int even = even_halvings(level.width, level.height, 3);
    level = even > 0 ? store_and_halve_evenly(level, index, even, map) : store_and_halve(level, index, map);
    index += std::max(1, even);
  }
  Floats scratch;
  store(level.band(0, 1, scratch), 0, map.level_count - 1, map);
  return map;
}

} // namespace surfgrad::image
