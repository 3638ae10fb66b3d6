#pragma once

#include "engine/program.hpp"

#include <surfgrad/resolve.hpp>

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

/// Runs a program on one fragment (or one pack of them).
///
/// back_faces  how a fragment that shows its back is treated
template <LaneScalar T>
[[nodiscard]] Composition<T> compose(const Program& program, const raster::Fragment<T>& fragment,
                                     BackFaces back_faces, const Placement& placement) {
  const T zero = T(value_t<T>(0));
  Point<T> point{
      fragment,
      make_frame(fragment.normal, fragment.dp_dx, fragment.dp_dy, fragment.front_facing, back_faces), true,
      T(value_t<T>(1)), placement};
  const vec3<T> base = point.frame.normal;
  mask_t<T> degenerate = fragment.normal_is_absent | mask_t<T>(max_abs(base) == zero);
  vec3<T> sum{zero, zero, zero};
  for (const auto& layer : program.layers)
    std::visit([&](const auto& kind) { apply(kind, point, sum, degenerate); }, layer);
  const vec3<T> normal = resolve_normal(point.frame, sum);
  return {base, normal, point.frame.resolve_sign * from_perturbed_normal(base, normal), point.sunlight,
          degenerate};
}

} // namespace surfgrad::engine
