#pragma once

/// What filters are, in double and texel by texel: weighted texels, indices folded back by the wrap.

#include "image/pyramid.hpp"
#include "image/sampler.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace surfgrad::image::test {

using namespace surfgrad::test;

inline const std::vector<std::pair<int, int>> sizes{{1, 1}, {1, 5}, {6, 1}, {8, 8}, {7, 3}, {16, 4}};
inline constexpr Wrap wraps[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};

/// Texel that shows at index i of an endless row.
inline int folded(long long i, int n, Wrap wrap) {
  if (wrap == Wrap::clamp) return static_cast<int>(std::clamp<long long>(i, 0, n - 1));
  const long long period = wrap == Wrap::repeat ? n : 2LL * n;
  const long long m = ((i % period) + period) % period;
  return static_cast<int>(m < n ? m : period - 1 - m);
}

inline double bilinear_by_definition(const Map& map, int level, vec2<double> st, Wraps wrap, int component) {
  const double x = st.x * map.width(level) - 0.5;
  const double y = st.y * map.height(level) - 0.5;
  const auto i = static_cast<long long>(std::floor(x));
  const auto j = static_cast<long long>(std::floor(y));
  double sum = 0;
  for (const int dj : {0, 1})
    for (const int di : {0, 1}) {
      const double fx = x - std::floor(x);
      const double fy = y - std::floor(y);
      const double wx = di == 0 ? 1 - fx : fx;
      const double wy = dj == 0 ? 1 - fy : fy;
      sum += wx * wy *
             test::texel_value(map, level, folded(i + di, map.width(level), wrap.s),
                               folded(j + dj, map.height(level), wrap.t), component);
    }
  return sum;
}

/// A coordinate near the border, far from it, or on it.
inline double coordinate(test::Random& random, int n) {
  switch (random.integer(4)) {
  case 0:
    return random.uniform(-2, 3);
  case 1:
    return random.uniform(-1000, 1000);
  case 2:
    return random.integer(5) - 2; // on a border
  default:
    return (random.integer(4 * n) - n + 0.5) / n; // on a texel centre
  }
}

inline double trilinear_by_definition(const Map& map, double lod, vec2<double> st, Wraps wrap,
                                      int component) {
  const double level = std::clamp(lod, 0.0, static_cast<double>(map.level_count - 1));
  const int low = static_cast<int>(level);
  const int high = std::min(low + 1, map.level_count - 1);
  const double weight = level - low;
  return (1 - weight) * bilinear_by_definition(map, low, st, wrap, component) +
         weight * bilinear_by_definition(map, high, st, wrap, component);
}

/// A random map in each format: of slopes in both, of scalars in both, of directions.
inline std::vector<Map> maps_of_all_formats(Random& random, int width, int height) {
  const Image weights = random_image(random, width, height, 1);
  Image floats = weights;
  floats.depth = Depth::float32;
  std::vector<Map> maps;
  for (const Depth depth : {Depth::unorm8, Depth::unorm16})
    maps.push_back(
        make_slope_map(random_normal_map(random, width, height, 2, depth), NormalChannels::xyz, true).map);
  maps.push_back(make_channel_map(weights, 0));
  maps.push_back(make_channel_map(floats, 0));
  maps.push_back(make_direction_map(random_image(random, width, height, 3), true));
  return maps;
}

/// All components of a map of any kind.
template <class T>
std::vector<T> sampled(const Map& map, vec2<T> st, T lod, Wraps wrap, Filter filter, mask_t<T> active) {
  const auto all = [](const auto& components) {
    return std::vector<T>(components.begin(), components.end());
  };
  if (map.components == 1) return all(sample<1, T>(map, st, lod, wrap, filter, active));
  if (map.components == 2) return all(sample<2, T>(map, st, lod, wrap, filter, active));
  return all(sample<3, T>(map, st, lod, wrap, filter, active));
}

} // namespace surfgrad::image::test
