#pragma once

#include "raster/tile_grid.hpp"

#include <functional>
#include <optional>

namespace surfgrad::raster {

/// Whether a triangle is left out on the side it shows: (triangle, front_facing).
using Skip = std::function<bool(const TriangleId&, bool)>;

/// Which pixels of a texture a triangle shows in.
enum class Coverage {
  centres, ///< those whose centre it covers
  /// Also those whose square it reaches into, though none covers their centre: of several triangles the one
  /// nearest to the centre, of equally near ones the first. So slivers between the centres do not vanish.
  squares,
};

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
    /// Set where it covers no centre, but reaches into the square of its one pixel: its point nearest to the
    /// centre, which the pixel shows. A triangle is listed once for each of these pixels.
    std::optional<vec2<double>> nearest{};
  };
  static constexpr int nothing = -1;

  /// Neighbours in a row of the tile that show the same triangle.
  struct Run {
    int x, y; ///< of the first pixel, in the tile
    int count;
    int owner; ///< which of shown()
  };

  /// Depth-tested where the projection has depth: both sides of triangles are kept unless `skip` says so,
  /// what is nearer than the near limit is not seen, and equal depths go to the earlier triangle.
  /// Otherwise the first triangle over a pixel stays.
  ///
  /// skip      may be empty
  /// coverage  squares: of projections without depth alone
  void scan(const std::vector<Surface>& surfaces, const Projection& projection, const Tile& tile,
            std::span<const TriangleId> candidates, const Skip& skip, Coverage coverage = Coverage::centres);

  /// For each pixel, row by row from the lower left: which of shown() it shows, or nothing.
  [[nodiscard]] std::span<const int> owners() const { return owners_; }
  /// The pixels that show something: row by row, then those whose square a triangle only reaches into.
  [[nodiscard]] std::span<const Run> runs() const { return runs_; }
  /// Ascending; then those that only reach into a pixel's square, by pixel. Those hidden again are gone.
  [[nodiscard]] std::span<const Shown> shown() const { return shown_; }
  /// Pixels that lie under more than one triangle; not counted where there is depth.
  [[nodiscard]] int overlapping() const { return overlapping_; }
  /// Pixels whose square triangles reach into while none covers the centre.
  [[nodiscard]] int touched() const { return touched_; }

 private:
  /// A triangle that reaches into a pixel's square.
  struct Reached {
    TriangleId id;
    vec2<double> point; ///< of it, nearest to the centre
    double distance2;   ///< from there; infinite where there is none
  };

  void list_runs(const Tile& tile);
  void drop_hidden(const Tile& tile);
  void reach_into_squares(const std::vector<Surface>& surfaces, const Projection& projection,
                          const Tile& tile, std::span<const TriangleId> candidates);

  std::vector<int> owners_;
  std::vector<double> nearest_; ///< 1 / w: 0 is infinitely far
  std::vector<int> covered_;    ///< by how many triangles, at most 2; as wide as owners_, to go abreast
  std::vector<Shown> shown_;
  std::vector<Run> runs_;
  std::vector<int> renumbered_;
  std::vector<Reached> reached_;
  int overlapping_ = 0;
  int touched_ = 0;
};

} // namespace surfgrad::raster
