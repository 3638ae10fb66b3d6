#pragma once

/// The first crossing of a ray with a height field: exact, over as few cells as the maxima allow.
///
/// The answer is march_parallax's with infinitely many steps. A ray walks over the nodes of the field's
/// pyramid of maxima: past a node whose maximum it stays above in one step, else into it, down to a cell,
/// where the bilinear surface along the ray is a quadratic in the ray's height and its root is the answer.

#include "image/height_field.hpp"
#include "image/sampler.hpp"

#include <surfgrad/parallax_march.hpp>

namespace surfgrad::image {

/// A ray covers at most this many texels of its level a height of 1, along either axis; one that is closer
/// to level is raised. It bounds the work (see detail::most_visits), and beyond it a float would no longer
/// tell where in a texel the ray is: 2^16 eps / 2 = 1/256.
inline constexpr int march_most_texels = 1 << 16;

namespace detail {

/// No cell number that a ray meets is as large.
inline constexpr int beyond_cells = 1 << 22;

/// A ray over one axis, in texels of its level: at height h over start + h * way; cell c spans [c, c + 1].
template <class T>
struct RayAxis {
  T start, way;
  T inverse_way; ///< 0 where the ray does not move
  T count;       ///< texels
  Wrap wrap;
};

template <class T>
struct Ray {
  index_t<T> level;
  RayAxis<T> x, y;
};

/// The cells from low up to, without, high that one node stands for where the ray is.
template <class T>
struct Span {
  T low, high;
  T node; ///< its number along the axis; unused for cells
};

/// Span of the node of 2^order = size cells that holds a cell of the endless lattice. All numbers are
/// integers below 2^24, so that only the divisions by count round, and never across an integer.
template <LaneScalar T>
[[nodiscard]] Span<T> span_of(const RayAxis<T>& axis, T cell, T size) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T count = axis.count;
  const mask_t<T> single = size == one;
  if (axis.wrap == Wrap::clamp) {
    // All cells beyond a border are one.
    const T far = T(static_cast<value_t<T>>(beyond_cells));
    const T first = select(single, -one, zero);
    const T node = floor(min(max(cell, first), count - one) / size);
    const T low = node * size;
    return {select(first < low, low, -far), select(low + size < count, low + size, far), node};
  }
  const T period = axis.wrap == Wrap::mirror ? count + count : count;
  const T base = period * floor(cell / period);
  const T offset = cell - base;
  const mask_t<T> backwards = !(offset < count);
  // Cell -1 between two mirror images shows texel 0 only, which cell 0 has as well.
  const T inside = select(backwards, max(period - constant<T>(2) - offset, zero), offset);
  const T node = floor(inside / size);
  const T low = node * size;
  const T high = min(low + size, count);
  const T mirrored_high = select(low == zero, period, period - one - low);
  return {select(single, cell, base + select(backwards, period - one - high, low)),
          select(single, cell + one, base + select(backwards, mirrored_high, high)), node};
}

/// Texel that shows at an integer position of the endless lattice.
template <LaneScalar T>
[[nodiscard]] T texel_at(const RayAxis<T>& axis, T i) {
  const T zero = T(value_t<T>(0));
  const T last = axis.count - T(value_t<T>(1));
  if (axis.wrap == Wrap::clamp) return min(max(i, zero), last);
  const T period = axis.wrap == Wrap::mirror ? axis.count + axis.count : axis.count;
  const T offset = i - period * floor(i / period);
  return select(offset < axis.count, offset, period - T(value_t<T>(1)) - offset);
}

template <class T>
struct RayHit {
  T height;
  mask_t<T> met;
};

/// The ray's way through one cell, from height `from` down to `to`: where it first is not above the
/// bilinear surface. A ray that enters below it, as rounding at a border may have it, meets it there.
template <LaneScalar T>
[[nodiscard]] RayHit<T> cross_cell(const HeightField& field, const Ray<T>& ray, vec2<T> cell, T from, T to,
                                   mask_t<T> active) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const Level<T> level = levels_of<T>(field.map, ray.level, active);
  const auto row = [&](T y) { return level.first_word + level.row_texels * bits_t<T>(to_index(y)); };
  const bits_t<T> left = bits_t<T>(to_index(texel_at(ray.x, cell.x)));
  const bits_t<T> right = bits_t<T>(to_index(texel_at(ray.x, cell.x + one)));
  const bits_t<T> below = row(texel_at(ray.y, cell.y));
  const bits_t<T> above = row(texel_at(ray.y, cell.y + one));
  const auto texel = [&](bits_t<T> word) {
    return float_from_bits<T>(gather(field.map.texels(), index_t<T>(word), active));
  };
  const T corner = texel(below + left);
  const T along_x = texel(below + right) - corner;
  const T above_left = texel(above + left);
  const T along_y = above_left - corner;
  const T twist = (texel(above + right) - above_left) - along_x;

