#pragma once

#include "engine/program.hpp"

#include <surfgrad/resolve.hpp>

#include <utility>
#include <variant>

namespace surfgrad::engine {

/// What the layers of a material make of one fragment.
template <class T>
struct Composition {
  vec3<T> base_normal; ///< the mesh's: unit; negated on back faces in modes mirror and flip
  vec3<T> normal;      ///< the composed normal, unit
  /// Surface gradient that leads from base_normal to normal in one step: the sum of a single pass (less
  /// what interpolated tangents lend it along the normal), the equivalent of several. After a parallax that
  /// is the turn from the mesh under the fragment to the surface seen through it.
  vec3<T> surfgrad;
  T sunlight;           ///< share of the sun that reaches the point, in [0, 1]: parallax casts shadows
  mask_t<T> degenerate; ///< a normal or a frame that a layer needed did not exist
};

/// What every layer but those with an `apply` of their own does: one surface gradient joins the sum.
template <LaneScalar T, class Layer>
void apply(const Layer& layer, Point<T>& point, vec3<T>& sum, mask_t<T>& degenerate) {
  sum = blended(layer.influence, weight(layer.influence, point.fragment), sum,
                surface_gradient(layer, point, degenerate));
}

/// Calls f(layer) with the layer's own type. Unlike std::visit it leaves nothing behind to throw, which
/// sources compiled for one instruction set must not share with others.
template <class Layer, class Function>
void with_kind(const Layer& layer, const Function& f) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    static_cast<void>(((layer.index() == I && (f(*std::get_if<I>(&layer)), true)) || ...));
  }
  (std::make_index_sequence<std::variant_size_v<Layer>>());
}

/// Runs a program on a point in its first pass and gives the composed normal.
///
/// degenerate  (out) where a normal or a frame that a layer needed did not exist
template <LaneScalar T>
[[nodiscard]] vec3<T> run(const Program& program, Point<T>& point, mask_t<T>& degenerate) {
  const T zero = T(value_t<T>(0));
  degenerate = point.fragment.normal_is_absent | mask_t<T>(max_abs(point.frame.normal) == zero);
  vec3<T> sum{zero, zero, zero};
  for (const auto& layer : program.layers)
    with_kind(layer, [&](const auto& kind) { apply(kind, point, sum, degenerate); });
  return resolve_normal(point.frame, sum);
}

/// Runs a program on one fragment (or one pack of them).
template <LaneScalar T>
[[nodiscard]] Composition<T> compose(const Program& program, const raster::Fragment<T>& fragment,
                                     BackFaces back_faces, const Placement& placement) {
  raster::Fragment<T> own = fragment;
  Point<T> point(own, back_faces, placement);
  const vec3<T> base = point.frame.normal;
  Composition<T> c{};
  c.base_normal = base;
  c.normal = run(program, point, c.degenerate);
  c.surfgrad = point.frame.resolve_sign * from_perturbed_normal(base, c.normal);
  c.sunlight = point.sunlight;
  return c;
}

} // namespace surfgrad::engine
