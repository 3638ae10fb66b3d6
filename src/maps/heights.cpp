#include "maps/heights.hpp"

#include "image/parallel.hpp"

#include <algorithm>
#include <vector>

namespace surfgrad::maps {
namespace {

using Row = std::vector<double>;

/// Heights row by row, also those beyond the border.
class Rows {
 public:
  Rows(const image::Image& heights, Borders borders) : heights_(heights), borders_(borders) {}

  /// sum += weight * row y
  void add(int y, double weight, Row& sum) const {
    const Beyond from = beyond(y, heights_.height, borders_);
    add_inner(from.index, weight * from.texel, sum);
    add_inner(0, weight * from.first, sum);
    add_inner(heights_.height - 1, weight * from.last, sum);
  }

 private:
  void add_inner(int y, double weight, Row& sum) const {
    if (weight == 0) return;
    const auto stride = static_cast<std::size_t>(heights_.channels);
    const std::size_t count = heights_.index(heights_.width, 0);
    thread_local std::vector<float> scratch;
    scratch.resize(count);
    const float* row = heights_.texels.read(heights_.index(0, y), count, scratch.data());
    if (stride == 1)
      for (std::size_t x = 0; x < count; ++x) sum[x] += weight * row[x];
    else
      for (std::size_t x = 0; x * stride < count; ++x) sum[x] += weight * row[x * stride];
  }

  const image::Image& heights_;
  Borders borders_;
};

/// A row with `margin` texels of what lies beyond its ends.
void widen(const Row& row, int margin, Borders borders, Row& wide) {
  const int width = static_cast<int>(row.size());
  wide.resize(row.size() + 2 * static_cast<std::size_t>(margin));
  std::copy(row.begin(), row.end(), wide.begin() + margin);
  const auto put = [&](int x) {
    const Beyond from = beyond(x, width, borders);
    wide[static_cast<std::size_t>(x + margin)] = from.texel * row[static_cast<std::size_t>(from.index)] +
                                                 from.first * row.front() + from.last * row.back();
  };
  for (int i = 0; i < margin; ++i) {
    put(-1 - i);
    put(width + i);
  }
}

} // namespace

image::Image slopes_of_heights(const image::Image& heights, const Relief& relief) {
  const Weights weights = weights_of(relief.kernel);
  const int reach = static_cast<int>(weights.difference.size());
  const Rows rows(heights, relief.borders);
  const int width = heights.width;
  image::Image slopes = image::make_image(width, heights.height, 2, image::Depth::float32);
  float* const texels = slopes.texels.floats().data();
  image::in_parallel(
      static_cast<std::size_t>(heights.height), static_cast<std::size_t>(width), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        thread_local Row smooth, difference, wide;
        // Along s: rows are averaged, then differences are taken within the average.
        smooth.assign(static_cast<std::size_t>(width), 0.0);
        rows.add(y, weights.centre, smooth);
        rows.add(y - 1, weights.side, smooth);
        rows.add(y + 1, weights.side, smooth);
        widen(smooth, reach, relief.borders, wide);
        smooth.assign(static_cast<std::size_t>(width), 0.0);
        for (int n = 1; n <= reach; ++n) {
          const double weight = relief.slope_scale.x * weights.difference[static_cast<std::size_t>(n - 1)];
          const double* const before = wide.data() + reach - n;
          const double* const after = wide.data() + reach + n;
          for (int x = 0; x < width; ++x)
            smooth[static_cast<std::size_t>(x)] += weight * (after[x] - before[x]);
        }
        // Along t: the other way round.
        difference.assign(static_cast<std::size_t>(width), 0.0);
        for (int n = 1; n <= reach; ++n) {
          const double weight = relief.slope_scale.y * weights.difference[static_cast<std::size_t>(n - 1)];
          rows.add(y + n, weight, difference);
          rows.add(y - n, -weight, difference);
        }
        widen(difference, 1, relief.borders, wide);
        float* out = texels + slopes.index(0, y);
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
          *out++ = static_cast<float>(smooth[x]);
          *out++ = static_cast<float>(weights.centre * wide[x + 1] + weights.side * (wide[x] + wide[x + 2]));
        }
      });
  return slopes;
}

} // namespace surfgrad::maps
