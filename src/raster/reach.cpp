#include "raster/reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfgrad::raster {

Reach::Reach(const std::array<vec3<double>, 3>& corners, double x_most, double y_most)
    : planes_(corners), box_(planes_.box()), corners_{vec2<double>{corners[0].x, corners[0].y},
                                                      vec2<double>{corners[1].x, corners[1].y},
                                                      vec2<double>{corners[2].x, corners[2].y}} {
  if (planes_.degenerate()) return;
  const std::array<vec3<double>, 3>& e = planes_.edges();
  const std::array<double, 3> margin = planes_.margins(x_most, y_most);
  // Their sum is twice the area, whatever the point; weights are the edge functions divided by it, and wrong
  // by less than 2^-6.
  has_area_ = e[0].z + e[1].z + e[2].z > 64 * std::max({margin[0], margin[1], margin[2]});
  for (std::size_t i = 0; i < 3; ++i)
    widened_[i] = {e[i].x, e[i].y, e[i].z + 0.5 * (std::abs(e[i].x) + std::abs(e[i].y)) - margin[i]};
}

bool Reach::into_square(double x, double y) const {
  // Two convex polygons are apart where a side of one of them parts them.
  if (!(box_.x_low < x + 0.5 && x - 0.5 < box_.x_high && box_.y_low < y + 0.5 && y - 0.5 < box_.y_high))
    return false;
  return std::all_of(widened_.begin(), widened_.end(),
                     [&](const vec3<double>& e) { return e.x * x + e.y * y + e.z > 0; });
}

vec2<double> Reach::nearest(double x, double y) const {
  const vec2<double> from{x, y};
  vec2<double> best = corners_[0];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const vec2<double> a = corners_[i];
    const vec2<double> side = corners_[(i + 1) % 3] - a;
    const double t = std::clamp(dot(from - a, side) / dot(side, side), 0.0, 1.0); // with an area no side is 0
    const vec2<double> point = a + t * side;
    const vec2<double> way = point - from;
    if (const double distance2 = dot(way, way); distance2 < least) {
      least = distance2;
      best = point;
    }
  }
  return best;
}

} // namespace surfgrad::raster
