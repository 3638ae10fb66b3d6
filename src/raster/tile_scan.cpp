#include "raster/tile_scan.hpp"

#include <algorithm>

namespace surfgrad::raster {

namespace {

/// Pixels of a tile within a box, with one of margin for the rounding of its sides.
struct PixelRange {
  int first, end;

  PixelRange(double low, double high, int tile, int count)
      : first(static_cast<int>(std::clamp(low - tile - 1.5, 0.0, double(count)))),
        end(static_cast<int>(std::clamp(high - tile + 1.5, 0.0, double(count)))) {}
};

/// Calls visit(index in the tile, x, y of its centre) for the pixels of a tile that a triangle covers.
template <class Visit>
void for_each_covered_pixel(const Tile& tile, const TrianglePlanes& planes, const Visit& visit) {
  const TrianglePlanes::Box box = planes.box();
  const PixelRange columns(box.x_low, box.x_high, tile.x, tile.width);
  const PixelRange rows(box.y_low, box.y_high, tile.y, tile.height);
  if (columns.first >= columns.end || rows.first >= rows.end) return;

  // The edge functions decide wherever rounding cannot turn their signs; covers() decides the rest.
  const std::array<vec3<double>, 3>& e = planes.edges();
  const std::array<double, 3> margin = planes.margins(tile.x + tile.width, tile.y + tile.height);
  const double x_low = tile.x + columns.first + 0.5, x_high = tile.x + columns.end - 0.5;
  const double y_low = tile.y + rows.first + 0.5, y_high = tile.y + rows.end - 0.5;
  bool all_inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const double least =
        e[i].x * (e[i].x < 0 ? x_high : x_low) + e[i].y * (e[i].y < 0 ? y_high : y_low) + e[i].z;
    const double most =
        e[i].x * (e[i].x < 0 ? x_low : x_high) + e[i].y * (e[i].y < 0 ? y_low : y_high) + e[i].z;
    if (most < -margin[i]) return;
    all_inside = all_inside && least > margin[i];
  }
  for (int row = rows.first; row < rows.end; ++row) {
    const double y = tile.y + row + 0.5;
    const std::array<double, 3> base{e[0].y * y + e[0].z, e[1].y * y + e[1].z, e[2].y * y + e[2].z};
    for (int column = columns.first; column < columns.end; ++column) {
      const double x = tile.x + column + 0.5;
      if (!all_inside) {
        const double a = e[0].x * x + base[0], b = e[1].x * x + base[1], c = e[2].x * x + base[2];
        if (a < -margin[0] || b < -margin[1] || c < -margin[2]) continue;
        const bool certain = a > margin[0] && b > margin[1] && c > margin[2];
        if (!certain && !planes.covers(x, y)) continue;
      }
      visit(row * tile.width + column, x, y);
    }
  }
}

} // namespace

void TileScan::drop_hidden() {
  for (const int owner : owners_)
    if (owner != nothing) ++shown_[static_cast<std::size_t>(owner)].pixels;
  renumbered_.resize(shown_.size());
  int kept = 0;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    renumbered_[i] = kept;
    if (shown_[i].pixels == 0) continue;
    shown_[static_cast<std::size_t>(kept)] = shown_[i];
    shown_[static_cast<std::size_t>(kept++)].first_pixel = nothing;
  }
  shown_.erase(shown_.begin() + kept, shown_.end());
  for (std::size_t i = 0; i < owners_.size(); ++i) {
    if (owners_[i] == nothing) continue;
    owners_[i] = renumbered_[static_cast<std::size_t>(owners_[i])];
    Shown& shown = shown_[static_cast<std::size_t>(owners_[i])];
    if (shown.first_pixel == nothing) shown.first_pixel = static_cast<int>(i);
  }
}

void TileScan::scan(const std::vector<Surface>& surfaces, const Projection& projection, const Tile& tile,
                    std::span<const TriangleId> candidates, const Skip& skip) {
  const auto area = static_cast<std::size_t>(tile.width * tile.height);
  owners_.assign(area, nothing);
  if (projection.has_depth())
    nearest_.assign(area, 0.0);
  else
    covered_.assign(area, 0);
  shown_.clear();
  overlapping_ = 0;
  for (const TriangleId& id : candidates) {
    const Surface& surface = surfaces[id.surface];
    const TrianglePlanes planes = projection.planes(surface, id.triangle);
    if (planes.degenerate()) continue;
    if (skip && skip(id, planes.counter_clockwise() != surface.mirrored)) continue;
    const auto own = static_cast<int>(shown_.size());
    bool seen = false;
    if (projection.has_depth()) {
      const double near = projection.near();
      for_each_covered_pixel(tile, planes, [&](int i, double x, double y) {
        const double inverse_w = planes.inverse_w(x, y);
        double& nearest = nearest_[static_cast<std::size_t>(i)];
        int& owner = owners_[static_cast<std::size_t>(i)];
        // Without branches: depths are in no order.
        const bool nearer = (inverse_w > nearest) & !(inverse_w * near > 1);
        nearest = nearer ? inverse_w : nearest;
        owner = nearer ? own : owner;
        seen = seen | nearer;
      });
    } else {
      for_each_covered_pixel(tile, planes, [&](int i, double, double) {
        unsigned char& covered = covered_[static_cast<std::size_t>(i)];
        if (covered == 0) owners_[static_cast<std::size_t>(i)] = own;
        seen = seen | (covered == 0);
        if (covered == 1) ++overlapping_;
        if (covered < 2) ++covered;
      });
    }
    if (seen) shown_.push_back({id, planes, nothing, 0});
  }
  drop_hidden();
}

} // namespace surfgrad::raster
