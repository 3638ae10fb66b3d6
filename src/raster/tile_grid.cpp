#include "raster/tile_grid.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>

namespace surfgrad::raster {
namespace {

/// Tiles from first up to last.
struct TileRange {
  int column_first, column_end, row_first, row_end;
};

/// Pixels along one axis whose centres lie between two coordinates, as tiles. One pixel of margin covers
/// the rounding of the divisions: coverage is decided exactly later.
void tiles_between(double low, double high, int pixels, int tile, int& first, int& end) {
  const int first_pixel = static_cast<int>(std::clamp(std::floor(low) - 1, 0.0, double(pixels)));
  const int end_pixel = static_cast<int>(std::clamp(std::ceil(high) + 1, 0.0, double(pixels)));
  first = first_pixel / tile;
  end = first_pixel < end_pixel ? (end_pixel - 1) / tile + 1 : first;
}

/// Calls visit(id, corners) for every triangle, in parallel.
template <class Visit>
void for_each_triangle(const std::vector<Surface>& surfaces, const Visit& visit) {
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    const auto count = static_cast<std::uint32_t>(surfaces[s].mesh->triangles.size());
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, 1024),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                        for (std::uint32_t t = range.begin(); t < range.end(); ++t) visit(TriangleId{s, t});
                      });
  }
}

} // namespace

TileGrid::TileGrid(const std::vector<Surface>& surfaces, const Projection& projection, int width, int height,
                   int tile_width, int tile_height)
    : width_(width), height_(height), tile_width_(tile_width), tile_height_(tile_height),
      columns_((width + tile_width - 1) / tile_width), rows_((height + tile_height - 1) / tile_height) {
  const auto tiles_of = [&](const TriangleId& id) {
    const std::array<vec3<double>, 3> corners = projection.corners(surfaces[id.surface], id.triangle);
    // w is linear over a triangle: one whose corners are too near, or behind the eye, is so everywhere.
    const double near = projection.near();
    if (corners[0].z < near && corners[1].z < near && corners[2].z < near) return TileRange{};
    double x_low = INFINITY, x_high = -INFINITY, y_low = INFINITY, y_high = -INFINITY;
    for (const vec3<double>& c : corners) {
      // A corner at or behind the eye has no image: the triangle may reach anywhere.
      if (!(c.z > 0)) return TileRange{0, columns_, 0, rows_};
      x_low = std::min(x_low, c.x / c.z);
      x_high = std::max(x_high, c.x / c.z);
      y_low = std::min(y_low, c.y / c.z);
      y_high = std::max(y_high, c.y / c.z);
    }
    TileRange range{};
    tiles_between(x_low, x_high, width_, tile_width_, range.column_first, range.column_end);
    tiles_between(y_low, y_high, height_, tile_height_, range.row_first, range.row_end);
    return range;
  };
  const auto for_each_tile = [&](const TileRange& range, const auto& visit) {
    for (int row = range.row_first; row < range.row_end; ++row)
      for (int column = range.column_first; column < range.column_end; ++column)
        visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
              static_cast<std::size_t>(column));
  };

  const std::size_t count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  std::vector<std::atomic<std::size_t>> counters(count);
  for_each_triangle(surfaces, [&](const TriangleId& id) {
    for_each_tile(tiles_of(id),
                  [&](std::size_t tile) { counters[tile].fetch_add(1, std::memory_order_relaxed); });
  });
  first_.resize(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    first_[i + 1] = first_[i] + counters[i];
    counters[i] = first_[i];
  }
  candidates_.resize(first_.back());
  for_each_triangle(surfaces, [&](const TriangleId& id) {
    for_each_tile(tiles_of(id), [&](std::size_t tile) {
      candidates_[counters[tile].fetch_add(1, std::memory_order_relaxed)] = id;
    });
  });
  // Threads filled the lists in any order.
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    std::sort(candidates_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
              candidates_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]));
  });
}

Tile TileGrid::tile(int column, int row) const {
  const int x = column * tile_width_;
  const int y = row * tile_height_;
  return {x, y, std::min(tile_width_, width_ - x), std::min(tile_height_, height_ - y)};
}

std::span<const TriangleId> TileGrid::candidates(int column, int row) const {
  const std::size_t i =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  return {candidates_.data() + first_[i], first_[i + 1] - first_[i]};
}

} // namespace surfgrad::raster
