#pragma once

#include "raster/projection.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace surfgrad::raster {

/// A triangle of a scene.
struct TriangleId {
  std::uint32_t surface;
  std::uint32_t triangle;

  friend constexpr bool operator==(const TriangleId&, const TriangleId&) = default;
  friend constexpr auto operator<=>(const TriangleId&, const TriangleId&) = default;
};

/// A rectangle of a raster.
struct Tile {
  int x, y; ///< its lower left pixel
  int width, height;
};

/// A raster cut into tiles, and for each the triangles that may reach into it.
class TileGrid {
 public:
  /// tile_width, tile_height  of a tile; those at the right and upper border are cut off
  TileGrid(const std::vector<Surface>& surfaces, const Projection& projection, int width, int height,
           int tile_width, int tile_height);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] Tile tile(int column, int row) const;
  /// In ascending order. May hold triangles that only come near.
  [[nodiscard]] std::span<const TriangleId> candidates(int column, int row) const;

 private:
  int width_, height_, tile_width_, tile_height_, columns_, rows_;
  std::vector<std::size_t> first_;     ///< of each tile, in candidates_; and the end
  std::vector<TriangleId> candidates_; ///< tile after tile
};

} // namespace surfgrad::raster