  const auto within = [&](const RayAxis<T>& axis, T c, T h) {
    return min(max(axis.start + h * axis.way - c, zero), one);
  };
  const auto clearance = [&](T x, T y, T h) {
    return h - (corner + along_x * x + (along_y + twist * x) * y);
  };
  const T x0 = within(ray.x, cell.x, from), x1 = within(ray.x, cell.x, to);
  const T y0 = within(ray.y, cell.y, from), y1 = within(ray.y, cell.y, to);
  // Clearance over the way u from 0 to 1: before - fall * u - bend * u^2, the surface being straight along
  // each axis.
  const T before = clearance(x0, y0, from);
  const T after = clearance(x1, y1, to);
  const T bend = twist * ((x1 - x0) * (y1 - y0));
  const T fall = before - after - bend;
  const T square = fall * fall + constant<T>(4) * bend * before;
  const mask_t<T> starts_below = !(zero < before);
  const mask_t<T> ends_below = !(zero < after);
  // Above at both ends, and below in between: the clearance sinks first and turns before the end.
  const mask_t<T> dips = (bend < zero) & (zero < fall) & (fall < -(bend + bend)) & !(square < zero);
  // The smaller positive root, in the form that adds what has the same sign. For fall < 0 only bend > 0 has
  // one.
  const T root = sqrt(max(square, zero));
  const mask_t<T> sinks = !(fall < zero);
  const T numerator = select(sinks, before + before, root - fall);
  const T denominator = select(sinks, fall + root, bend + bend);
  const mask_t<T> level_way = !(zero < denominator);
  const T share = numerator / select(level_way, one, denominator);
  const T u = select(level_way | starts_below, zero, min(max(share, zero), one));
  return {from + u * (to - from), mask_t<T>(active & (starts_below | ends_below | dips))};
}

template <class T>
struct Crossing {
  T height; ///< of the crossing, or `end` where none is met
  mask_t<T> met;
  int visits; ///< of nodes and cells, by the lane with the most
};

