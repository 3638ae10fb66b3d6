#pragma once

/// Hex tiling: a map repeated without visible repetition, by blending three randomly shifted and turned
/// copies of it. A copy, or tile, belongs to each vertex of a triangle grid; it covers the hexagon of the
/// six triangles about the vertex and fades out towards their far sides.

#include <surfgrad/noise_hash.hpp>
#include <surfgrad/power.hpp>
#include <surfgrad/trigonometry.hpp>

namespace surfgrad {

/// A vertex of the grid that coordinates are relative to: near it they are exact however far away it is.
template <class V>
struct HexOrigin {
  std::uint32_t start = 0;   ///< lattice_start of its index (i, j, 0)
  vec2<V> shift{V(0), V(0)}; ///< where it lies, whole periods left out
};

/// The three tiles over a point.
template <class T>
struct HexTiles {
  vec2<T> st[3];       ///< where each tile samples the map
  T weight[3];         ///< barycentric coordinates in the triangle: within [0, 1], sum 1
  vec2<T> rotation[3]; ///< cosine and sine of each tile's turn: st[i] turns by it as st moves
};

/// v turned counter-clockwise. Turns the screen derivatives of st into those of a tile's st[i].
///
/// rotation    cosine and sine
/// degenerate  none: linear in v
/// error       eps * (|v.x| + |v.y|) for a unit rotation
/// source      own
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> rotate(vec2<T> v, vec2<T> rotation) {
  return {rotation.x * v.x - rotation.y * v.y, rotation.y * v.x + rotation.x * v.y};
}

/// The transpose of rotate: turns a derivative by a tile's st[i] into the derivative by st.
///
/// rotation    cosine and sine
/// degenerate  none: linear in v
/// error       eps * (|v.x| + |v.y|) for a unit rotation
/// source      own: the chain rule, d/dst h(R st) = transpose(R) grad h
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> rotate_back(vec2<T> v, vec2<T> rotation) {
  return {rotation.x * v.x + rotation.y * v.y, rotation.x * v.y - rotation.y * v.x};
}

/// The tiles over a texture coordinate.
///
/// st          texture coordinate in which the tiles turn; the map must wrap around
/// rotation    how far tiles are turned, uniform: 0 not at all, 1 by any angle, r within +-r / 2 turns.
///             Taken into [0, 1], NaN as 0.
/// edge        side of the triangles, uniform: a tile is 2 * edge across. With the default no tile shows a
///             point of the map twice.
/// period      of the map along each axis, uniform, positive. An image that is not square turns as a
///             picture, not sheared, where its texels are square: give its sides in units of the shorter.
/// origin      that st is relative to, uniform: the vertex edge * (i + j / 2, j * sqrt(3) / 2)
/// returns     weights that are continuous everywhere: a tile enters and leaves with weight 0. Each tile is
///             the map turned about its own centre and then moved by an offset:
///             st[i] = R_i * (st - centre_i) + centre_i + offset_i; turn and offset are functions of the
///             vertex alone, the same for every map, in steps of 2^-16 of a turn and of a period.
/// degenerate  components of st beyond +-noise_extent * edge, and NaN, are taken as that bound: never NaN. An
///             edge outside [1e-12, 1e12] is taken as 1.
/// error       weight: 4 eps * (1 + |st| / edge); st: 4 eps * (|st| + edge + |period|); rotation: 2 eps
/// source      Heitz and Neyret 2018, Mikkelsen 2022 (the method); own grid, hash and turn
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE HexTiles<T>
hex_tiles(vec2<T> st, value_t<T> rotation = value_t<T>(1), value_t<T> edge = value_t<T>(0.5),
          vec2<value_t<T>> period = {value_t<T>(1), value_t<T>(1)}, HexOrigin<value_t<T>> origin = {}) {
  using Value = value_t<T>;
  const T zero = T(Value(0));
  const T one = T(Value(1));
  const T half = constant<T>(0.5);
  const Value side = edge >= Value(1e-12) && edge <= Value(1e12) ? edge : Value(1);
  const T strength = min(max(T(rotation), zero), one);
  const T bound = T(side * static_cast<Value>(noise_extent));
  const vec2<T> p{min(max(st.x, -bound), bound), min(max(st.y, -bound), bound)};

  // The grid's vertices are side * (i * (1, 0) + j * (1/2, sqrt(3)/2)); p has these i and j.
  const vec2<T> q = T(Value(1) / side) * p;
  const T i = q.x - constant<T>(0.57735026918962576451) * q.y; // 1 / sqrt(3)
  const T j = constant<T>(1.15470053837925152902) * q.y;       // 2 / sqrt(3)
  const T low_i = floor(i);
  const T low_j = floor(j);
  const vec2<T> f{i - low_i, j - low_j};
  // The diagonal from (1, 0) to (0, 1) divides a cell into two triangles.
  const T sum = f.x + f.y;
  const mask_t<T> lower = sum < one;

  const index_t<T> cell_i = to_index(low_i);
  const index_t<T> cell_j = to_index(low_j);
  const index_t<T> none = detail::index_constant<T>(0);
  const index_t<T> step = detail::index_constant<T>(1);
  const MovedLatticeHash<T> hash{origin.start};
  const vec2<T> place = p + vec2<T>{T(origin.shift.x), T(origin.shift.y)};
  HexTiles<T> tiles;
  const auto set_tile = [&](int tile, T weight, mask_t<T> next_i, mask_t<T> next_j) {
    const index_t<T> vertex_i = cell_i + select(next_i, step, none);
    const index_t<T> vertex_j = cell_j + select(next_j, step, none);
    const bits_t<T> shift = hash(vertex_i, vertex_j, none);
    const bits_t<T> turn = hash(vertex_i, vertex_j, step);
    const T unit = constant<T>(1.0 / 65536);
    const SinCos<T> r = sin_cos_turns(strength * (unit * detail::bit_field<T>(turn, 0, 16) - half));
    // From the vertex to p.
    const T along_i = f.x - select(next_i, one, zero);
    const T along_j = f.y - select(next_j, one, zero);
    const vec2<T> d{T(side) * (along_i + half * along_j),
                    T(side) * (constant<T>(0.86602540378443864676) * along_j)}; // sqrt(3) / 2
    // R d + centre = p + (R - 1) d: the centre is not needed, and without a turn p stays what it is.
    const vec2<T> offset{T(period.x) * (unit * detail::bit_field<T>(shift, 0, 16)),
                         T(period.y) * (unit * detail::bit_field<T>(shift, 16, 16))};
    tiles.st[tile] = place + rotate(d, vec2<T>{r.cos - one, r.sin}) + offset;
    tiles.weight[tile] = weight;
    tiles.rotation[tile] = {r.cos, r.sin};
  };
  const mask_t<T> always = one == one;
  set_tile(0, select(lower, one - sum, sum - one), !lower, !lower);
  set_tile(1, select(lower, f.x, one - f.y), always, !always);
  set_tile(2, select(lower, f.y, one - f.x), !always, always);
  return tiles;
}

/// Weights for blending what the tiles show, from their barycentric weights:
///   w_i ~ weight_i^exponent * (1 + contrast * sine of the slope's angle)
/// Mixing shifted copies lowers the contrast; the exponent confines the mixture to narrow borders, where
/// the steeper tile prevails, so that bumps push through flat ground rather than fade into it.
///
/// deriv       each tile's derivative, of any orientation: only its length counts. For values without a
///             slope use contrast 0.
/// exponent    uniform; taken into [1, 1000], NaN as 1. If maps differ at random between tiles, the
///             mixture keeps on average 0.50, 0.66, 0.80, 0.88 and 0.94 of their variance for the
///             exponents 1, 2, 4, 7 and 14.
/// contrast    uniform; a vertical tile counts 1 + contrast times a flat one. Taken into [0, 1000], NaN
///             as 0.
/// returns     weights within [0, 1] of sum 1, continuous where the derivatives are: a tile without
///             barycentric weight has none
/// degenerate  derivatives of Inf and NaN count as vertical: never NaN
/// error       (16 + 2 * exponent * (1 + |log2(weight_i)|)) eps * w_i for given tiles; below the smallest
/// normal
///             number: 0
/// source      Mikkelsen 2022 (exponent, steeper tiles prevail); own formula
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> hex_weights(const HexTiles<T>& tiles, const vec2<T> (&deriv)[3],
                                                       value_t<T> exponent = value_t<T>(7),
                                                       value_t<T> contrast = value_t<T>(1.5)) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T most = constant<T>(1000);
  const T k = min(max(T(exponent), one), most);
  const T gain = min(max(T(contrast), zero), most);
  // Relative to the largest weight, at least 1/3: no power underflows to 0 / 0.
  const T inverse = one / max(max(tiles.weight[0], tiles.weight[1]), tiles.weight[2]);
  const auto share = [&](int tile) {
    // Beyond 1e30 the sine is 1 to rounding; min also turns NaN into it.
    const T square = min(dot(deriv[tile], deriv[tile]), constant<T>(1e30));
    return pow(tiles.weight[tile] * inverse, k) * (one + gain * sqrt(square / (one + square)));
  };
  const vec3<T> w{share(0), share(1), share(2)};
  return (one / (w.x + w.y + w.z)) * w;
}

/// The tiled map's derivative by st: the tiles' derivatives turned back and blended. The weights count as
/// constant, as those of triplanar projection do.
///
/// weights     from hex_weights
/// deriv       derivative by st[i] that each tile samples
/// degenerate  NaN and Inf propagate
/// error       4 eps * the sum of weight_i * (|deriv_i.x| + |deriv_i.y|)
/// source      own: the chain rule
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> hex_derivative(const HexTiles<T>& tiles, vec3<T> weights,
                                                                    const vec2<T> (&deriv)[3]) {
  return weights.x * rotate_back(deriv[0], tiles.rotation[0]) +
         weights.y * rotate_back(deriv[1], tiles.rotation[1]) +
         weights.z * rotate_back(deriv[2], tiles.rotation[2]);
}

} // namespace surfgrad
