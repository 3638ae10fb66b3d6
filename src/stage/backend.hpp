#pragma once

#include "engine/map_library.hpp"
#include "engine/tiles.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace surfgrad::stage {

/// Composes pixels in the engine's stead.
class Composer {
 public:
  virtual ~Composer() = default;
  /// What engine::compose_tile does, for pixels of a material. Any number of threads at a time.
  virtual void compose(const engine::TileWork& work, std::uint32_t material) const = 0;
};

/// A device that can stand in for the engine.
class Backend {
 public:
  virtual ~Backend() = default;
  /// Makes ready what the materials of a scene need.
  ///
  /// slots     texture coordinates that its surfaces carry
  /// surfaces  one a scene object, in the same order
  [[nodiscard]] virtual std::unique_ptr<Composer> prepare(const scene::Scene& scene,
                                                          const std::vector<raster::UvSlot>& slots,
                                                          const std::vector<raster::Surface>& surfaces,
                                                          engine::MapLibrary& maps) const = 0;
  /// Samples along a side of the tiles that it is to be given.
  [[nodiscard]] virtual int tile_side() const = 0;
};

/// Samples along a side of a job's tiles.
///
/// backend  null for the engine
[[nodiscard]] inline int tile_side_of(const Backend* backend) {
  constexpr int of_the_engine = 32; // fits the first caches with all that is kept of a pixel
  return backend != nullptr ? backend->tile_side() : of_the_engine;
}

} // namespace surfgrad::stage