/// First crossing of a ray on its way from height 1 down to `end` >= 0.
///
/// It ends, whatever the heights are: a step forward crosses a line of the lattice that the ray, being still
/// above `end`, has before it, and no line is crossed twice. So there are at most |way.x| + |way.y| + 4
/// steps forward. Each raises the order of the node by at most one, and the first order is 0, so that there
/// are at most as many steps into a node: see most_visits.
template <LaneScalar T>
[[nodiscard]] Crossing<T> first_crossing(const HeightField& field, const Ray<T>& ray, T end,
                                         mask_t<T> active) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T half = constant<T>(0.5);
  const T never = -T(std::numeric_limits<value_t<T>>::max());
  const index_t<T> single = index_constant<T>(1);
  const index_t<T> row = index_t<T>(bits_t<T>(ray.level) * bits_t<T>(index_constant<T>(field.row_words)));
  const index_t<T> last = index_t<T>(gather(field.rows(), row, active));
  const auto maximum = [&](T column, T line, T size, index_t<T> order, mask_t<T> mask) {
    const bits_t<T> first = gather(field.rows(), index_t<T>(row + order), mask);
    const T width = floor((ray.x.count + size - one) / size);
    const bits_t<T> word =
        first + bits_t<T>(to_index(line)) * bits_t<T>(to_index(width)) + bits_t<T>(to_index(column));
    return float_from_bits<T>(gather(field.nodes(), index_t<T>(word), mask));
  };

  // Above the whole map nothing is met.
  const T all = T(static_cast<value_t<T>>(2 * height_field_most_texels));
  const mask_t<T> has_nodes = active & (index_constant<T>(0) < last);
  T height = select(has_nodes, min(maximum(zero, zero, all, last, has_nodes), one), one);
  const auto cell_at = [](const RayAxis<T>& axis, T h) { return floor(axis.start + h * axis.way); };
  vec2<T> cell{cell_at(ray.x, height), cell_at(ray.y, height)};
  index_t<T> order = index_constant<T>(0);
  T size = one;

  Crossing<T> result{end, !(zero == zero), 0};
  mask_t<T> searching = active & !(height < end);
  for (; any(searching); ++result.visits) {
    const Span<T> x = span_of(ray.x, cell.x, size);
    const Span<T> y = span_of(ray.y, cell.y, size);
    // Height at which the ray leaves the span. Rounding keeps the order of borders, so that a cell's way lies
    // within that of the nodes around it in floating point too.
    const auto leaves_at = [&](const RayAxis<T>& axis, const Span<T>& span) {
      const T border = select(zero < axis.way, span.low, span.high);
      return select(axis.inverse_way == zero, never, (border - axis.start) * axis.inverse_way);
    };
    const T leaves_x = leaves_at(ray.x, x);
    const T leaves_y = leaves_at(ray.y, y);
    const T leaves = max(leaves_x, leaves_y);
    const T lowest = min(max(leaves, end), height);

    const mask_t<T> in_cell = searching & (size == one);
    const mask_t<T> in_node = searching & !in_cell;
    mask_t<T> enters = in_node;
    if (any(in_node)) enters = in_node & !(maximum(x.node, y.node, size, order, in_node) < lowest);
    if (any(in_cell)) {
      const RayHit<T> hit = cross_cell(field, ray, cell, height, lowest, in_cell);
      result.height = select(hit.met, hit.height, result.height);
      result.met = result.met | hit.met;
      searching = searching & !hit.met;
    }
    searching = searching & (enters | (end < leaves));

    const mask_t<T> advances = searching & !enters;
    const mask_t<T> over_x = !(leaves_x < leaves_y);
    const auto next_cell = [&](const RayAxis<T>& axis, const Span<T>& span, T from, mask_t<T> crosses) {
      const mask_t<T> down = zero < axis.way;
      const T on_way = min(max(cell_at(axis, lowest), span.low), span.high - one);
      const T passed = select(down, span.low - one, span.high);
      return select(crosses, passed, select(down, min(on_way, from), max(on_way, from)));
    };
    cell.x = select(advances, next_cell(ray.x, x, cell.x, over_x), cell.x);
    cell.y = select(advances, next_cell(ray.y, y, cell.y, !over_x), cell.y);
    height = select(advances, lowest, height);
    const mask_t<T> rises = advances & (order < last);
    order = select(enters, index_t<T>(order - single), select(rises, index_t<T>(order + single), order));
    size = select(enters, size * half, select(rises, size + size, size));
  }
  return result;
}

/// Bound of Crossing::visits for a ray that covers this many texels along each axis: two for each step
/// forward, and the last.
[[nodiscard]] constexpr long most_visits(double way_x, double way_y) {
  return 2 * (static_cast<long>(way_x) + static_cast<long>(way_y) + 4) + 1;
}

/// A ray in texels of the level nearest to the LOD, and the way it takes in texture coordinates: dst, made
/// shorter if it is beyond march_most_texels, NaN as 0.
template <class T>
struct LeveledRay {
  Ray<T> ray;
  vec2<T> dst;
};

