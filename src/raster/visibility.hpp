#pragma once

#include "raster/tile_scan.hpp"

#include <cstdint>
#include <vector>

namespace surfgrad::raster {

/// Which triangle a pixel shows.
struct Visible {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t surface = none;
  std::uint32_t triangle = 0;
};

/// What every pixel centre of a raster shows; row 0 at the bottom. For small rasters: jobs go tile by tile.
struct VisibilityBuffer {
  int width = 0;
  int height = 0;
  std::vector<Visible> pixels;
  std::int64_t overlapping = 0; ///< pixels under more than one triangle; not counted where there is depth

  [[nodiscard]] const Visible& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// Scans a whole raster (TileScan::scan).
[[nodiscard]] VisibilityBuffer see(const std::vector<Surface>& surfaces, const Projection& projection,
                                   int width, int height, const Skip& skip = {});

} // namespace surfgrad::raster
