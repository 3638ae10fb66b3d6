#include "bake/slope_statistics.hpp"

#include "image/pyramid.hpp"

#include <algorithm>

namespace surfgrad::bake {
namespace {

/// Mip levels average sums: their ratios are those of the sums over all that lies in a texel.
image::Map levels_of(const image::Image& sums) {
  const auto rows = [&](int y, float* texels) {
    const std::size_t count = sums.index(sums.width, 0);
    const float* values = sums.texels.read(sums.index(0, y), count, texels);
    if (values != texels) std::copy_n(values, count, texels);
  };
  return image::with_pyramid(rows, sums.width, sums.height, 3);
}

} // namespace

SlopeStatistics::SlopeStatistics(const image::Image& means, const image::Image& squares)
    : means_(levels_of(means)), squares_(levels_of(squares)) {}

SlopeMoments<double> SlopeStatistics::moments(int level, int x, int y) const {
  const double share = 1 / means_.value(level, x, y, 2);
  const auto mean = [&](const image::Map& map, int component) {
    return share * map.value(level, x, y, component);
  };
  return {{mean(means_, 0), mean(means_, 1)}, {mean(squares_, 0), mean(squares_, 1)}, mean(squares_, 2)};
}

} // namespace surfgrad::bake
