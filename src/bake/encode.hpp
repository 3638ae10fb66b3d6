#pragma once

#include "bake/bake.hpp"
#include "engine/tiles.hpp"

namespace surfgrad::bake {

/// Composed pixels of one surface, to be expressed in the space asked for.
struct EncodeWork {
  Space space = Space::tangent;
  mat3<double> linear{};                       ///< of the object's transform
  const engine::TileWork::Results* composed{}; ///< with the vertex frame where the space is tangent
  int first = 0, end = 0;                      ///< pixels in those arrays
  vec3<float*> normal{};                       ///< room for most_lanes beyond the end
  float* singular = nullptr;                   ///< 1 or 0: Counts::singular, Counts::clamped
  float* clamped = nullptr;
};

/// With the instruction set in use; same bytes on all.
void encode_pixels(const EncodeWork& work);

} // namespace surfgrad::bake
