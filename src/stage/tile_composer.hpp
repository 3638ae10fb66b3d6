#pragma once

#include "engine/tiles.hpp"
#include "raster/tile_scan.hpp"
#include "stage/stage.hpp"

#include <functional>
#include <memory>

namespace surfgrad::stage {

/// Which results of a tile a job reads.
struct Outputs {
  bool normal = true;
  bool base_normal = false;
  bool surfgrad = false;
  bool sunlight = false;
  bool to_viewer = false;
  bool vertex_frame = false; ///< mesh normal, tangent and sign
  bool st = false;
  std::size_t slot = 0; ///< of the vertex frame and st
};

/// The composed pixels of a tile: those of one surface and material lie together. Valid until the same
/// thread composes its next tile.
struct ComposedTile {
  raster::Tile tile{};
  int count = 0;
  const std::int32_t* pixel = nullptr; ///< where each lies in the tile, row by row from the lower left
  engine::TileWork::Results results{}; ///< arrays of `count` values
  int overlapping = 0;                 ///< pixels under more than one triangle
  int touched = 0; ///< pixels that show the nearest point of a triangle beside their centre

  /// Runs of pixels of one surface.
  struct Run {
    std::uint32_t surface;
    int first, end;
  };
  std::span<const Run> runs{};
};

/// Composes what a raster shows, tile by tile, on any number of threads. In a texture a triangle also shows
/// in texels that it only reaches into (raster::Coverage::squares). Memory is a few tiles' a thread.
class TileComposer {
 public:
  /// stage, projection  must outlive the composer
  /// tile_width, tile_height  in pixels, about tile_side_of(backend)
  TileComposer(const Stage& stage, const raster::Projection& projection, int width, int height,
               int tile_width, int tile_height, const Outputs& outputs);
  ~TileComposer();

  [[nodiscard]] const raster::TileGrid& grid() const { return grid_; }
  [[nodiscard]] const ComposedTile& compose(int column, int row);

  /// Composes a row of tiles in parallel and hands each to `take` on the thread that composed it.
  void compose_row(int row, const std::function<void(const ComposedTile&)>& take);

 private:
  struct Scratch;
  struct Scratches;

  void collect(Scratch& scratch) const;

  const Stage& stage_;
  const raster::Projection& projection_;
  raster::TileGrid grid_;
  Outputs outputs_;
  std::size_t most_pixels_;
  std::unique_ptr<Scratches> scratches_;
};

} // namespace surfgrad::stage
