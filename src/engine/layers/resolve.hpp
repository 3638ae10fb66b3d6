#pragma once

#include "engine/point.hpp"

#include <surfgrad/resolve.hpp>

namespace surfgrad::engine {

/// Ends a pass.
struct Resolve {};

/// The normal perturbed so far becomes the base normal of the layers that follow.
template <LaneScalar T>
void apply(const Resolve&, Point<T>& point, vec3<T>& sum, mask_t<T>&) {
  const T zero = T(value_t<T>(0));
  point.frame = rebase_frame(point.frame, resolve_normal(point.frame, sum));
  point.first_pass = false;
  sum = {zero, zero, zero};
}

} // namespace surfgrad::engine
