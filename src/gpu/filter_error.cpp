#include "gpu/filter_error.hpp"

#include "image/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace surfgrad::gpu {
namespace {

using image::Map;
using image::Wrap;
using Texel = std::array<double, 3>;

Texel difference(const Texel& a, const Texel& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double length(const Texel& a) { return std::hypot(a[0], a[1], a[2]); }
Texel mix(const Texel& a, const Texel& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}

/// A row of a level with the copy at its end.
std::vector<Texel> row_of(const Map& map, int level, int y) {
  std::vector<Texel> row(static_cast<std::size_t>(map.width(level)) + 1);
  for (std::size_t x = 0; x < row.size(); ++x)
    for (int c = 0; c < map.components; ++c)
      row[x][static_cast<std::size_t>(c)] = map.value(level, static_cast<int>(x), y, c);
  return row;
}

/// The largest of what `of_row` gives for each of so many rows.
template <class OfRow>
double largest_of_rows(int count, int texels_each, const OfRow& of_row) {
  std::vector<double> largest(static_cast<std::size_t>(count));
  image::in_parallel(largest.size(), static_cast<std::size_t>(texels_each),
                     [&](std::size_t y) { largest[y] = of_row(static_cast<int>(y)); });
  return *std::max_element(largest.begin(), largest.end());
}

/// Of the cells of a level: its edges along s and along t, the larger of each two, together.
double steepest_cell(const Map& map, int level, image::Wraps wraps) {
  const int width = map.width(level), height = map.height(level);
  const std::size_t columns = static_cast<std::size_t>(width) - (wraps.s == Wrap::repeat ? 0 : 1);
  return largest_of_rows(height, width, [&](int y) {
    const bool has_upper = wraps.t == Wrap::repeat || y + 1 < height;
    const std::vector<Texel> lower = row_of(map, level, y);
    const std::vector<Texel> upper = has_upper ? row_of(map, level, y + 1) : lower;
    double largest = 0;
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      const std::size_t right = x < columns ? x + 1 : x;
      const double along_s =
          std::max(length(difference(lower[right], lower[x])), length(difference(upper[right], upper[x])));
      const double along_t =
          std::max(length(difference(upper[x], lower[x])), length(difference(upper[right], lower[right])));
      largest = std::max(largest, along_s + along_t);
    }
    return largest;
  });
}

/// Where the texels of two levels lie along an axis.
std::vector<double> centres(int fine, int coarse) {
  std::vector<double> places;
  for (const int count : {fine, coarse})
    for (int i = 0; i < count; ++i) places.push_back((i + 0.5) / count);
  return places;
}

/// A level along a line of constant t.
class Line {
 public:
  Line(const Map& map, int level, double t, image::Wraps wraps) : wrap_(wraps.s), count_(map.width(level)) {
    const auto tap = image::detail::linear_tap(t, static_cast<double>(map.height(level)), wraps.t);
    texels_ = row_of(map, level, static_cast<int>(tap.texel));
    if (tap.fraction == 0) return;
    const std::vector<Texel> above = row_of(map, level, static_cast<int>(tap.texel) + 1);
    for (std::size_t x = 0; x < texels_.size(); ++x) texels_[x] = mix(texels_[x], above[x], tap.fraction);
  }
  [[nodiscard]] Texel at(double s) const {
    const auto tap = image::detail::linear_tap(s, static_cast<double>(count_), wrap_);
    const auto x = static_cast<std::size_t>(tap.texel);
    return mix(texels_[x], texels_[x + 1], tap.fraction);
  }

 private:
  Wrap wrap_;
  int count_;
  std::vector<Texel> texels_;
};

/// Between a level and the next, anywhere.
double largest_step(const Map& map, int level, image::Wraps wraps) {
  const std::vector<double> s = centres(map.width(level), map.width(level + 1));
  const std::vector<double> t = centres(map.height(level), map.height(level + 1));
  return largest_of_rows(static_cast<int>(t.size()), static_cast<int>(s.size()), [&](int k) {
    const Line fine(map, level, t[static_cast<std::size_t>(k)], wraps);
    const Line coarse(map, level + 1, t[static_cast<std::size_t>(k)], wraps);
    double largest = 0;
    for (const double each : s)
      largest = std::max(largest, length(difference(fine.at(each), coarse.at(each))));
    return largest;
  });
}

} // namespace

double longest_texel(const Map& map) {
  return largest_of_rows(map.height(), map.width(), [&](int y) {
    double largest = 0;
    for (const Texel& texel : row_of(map, 0, y)) largest = std::max(largest, length(texel));
    return largest;
  });
}

double filter_error(const Map& map, image::Wraps wraps, image::Filter filter, FilterPrecision precision) {
  // A fetched code is a fraction that is multiplied by the largest: to less than a code. Floats are blended
  // in float, in a few steps.
  const double rounding =
      map.format == image::TexelFormat::floats ? 0x1p-21 * longest_texel(map) : std::abs(map.scale);
  if (filter == image::Filter::nearest) return rounding;
  const int levels = filter == image::Filter::trilinear ? map.level_count : 1;
  double cell = 0, step = 0;
  for (int level = 0; level < levels; ++level) {
    // A coordinate within a period, times the number of texels, a half taken off: the engine and the device
    // round each by no more than 2^-24 of the number.
    const double rounded = 4 * 0x1p-24 * std::max(map.width(level), map.height(level));
    cell = std::max(cell, (precision.texel + rounded) * steepest_cell(map, level, wraps));
    if (level + 1 < levels) step = std::max(step, largest_step(map, level, wraps));
  }
  return cell + precision.level * step + rounding;
}

} // namespace surfgrad::gpu
