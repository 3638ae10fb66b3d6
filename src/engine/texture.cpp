#include "engine/texture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surfgrad::engine {
namespace {

/// s less whole periods; as it is where no number is left: beyond 2^53 of them, and of Inf and NaN.
double within(double s, double period) {
  const double rest = s - period * std::floor(s / period);
  return rest >= 0 && rest <= period ? rest : s;
}

double folded(double s, image::Wrap wrap) {
  if (wrap == image::Wrap::clamp) return s;
  return within(s, wrap == image::Wrap::mirror ? 2 : 1);
}

/// An index of a vertex modulo 2^32.
std::uint32_t index(double whole) { return static_cast<std::uint32_t>(within(whole, 0x1p32)); }

} // namespace

MapPlace<double> map_origin(const TiledMap& tiled, vec2<double> point) {
  const vec2<double> st = map_coordinate(tiled, point);
  if (!tiled.hex_turn) return {{folded(st.x, tiled.wrap.s), folded(st.y, tiled.wrap.t)}};
  const vec2<double> sides = sides_of(*tiled.map);
  const vec2<double> q = (1 / hex_edge) * (sides * st);
  // hex_tiles's vertices, and what indices a point has among them.
  const double slope = std::numbers::inv_sqrt3;
  const double i = std::floor(q.x - slope * q.y);
  const double j = std::floor(2 * slope * q.y);
  // Beyond that a vertex and its neighbour are one; such a map shows nothing that could be right.
  if (!(std::max(std::abs(i), std::abs(j)) < 0x1p50)) return {st};
  const vec2<double> vertex = hex_edge * vec2<double>{i + 0.5 * j, 0.5 * std::numbers::sqrt3 * j};
  const vec2<double> at{vertex.x / sides.x, vertex.y / sides.y};
  return {st - at,
          {lattice_start(index(i), index(j), 0), {within(vertex.x, sides.x), within(vertex.y, sides.y)}}};
}

} // namespace surfgrad::engine
