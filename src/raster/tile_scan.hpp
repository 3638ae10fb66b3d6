#pragma once

#include "raster/tile_grid.hpp"

#include <functional>

namespace surfgrad::raster {

/// Whether a triangle is left out on the side it shows: (triangle, front_facing).
using Skip = std::function<bool(const TriangleId&, bool)>;

/// What the pixels of a tile show. One a thread, reused from tile to tile: it allocates only while its
/// tiles grow.
class TileScan {
 public:
  /// A triangle that pixels of the tile show.
  struct Shown {
    TriangleId id;
    TrianglePlanes planes;
    int first_pixel; ///< the first one that shows it, row by row
    int pixels;      ///< how many do
  };
  static constexpr int nothing = -1;

  /// Depth-tested where the projection has depth: both sides of triangles are kept unless `skip` says so,
  /// what is nearer than the near limit is not seen, and equal depths go to the earlier triangle.
  /// Otherwise the first triangle over a pixel stays.
  ///
  /// skip  may be empty
  void scan(const std::vector<Surface>& surfaces, const Projection& projection, const Tile& tile,
            std::span<const TriangleId> candidates, const Skip& skip);

  /// For each pixel, row by row from the lower left: which of shown() it shows, or nothing.
  [[nodiscard]] std::span<const int> owners() const { return owners_; }
  /// Ascending. Those hidden again are gone.
  [[nodiscard]] std::span<const Shown> shown() const { return shown_; }
  /// Pixels that lie under more than one triangle; not counted where there is depth.
  [[nodiscard]] int overlapping() const { return overlapping_; }

 private:
  void drop_hidden();

  std::vector<int> owners_;
  std::vector<double> nearest_; ///< 1 / w: 0 is infinitely far
  std::vector<int> covered_;    ///< by how many triangles, at most 2; as wide as owners_, to go abreast
  std::vector<Shown> shown_;
  std::vector<int> renumbered_;
  int overlapping_ = 0;
};

} // namespace surfgrad::raster
