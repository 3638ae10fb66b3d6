#include "raster/tile_scan.hpp"

#include "raster/reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfgrad::raster {

namespace {

/// Pixels of a tile within a box, with one of margin for the rounding of its sides.
struct PixelRange {
  int first, end;

  PixelRange(double low, double high, int tile, int count)
      : first(static_cast<int>(std::clamp(low - tile - 1.5, 0.0, double(count)))),
        end(static_cast<int>(std::clamp(high - tile + 1.5, 0.0, double(count)))) {}
};

/// Columns of a row within which all edge functions are positive: possibly, and whatever they are rounded to.
class Columns {
 public:
  explicit Columns(const PixelRange& range)
      : low_(range.first), high_(range.end - 1), certain_low_(low_), certain_high_(high_) {}

  /// Leaves those columns x whose slope * x + base is positive, to within `margin`.
  ///
  /// inverse  1 / slope
  void clip(double slope, double inverse, double base, double margin) {
    constexpr double rounding = 1e-6; // of the border, in columns: far more than 2^-50 of any column
    const double border = -base * inverse;
    const double away = margin * std::abs(inverse) + rounding;
    if (!(border - border == 0) || !(away - away == 0)) {
      // A horizontal edge, or one that overflows: a bound where it clearly is one, else covers() decides.
      if (slope == 0 && base < -margin) high_ = low_ - 1;
      if (!(slope == 0 && base > margin)) certain_high_ = certain_low_ - 1;
    } else if (slope > 0) {
      low_ = std::max(low_, border - away);
      certain_low_ = std::max(certain_low_, border + away);
    } else {
      high_ = std::min(high_, border + away);
      certain_high_ = std::min(certain_high_, border - away);
    }
  }

  /// The first whole column from x on, which is not negative.
  static int from(double x) {
    const int column = static_cast<int>(x);
    return column + (column < x ? 1 : 0);
  }
  /// Calls possible(first, end) and certain(first, end) for runs of columns from left to right.
  template <class Possible, class Certain>
  void visit(const Possible& possible, const Certain& certain) const {
    if (!(low_ <= high_)) return;
    const int first = from(low_);
    const int end = static_cast<int>(high_) + 1;
    if (!(certain_low_ <= certain_high_)) return possible(first, end);
    const int certain_first = from(certain_low_);
    const int certain_end = static_cast<int>(certain_high_) + 1;
    if (certain_first >= certain_end) return possible(first, end);
    possible(first, certain_first);
    certain(certain_first, certain_end);
    possible(certain_end, end);
  }

 private:
  double low_, high_;
  double certain_low_, certain_high_;
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
  const std::array<double, 3> inverse{1 / e[0].x, 1 / e[1].x, 1 / e[2].x};
  const double x_first = tile.x + 0.5;
  for (int row = rows.first; row < rows.end; ++row) {
    const double y = tile.y + row + 0.5;
    Columns within(columns);
    for (std::size_t i = 0; i < 3; ++i)
      within.clip(e[i].x, inverse[i], e[i].x * x_first + (e[i].y * y + e[i].z), margin[i]);
    within.visit(
        [&](int first, int end) {
          for (int x = first; x < end; ++x)
            if (planes.covers(x_first + x, y)) visit(row * tile.width + x, 1, x_first + x, y);
        },
        [&](int first, int end) { visit(row * tile.width + first, end - first, x_first + first, y); });
  }
}

} // namespace

void TileScan::list_runs(const Tile& tile) {
  runs_.clear();
  for (int y = 0; y < tile.height; ++y) {
    const int* row = &owners_[static_cast<std::size_t>(y * tile.width)];
    for (int x = 0; x < tile.width;) {
      const int first = x;
      while (x < tile.width && row[x] == row[first]) ++x;
      if (row[first] != nothing) runs_.push_back({first, y, x - first, row[first]});
    }
  }
}

