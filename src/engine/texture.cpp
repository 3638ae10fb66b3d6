#include "engine/texture.hpp"

#include <cmath>

namespace surfgrad::engine {
namespace {

double within_period(double s, image::Wrap wrap) {
  const double period = wrap == image::Wrap::mirror ? 2 : 1;
  const double folded = s - period * std::floor(s / period);
  // Beyond 2^53 periods no fraction is left, and of infinity nothing.
  return wrap == image::Wrap::clamp || !(folded >= 0 && folded <= period) ? s : folded;
}

} // namespace

vec2<double> map_origin(const TiledMap& tiled, vec2<double> point) {
  const vec2<double> st = map_coordinate(tiled, point);
  if (tiled.hex_turn) return st;
  return {within_period(st.x, tiled.wrap.s), within_period(st.y, tiled.wrap.t)};
}

} // namespace surfgrad::engine
