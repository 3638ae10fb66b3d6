#pragma once

#include "engine/tiles.hpp"

#include <cstddef>

namespace surfgrad::gpu {

/// What of a fragment goes to the device, in floats.
enum class Attribute {
  position,         ///< 3
  normal,           ///< 3
  dp_dx,            ///< 3
  dp_dy,            ///< 3
  dn_dx,            ///< 3
  dn_dy,            ///< 3
  front_facing,     ///< 1 or 0
  normal_is_absent, ///< 1 or 0
  st,               ///< 2, of a texture coordinate
  dst_dx,           ///< 2
  dst_dy,           ///< 2
  tangent,          ///< 3, and the sign
  object_position,  ///< 3
  world_position,   ///< 3: the same in the world
  to_viewer,        ///< 3
  raster,           ///< 2
};

[[nodiscard]] int floats_of(Attribute attribute);

/// Where an attribute of the fragments goes: its first component's array, the others one stride apart.
struct AttributeArray {
  Attribute attribute = Attribute::normal;
  int slot = 0; ///< of a texture coordinate
  float* to = nullptr;
};

/// Pixels of a tile whose fragments are written out. Arrays have room for most_lanes more than `count`.
struct FragmentWork {
  const engine::TileWork* tile = nullptr;
  raster::Wanted wanted{};
  int first = 0; ///< of the tile's pixels
  int count = 0;
  const AttributeArray* arrays = nullptr;
  int array_count = 0;
  std::size_t stride = 0;
  float* resolve_sign = nullptr; ///< of the first frame; null where not wanted
};

/// Interpolates the fragments, in lanes. Those results of the tile that hang on the fragment alone
/// (Results::to_viewer, mesh_normal, tangent, sign, st) are filled in, too.
void write_fragments(const FragmentWork& work);

} // namespace surfgrad::gpu
