#include "raster/visibility.hpp"

#include <tbb/parallel_for.h>

#include <atomic>

namespace surfgrad::raster {

VisibilityBuffer see(const std::vector<Surface>& surfaces, const Projection& projection, int width,
                     int height, const Skip& skip) {
  constexpr int side = 64;
  VisibilityBuffer buffer{width, height, {}, 0};
  buffer.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const TileGrid grid(surfaces, projection, width, height, side, side);
  std::atomic<std::int64_t> overlapping{0};
  tbb::parallel_for(0, grid.columns() * grid.rows(), [&](int i) {
    const int column = i % grid.columns();
    const int row = i / grid.columns();
    const Tile tile = grid.tile(column, row);
    TileScan scan;
    scan.scan(surfaces, projection, tile, grid.candidates(column, row), skip);
    overlapping += scan.overlapping();
    for (int y = 0; y < tile.height; ++y)
      for (int x = 0; x < tile.width; ++x) {
        const int owner = scan.owners()[static_cast<std::size_t>(y * tile.width + x)];
        if (owner == TileScan::nothing) continue;
        const TriangleId id = scan.shown()[static_cast<std::size_t>(owner)].id;
        buffer.pixels[static_cast<std::size_t>(tile.y + y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(tile.x + x)] = {id.surface, id.triangle};
      }
  });
  buffer.overlapping = overlapping;
  return buffer;
}

} // namespace surfgrad::raster
