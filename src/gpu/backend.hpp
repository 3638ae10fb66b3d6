#pragma once

#include "gpu/material_shaders.hpp"
#include "gpu/pipeline.hpp"
#include "stage/backend.hpp"

#include <cstddef>
#include <cstdint>
#include <mutex>

namespace surfgrad::gpu {

/// Composes what render and bake ask for on a Vulkan device: fragments are interpolated by the processor,
/// their layers run as the shaders that shadergen writes, with the engine's own maps and filters.
class Backend : public stage::Backend {
 public:
  /// Most pixels along a side of the tiles that a device is given: enough to keep it busy, few enough that
  /// other programs get their turn.
  static constexpr int usual_tile_side = 128;

  /// most_tile_side  larger tiles are not asked for
  /// For tests, if the device's limits allow as many:
  /// most_fragments     of a tile that are on the device at a time
  /// most_buffer_bytes  of a buffer with maps
  explicit Backend(const Device& device, int most_tile_side = usual_tile_side,
                   std::size_t most_fragments = SIZE_MAX, FilterOptions filter_options = {},
                   std::size_t most_buffer_bytes = SIZE_MAX);

  [[nodiscard]] std::unique_ptr<stage::Composer> prepare(const scene::Scene& scene,
                                                         const std::vector<raster::UvSlot>& slots,
                                                         const std::vector<raster::Surface>& surfaces,
                                                         engine::MapLibrary& maps) const override;
  [[nodiscard]] int tile_side() const override { return tile_side_; }
  /// Of the scene prepared last.
  [[nodiscard]] FilterReport filter_report() const;

 private:
  const Device& device_;
  int tile_side_;
  std::size_t most_fragments_;
  FilterOptions filter_options_;
  std::size_t most_buffer_bytes_;
  mutable PipelineCache cache_{};
  mutable std::mutex mutex_; // of the report
  mutable FilterReport report_{};
};

} // namespace surfgrad::gpu
