#include "bake/normal_statistics.hpp"

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
  return image::with_pyramid(rows, sums.width, sums.height, sums.channels);
}

} // namespace

NormalStatistics::NormalStatistics(const image::Image& sums, const image::Image& squares)
    : sums_(levels_of(sums)), squares_(levels_of(squares)) {}

NormalMoments NormalStatistics::moments(int level, int x, int y) const {
  const double share = 1 / squares_.value(level, x, y, 3);
  const auto mean = [&](const image::Map& map, int component) {
    return share * map.value(level, x, y, component);
  };
  return {{mean(sums_, 0), mean(sums_, 1), mean(sums_, 2)},
          {mean(squares_, 0), mean(squares_, 1)},
          mean(squares_, 2)};
}

} // namespace surfgrad::bake
