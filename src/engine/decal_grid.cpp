#include "engine/decal_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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

template <class Visit>
void for_each_cell(const CellRange& range, const Visit& visit) {
  for (int corner = 0; corner < 8; ++corner) {
    std::array<double, 3> cell = range.first;
    bool again = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (((corner >> i) & 1) == 0) continue;
      again = again || range.last[i] == range.first[i];
      cell[i] = range.last[i];
    }
    if (!again) visit(cell);
  }
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
      if (!range.spans_two_at_most()) {
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
