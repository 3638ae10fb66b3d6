#include "raster/tile_scan.hpp"

#include <algorithm>
#include <cmath>

namespace surfgrad::raster {

namespace {

/// Pixels of a tile within a box, with one of margin for the rounding of its sides.
struct PixelRange {
  int first, end;

  PixelRange(double low, double high, int tile, int count)
      : first(static_cast<int>(std::clamp(low - tile - 1.5, 0.0, double(count)))),
        end(static_cast<int>(std::clamp(high - tile + 1.5, 0.0, double(count)))) {}
};

/// Columns of a row, from first up to end.
struct Span {
  int first, end;

  /// Leaves those columns x whose slope * x + base exceeds a bound, to within a millionth of a column.
  void clip(double slope, double base, double bound) {
    constexpr double rounding = 1e-6; // of the division: far more than 2^-52 of any column
    if (!(slope < 0) && !(slope > 0)) {
      if (!(base > bound)) end = first;
      return;
    }
    const double border = (bound - base) / slope;
    const double away = bound > 0 ? rounding : -rounding; // into a certain span, out of a possible one
    // NaN, where the edge functions overflow, leaves the span as it is.
    const auto column = [this](double x, int otherwise) {
      return x == x ? static_cast<int>(std::clamp(x, double(first), double(end))) : otherwise;
    };
    if (slope > 0)
      first = column(std::ceil(border + away), first);
    else
      end = column(std::floor(border - away) + 1, end);
  }
};

/// Calls visit(index in the tile of the first, how many, x and y of its centre) for the pixels of a tile that
/// a triangle covers, neighbours in a row together.
template <class Visit>
void for_each_covered_run(const Tile& tile, const TrianglePlanes& planes, const Visit& visit) {
  const TrianglePlanes::Box box = planes.box();
  const PixelRange columns(box.x_low, box.x_high, tile.x, tile.width);
  const PixelRange rows(box.y_low, box.y_high, tile.y, tile.height);
  if (columns.first >= columns.end || rows.first >= rows.end) return;

  // The edge functions decide wherever rounding cannot turn their signs; covers() decides the rest.
  const std::array<vec3<double>, 3>& e = planes.edges();
  const std::array<double, 3> margin = planes.margins(tile.x + tile.width, tile.y + tile.height);
  const double x_first = tile.x + 0.5;
  for (int row = rows.first; row < rows.end; ++row) {
    const double y = tile.y + row + 0.5;
    Span possible{columns.first, columns.end};
    Span certain = possible;
    for (std::size_t i = 0; i < 3; ++i) {
      const double base = e[i].x * x_first + (e[i].y * y + e[i].z);
      possible.clip(e[i].x, base, -margin[i]);
      certain.clip(e[i].x, base, margin[i]);
    }
    const int end = possible.end;
    const int certain_first = std::clamp(certain.first, possible.first, std::max(end, possible.first));
    const int certain_end = std::clamp(certain.end, certain_first, std::max(end, certain_first));
    const auto visit_if_covered = [&](int from, int to) {
      for (int x = from; x < to; ++x)
        if (planes.covers(x_first + x, y)) visit(row * tile.width + x, 1, x_first + x, y);
    };
    visit_if_covered(possible.first, certain_first);
    if (certain_first < certain_end)
      visit(row * tile.width + certain_first, certain_end - certain_first, x_first + certain_first, y);
    visit_if_covered(certain_end, end);
  }
}

} // namespace

void TileScan::drop_hidden() {
  // Neighbours mostly show the same triangle: they are counted together.
  for (std::size_t i = 0; i < owners_.size();) {
    const std::size_t first = i;
    const int owner = owners_[first];
    while (i < owners_.size() && owners_[i] == owner) ++i;
    if (owner != nothing) shown_[static_cast<std::size_t>(owner)].pixels += static_cast<int>(i - first);
  }
  renumbered_.resize(shown_.size());
  int kept = 0;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    renumbered_[i] = kept;
    if (shown_[i].pixels == 0) continue;
    shown_[static_cast<std::size_t>(kept)] = shown_[i];
    shown_[static_cast<std::size_t>(kept++)].first_pixel = nothing;
  }
  shown_.erase(shown_.begin() + kept, shown_.end());
  for (std::size_t i = 0; i < owners_.size();) {
    const std::size_t first = i;
    const int owner = owners_[first];
    while (i < owners_.size() && owners_[i] == owner) ++i;
    if (owner == nothing) continue;
    const int number = renumbered_[static_cast<std::size_t>(owner)];
    std::fill(owners_.begin() + static_cast<std::ptrdiff_t>(first),
              owners_.begin() + static_cast<std::ptrdiff_t>(i), number);
    Shown& shown = shown_[static_cast<std::size_t>(number)];
    if (shown.first_pixel == nothing) shown.first_pixel = static_cast<int>(first);
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
      for_each_covered_run(tile, planes, [&, own, near](int first, int count, double x, double y) {
        double* nearest = &nearest_[static_cast<std::size_t>(first)];
        int* owner = &owners_[static_cast<std::size_t>(first)];
        for (int i = 0; i < count; ++i) {
          const double inverse_w = planes.inverse_w(x + i, y);
          // Without branches: depths are in no order.
          const bool nearer = (inverse_w > nearest[i]) & !(inverse_w * near > 1);
          nearest[i] = nearer ? inverse_w : nearest[i];
          owner[i] = nearer ? own : owner[i];
          seen = seen | nearer;
        }
      });
    } else {
      for_each_covered_run(tile, planes, [&, own](int first, int count, double, double) {
        int* covered = &covered_[static_cast<std::size_t>(first)];
        int* owner = &owners_[static_cast<std::size_t>(first)];
        int uncovered = 0;
        int covered_once = 0;
        for (int i = 0; i < count; ++i) {
          // Both values are read first and no library function is called: so it is vectorised.
          const int before = covered[i];
          const int owned_by = owner[i];
          uncovered += before == 0 ? 1 : 0;
          covered_once += before == 1 ? 1 : 0;
          owner[i] = before == 0 ? own : owned_by;
          covered[i] = before < 2 ? before + 1 : 2;
        }
        seen = seen | (uncovered > 0);
        overlapping_ += covered_once;
      });
    }
    if (seen) shown_.push_back({id, planes, nothing, 0});
  }
  drop_hidden();
}

} // namespace surfgrad::raster
