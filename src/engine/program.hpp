#pragma once

#include "engine/layers/decal.hpp"
#include "engine/layers/height_map.hpp"
#include "engine/layers/noise.hpp"
#include "engine/layers/normal_map.hpp"
#include "engine/layers/object_normal_map.hpp"
#include "engine/layers/parallax.hpp"
#include "engine/layers/planar.hpp"
#include "engine/layers/resolve.hpp"
#include "engine/layers/triplanar.hpp"
#include "engine/map_library.hpp"
#include "raster/surface.hpp"
#include "stack/stack.hpp"

#include <functional>
#include <variant>
#include <vector>

namespace surfgrad::engine {

/// The layers of one material, ready to run: maps loaded, numbers folded.
struct Program {
  std::vector<std::variant<NormalMap, HeightMap, ObjectNormalMap, VolumeNoise, Planar, Triplanar, Decals,
                           Parallax, Resolve>>
      layers;

  /// Parts of a fragment that only some kinds read.
  [[nodiscard]] bool reads_object_position() const;
  [[nodiscard]] bool reads_normal_derivatives() const;
};

/// Every texture coordinate that a list of layers reads, each once, tangents where a layer wants the
/// vertex frame. Appends to `slots`; throws InputError when a scene needs more than max_uv_slots.
void collect_uv_slots(const std::vector<stack::Layer>& layers, std::vector<raster::UvSlot>& slots);

/// Compiles the layers of one material for surfaces that carry `slots`.
///
/// done  told of each layer whose maps are made; may be empty
[[nodiscard]] Program compile(const std::vector<stack::Layer>& layers,
                              const std::vector<raster::UvSlot>& slots, MapLibrary& maps,
                              const std::function<void(const stack::Layer&)>& done = {});

} // namespace surfgrad::engine
