#pragma once

#include "engine/program.hpp"

#include <surfgrad/resolve.hpp>

namespace surfgrad::engine {

/// What the layers of a material make of one fragment.
template <class T>
struct Composition {
  vec3<T> base_normal; ///< unit; negated on back faces in modes mirror and flip
  vec3<T> normal;      ///< the composed normal, unit
  /// Surface gradient that leads from base_normal to normal in one step: the sum of a single pass (less
  /// what interpolated tangents lend it along the normal), the equivalent of several.
  vec3<T> surfgrad;
  mask_t<T> degenerate; ///< a normal or a frame that a layer needed did not exist
};

/// Runs a program on one fragment (or one pack of them).
///
/// back_faces         how a fragment that shows its back is treated
/// world_from_object  linear part of the object's transform
template <LaneScalar T>
[[nodiscard]] Composition<T> compose(const Program& program, const raster::Fragment<T>& fragment,
                                     BackFaces back_faces, const mat3<T>& world_from_object) {
  const T zero = T(value_t<T>(0));
  const vec3<T> none{zero, zero, zero};
  Frame<T> frame =
      make_frame(fragment.normal, fragment.dp_dx, fragment.dp_dy, fragment.front_facing, back_faces);
  const vec3<T> base = frame.normal;
  mask_t<T> degenerate = fragment.normal_is_absent | mask_t<T>(max_abs(base) == zero);
  vec3<T> sum = none;
  bool first_pass = true;
  const auto run = [&](const auto& layer) {
    using Layer = std::decay_t<decltype(layer)>;
    if constexpr (std::is_same_v<Layer, Resolve>) {
      frame = rebase_frame(frame, resolve_normal(frame, sum));
      sum = none;
      first_pass = false;
    } else if constexpr (std::is_same_v<Layer, NormalMap>) {
      sum = blended(layer.influence, fragment, sum,
                    surface_gradient(layer, fragment, frame, first_pass, degenerate));
    } else {
      sum = blended(layer.influence, fragment, sum,
                    surface_gradient(layer, fragment, frame, world_from_object, degenerate));
    }
  };
  for (const auto& layer : program.layers) std::visit(run, layer);
  const vec3<T> normal = resolve_normal(frame, sum);
  return {base, normal, frame.resolve_sign * from_perturbed_normal(base, normal), degenerate};
}

} // namespace surfgrad::engine