void TileScan::drop_hidden(const Tile& tile) {
  for (const Run& run : runs_) shown_[static_cast<std::size_t>(run.owner)].pixels += run.count;
  renumbered_.resize(shown_.size());
  int kept = 0;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    renumbered_[i] = kept;
    if (shown_[i].pixels == 0) continue;
    if (static_cast<int>(i) != kept) shown_[static_cast<std::size_t>(kept)] = shown_[i];
    ++kept;
  }
  shown_.erase(shown_.begin() + kept, shown_.end());
  for (Run& run : runs_) {
    const int first = run.y * tile.width + run.x;
    if (const int number = renumbered_[static_cast<std::size_t>(run.owner)]; number != run.owner) {
      run.owner = number;
      std::fill_n(owners_.begin() + first, run.count, number);
    }
    Shown& shown = shown_[static_cast<std::size_t>(run.owner)];
    if (shown.first_pixel == nothing) shown.first_pixel = first;
  }
}

void TileScan::scan(const std::vector<Surface>& surfaces, const Projection& projection, const Tile& tile,
                    std::span<const TriangleId> candidates, const Skip& skip, Coverage coverage) {
  const auto area = static_cast<std::size_t>(tile.width * tile.height);
  owners_.assign(area, nothing);
  runs_.reserve(area);
  if (projection.has_depth())
    nearest_.assign(area, 0.0);
  else
    covered_.assign(area, 0);
  shown_.clear();
  overlapping_ = 0;
  touched_ = 0;
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
  list_runs(tile);
  drop_hidden(tile);
  if (coverage == Coverage::squares) reach_into_squares(surfaces, projection, tile, candidates);
}

void TileScan::reach_into_squares(const std::vector<Surface>& surfaces, const Projection& projection,
                                  const Tile& tile, std::span<const TriangleId> candidates) {
  if (candidates.empty() || std::find(owners_.begin(), owners_.end(), nothing) == owners_.end()) return;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  reached_.assign(owners_.size(), {{}, {0, 0}, infinity});
  for (const TriangleId& id : candidates) {
    const Reach reach(projection.corners(surfaces[id.surface], id.triangle), tile.x + tile.width,
                      tile.y + tile.height);
    if (!reach.has_area()) continue;
    const TrianglePlanes::Box box = reach.planes().box();
    const PixelRange columns(box.x_low, box.x_high, tile.x, tile.width);
    const PixelRange rows(box.y_low, box.y_high, tile.y, tile.height);
    for (int row = rows.first; row < rows.end; ++row) {
      const double y = tile.y + row + 0.5;
      const auto compare = [&](int first, int end) {
        for (int column = first; column < end; ++column) {
          const auto i = static_cast<std::size_t>(row * tile.width + column);
          const double x = tile.x + column + 0.5;
          if (owners_[i] != nothing || !reach.into_square(x, y)) continue;
          const vec2<double> point = reach.nearest(x, y);
          const vec2<double> way = point - vec2<double>{x, y};
          if (const double distance2 = dot(way, way); distance2 < reached_[i].distance2)
            reached_[i] = {id, point, distance2};
        }
      };
      Columns within(columns);
      for (const vec3<double>& e : reach.widened_edges())
        within.clip(e.x, 1 / e.x, e.x * (tile.x + 0.5) + (e.y * y + e.z), 0);
      within.visit(compare, compare);
    }
  }
  for (std::size_t i = 0; i < reached_.size(); ++i) {
    const Reached& reached = reached_[i];
    if (reached.distance2 == infinity) continue;
    owners_[i] = static_cast<int>(shown_.size());
    runs_.push_back({static_cast<int>(i) % tile.width, static_cast<int>(i) / tile.width, 1, owners_[i]});
    shown_.push_back({reached.id, projection.planes(surfaces[reached.id.surface], reached.id.triangle),
                      static_cast<int>(i), 1, reached.point});
    ++touched_;
  }
}

} // namespace surfgrad::raster
