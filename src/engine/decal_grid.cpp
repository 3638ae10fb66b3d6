#include "engine/decal_grid.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace surfgrad::engine {
namespace {

/// The cells that a box touches: those from first to last along each axis.
struct CellRange {
  std::array<double, 3> first, last;

  [[nodiscard]] bool spans_two_at_most() const {
    for (std::size_t i = 0; i < 3; ++i)
      if (last[i] - first[i] > 1) return false;
    return true;
  }
  [[nodiscard]] double count() const {
    return (last[0] - first[0] + 1) * (last[1] - first[1] + 1) * (last[2] - first[2] + 1);
  }
};

CellRange cells_of(const Bounds& box, int exponent) {
  // A division by a power of two is exact, and floor is monotonic: a point's cell lies within the range
  // of every box that holds it.
  const auto cell = [&](vec3<double> p) -> std::array<double, 3> {
    return {std::floor(std::ldexp(p.x, -exponent)), std::floor(std::ldexp(p.y, -exponent)),
            std::floor(std::ldexp(p.z, -exponent))};
  };
  return {cell(box.low), cell(box.high)};
}

Bounds overlap(const Bounds& a, const Bounds& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y), std::min(a.high.z, b.high.z)}};
}

template <class Visit>
void for_each_cell(const CellRange& range, const Visit& visit) {
  for (double z = 0; z <= range.last[2] - range.first[2]; ++z)
    for (double y = 0; y <= range.last[1] - range.first[1]; ++y)
      for (double x = 0; x <= range.last[0] - range.first[0]; ++x)
        visit({range.first[0] + x, range.first[1] + y, range.first[2] + z});
}

/// The least exponent whose cells the box touches two of along each axis at most.
int exponent_of(const Bounds& box) {
  const vec3<double> extent = box.high - box.low;
  const double largest = std::max({extent.x, extent.y, extent.z, 0x1p-1000});
  int exponent = std::ilogb(largest);
  while (!cells_of(box, exponent).spans_two_at_most()) ++exponent;
  return exponent;
}

} // namespace

std::size_t DecalGrid::CellHash::operator()(const Cell& cell) const {
  std::uint64_t h = 0;
  for (const double c : cell) {
    // -0 is the same cell as 0.
    h = (h ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15u;
    h ^= h >> 32;
  }
  return static_cast<std::size_t>(h);
}

DecalGrid::DecalGrid(std::vector<Bounds> boxes) : boxes_(std::move(boxes)) {
  static std::atomic<std::uint64_t> lists{0};
  id_ = ++lists;
  for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
    const int exponent = exponent_of(boxes_[i]);
    Level& level = levels_[exponent];
    level.boxes.push_back(i);
    for_each_cell(cells_of(boxes_[i], exponent), [&](const Cell& cell) { level.cells[cell].push_back(i); });
  }
}

std::span<const std::uint32_t> DecalGrid::search(std::span<const Bounds> where) const {
  thread_local std::vector<std::uint32_t> found;
  found.clear();
  const auto add = [&](const std::vector<std::uint32_t>& boxes, const Bounds& query) {
    for (const std::uint32_t i : boxes)
      if (meet(boxes_[i], query)) found.push_back(i);
  };
  for (const auto& entry : levels_)
    for (const Bounds& query : where) {
      const Level& level = entry.second;
      const CellRange range = cells_of(query, entry.first);
      // To find a cell takes as long as to look at a few boxes.
      if (!(range.count() <= std::max(8.0, static_cast<double>(level.boxes.size()) / 8))) {
        add(level.boxes, query);
        continue;
      }
      for_each_cell(range, [&](const Cell& cell) {
        const auto here = level.cells.find(cell);
        if (here != level.cells.end()) add(here->second, query);
      });
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void DecalGrid::Neighbourhood::move_to(const DecalGrid& there, const Bounds& where, double reach) {
  const double side = reach < std::numeric_limits<double>::max() ? reach : 0;
  const auto around = [&](double share) {
    const vec3<double> room{share * side, share * side, share * side};
    return Bounds{where.low - room, where.high + room};
  };
  if (grid != there.id_ || !holds(whole.bounds, where)) {
    grid = there.id_;
    whole.bounds = around(1);
    const auto meeting = there.search({&whole.bounds, 1});
    whole.boxes.assign(meeting.begin(), meeting.end());
  }
  part = whole;
  // All boxes of the part are looked at for every place in it.
  constexpr std::size_t crowd = 32;
  for (double share = 0.25; share > 0.01 && part.boxes.size() > crowd; share *= 0.25) {
    part.bounds = overlap(whole.bounds, around(share));
    std::erase_if(part.boxes, [&](std::uint32_t i) { return !meet(there.boxes_[i], part.bounds); });
  }
}

std::span<const std::uint32_t> DecalGrid::near(const Bounds& where, double reach) const {
  if (boxes_.empty()) return {};
  // More grids than these in use at a time take the places from each other: slower, as correct.
  thread_local std::array<Neighbourhood, 16> remembered;
  Neighbourhood& about = remembered[id_ % remembered.size()];
  if (about.grid != id_ || !holds(about.part.bounds, where)) about.move_to(*this, where, reach);
  about.found.clear();
  for (const std::uint32_t i : about.part.boxes)
    if (meet(boxes_[i], where)) about.found.push_back(i);
  return about.found;
}

std::size_t DecalGrid::most_looks() const {
  std::size_t sum = 0;
  for (const auto& [exponent, level] : levels_) {
    std::size_t fullest = 0;
    for (const auto& [cell, boxes] : level.cells) fullest = std::max(fullest, boxes.size());
    sum += fullest;
  }
  return sum;
}

} // namespace surfgrad::engine
