#include "slope_pyramid.hpp"

#include <surfgrad/derivative.hpp>

#include <utility>

namespace surfgrad::bench {

SlopePyramid make_slope_pyramid(const image::Image& map) {
  SlopePyramid pyramid;
  pyramid.levels.push_back({map.width, {}});
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const auto decoded = [&](int channel) { return 2.0 * map.at(x, y, channel) - 1; };
      const vec2<double> d = derivative_from_normal(vec3<double>{decoded(0), decoded(1), decoded(2)});
      pyramid.levels[0].texels.push_back({static_cast<float>(d.x), static_cast<float>(d.y)});
    }
  while (pyramid.levels.back().size > 1) {
    const SlopePyramid::Level& above = pyramid.levels.back();
    SlopePyramid::Level level{above.size / 2, {}};
    for (int y = 0; y < level.size; ++y)
      for (int x = 0; x < level.size; ++x) {
        const vec2<float>* at = above.texels.data() + static_cast<std::size_t>(2 * y) * above.size + 2 * x;
        level.texels.push_back(0.25F * (at[0] + at[1] + at[above.size] + at[above.size + 1]));
      }
    pyramid.levels.push_back(std::move(level));
  }
  return pyramid;
}

} // namespace surfgrad::bench