template <LaneScalar T>
[[nodiscard]] LeveledRay<T> leveled_ray(const HeightField& field, Wraps wraps, vec2<T> st, vec2<T> dst, T lod,
                                        mask_t<T> active) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const T most_level = T(static_cast<value_t<T>>(field.map.level_count - 1));
  const index_t<T> level = to_index(min(max(floor(lod + constant<T>(0.5)), zero), most_level));
  const auto texels = [&](int k) {
    const index_t<T> entry = index_t<T>(level + level + level + index_constant<T>(k));
    return max(T(index_t<T>(gather(field.map.levels(), entry, active))), one);
  };
  const vec2<T> count{texels(0), texels(1)};
  // Far enough to be shortened, near enough to be multiplied.
  const T most_dst = constant<T>(0x1p40);
  const auto bounded = [&](T d) { return select(d == d, min(max(d, -most_dst), most_dst), zero); };
  dst = {bounded(dst.x), bounded(dst.y)};
  const T most = T(static_cast<value_t<T>>(march_most_texels));
  const T length = max_abs(dst * count);
  dst = select(most < length, most / max(length, one), one) * dst;
  const auto axis = [&](T s, T d, T n, Wrap wrap) {
    if (wrap == Wrap::repeat) s = s - floor(s);
    if (wrap == Wrap::mirror) s = s - constant<T>(2) * floor(constant<T>(0.5) * s);
    const T way = d * n;
    // A clamped ray from farther out meets nothing but the border's texel, and so it does from here.
    const T out = abs(way) + constant<T>(2);
    const T start = min(max(s * n - constant<T>(0.5), -out), n + n + out);
    return RayAxis<T>{start, way, reciprocal_or_zero(way), n, wrap};
  };
  return {{level, axis(st.x, dst.x, count.x, wraps.s), axis(st.y, dst.y, count.y, wraps.t)}, dst};
}

} // namespace detail

/// First crossing of a ray with the bilinear surface of a height field, coming from height 1 down to 0. No
/// peak is missed, however narrow.
///
/// st      texture coordinate of the fragment, where the ray reaches height 0
/// dst     project_to_texture_space towards the viewer: at height h the ray is over st + h * dst
/// lod     the mip level nearest to it is met, and it alone: sample heights there
/// active  lanes to march; others are no hits, with st unchanged
/// returns largest height h in [0, 1] at which the surface reaches the ray, and st + h * dst. Always a hit:
///         no height is below 0.
/// degenerate  zero dst gives the height at st. A ray that covers more than march_most_texels texels of
///             the level is shortened to that. NaN in dst counts as 0, NaN in st as some coordinate for the
///             heights, NaN lod as 0.
/// error   in height, against the bilinear surface over st + h * dst: 8 eps, and 4 eps a texel of st (within
///         its period) and of dst, along each axis. A graze that is shallower may be missed.
/// source  own; semantics of march_parallax (Mikkelsen 2019, section 2.6)
template <LaneScalar T>
[[nodiscard]] ParallaxHit<T> march(const HeightField& field, Wraps wraps, vec2<T> st, vec2<T> dst, T lod,
                                   mask_t<T> active) {
  const detail::LeveledRay<T> leveled = detail::leveled_ray(field, wraps, st, dst, lod, active);
  const T ground = T(value_t<T>(0));
  // Where rounding has the surface pass below the ground, the ray meets it there.
  const T height = detail::first_crossing(field, leveled.ray, ground, active).height;
  return {select<T>(active, st + height * leveled.dst, st), height, active};
}

/// Sunlight at a point of a height field: 1 where the way to the light is free, 0 where the surface is in it.
///
/// st, height  the point, e.g. march's; on the surface or above it (below it no light arrives)
/// dst         project_to_texture_space towards the light: the way is over st + (h - height) * dst for h up
///             to 1
/// lod         that of march: another level is another surface
/// bias        the way starts above the point by 8 eps, and 8 eps a texel of st (within its period) and of
///             dst: what march and this search may be off
/// degenerate  as march; a light below the horizon is the caller's to leave out
template <LaneScalar T>
[[nodiscard]] T visible(const HeightField& field, Wraps wraps, vec2<T> st, T height, vec2<T> dst, T lod,
                        mask_t<T> active) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  detail::LeveledRay<T> leveled = detail::leveled_ray(field, wraps, st, dst, lod, active);
  detail::RayAxis<T>& x = leveled.ray.x;
  detail::RayAxis<T>& y = leveled.ray.y;
  const T bias = T(8 * epsilon_v<T>) * (one + max(abs(x.start), abs(y.start)) + max(abs(x.way), abs(y.way)));
  const T from = max(height + bias, zero);
  x.start = x.start - from * x.way;
  y.start = y.start - from * y.way;
  return select(detail::first_crossing(field, leveled.ray, from, active).met, zero, one);
}

} // namespace surfgrad::image
