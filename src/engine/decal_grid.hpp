#pragma once

#include <surfgrad/vec.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

namespace surfgrad::engine {

/// An axis-aligned box of space; holds its borders.
struct Bounds {
  vec3<double> low, high;
};

[[nodiscard]] constexpr bool meet(const Bounds& a, const Bounds& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/// Whether a holds all of b.
[[nodiscard]] constexpr bool holds(const Bounds& a, const Bounds& b) {
  return a.low.x <= b.low.x && b.high.x <= a.high.x && a.low.y <= b.low.y && b.high.y <= a.high.y &&
         a.low.z <= b.low.z && b.high.z <= a.high.z;
}

/// Which of many boxes lie somewhere in space, found without looking at all.
///
/// A grid a power of two of the boxes' size: a box lies in the grid whose cells are just large enough that
/// it touches two along each axis at most. So it is listed eight times at most, however large or far away,
/// and a search looks at one cell a size that occurs.
class DecalGrid {
 public:
  DecalGrid() = default;
  explicit DecalGrid(std::vector<Bounds> boxes);

  /// The boxes that meet any of `where`, ascending, each once. Valid until this thread's next search.
  ///
  /// where  finite; of small extent: many cells wide, it costs a look at every box of that size
  [[nodiscard]] std::span<const std::uint32_t> search(std::span<const Bounds> where) const;

  /// The boxes that meet `where`, ascending, each once; quick for places that come one after another and
  /// lie close together. A thread remembers the boxes about a place and looks among those alone until it
  /// leaves the neighbourhood. Valid until this thread's next call.
  ///
  /// where  finite
  /// reach  size of the neighbourhood; changes what it costs, not what is found
  [[nodiscard]] std::span<const std::uint32_t> near(const Bounds& where, double reach) const;

  /// Boxes that a search within one cell looks at, at most: what it costs beside those it finds.
  [[nodiscard]] std::size_t most_looks() const;

 private:
  using Cell = std::array<double, 3>; ///< whole numbers, exact however far away
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };
  struct Level {
    std::vector<std::uint32_t> boxes{};
    std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells{};
  };

  /// Part of space and what is there.
  struct Region {
    Bounds bounds{};
    std::vector<std::uint32_t> boxes{}; ///< that meet it, ascending
  };
  /// What a thread remembers of a grid: a neighbourhood and, where boxes crowd, a smaller part of it.
  struct Neighbourhood {
    std::uint64_t grid = 0;
    Region whole{}, part{};
    std::vector<std::uint32_t> found{};

    void move_to(const DecalGrid& there, const Bounds& where, double reach);
  };

  /// Names the list of boxes: no other list ever has the same, copies of this one do. 0: there are none.
  std::uint64_t id_ = 0;
  std::vector<Bounds> boxes_;
  std::map<int, Level> levels_; ///< by the exponent of the cells' size
};

} // namespace surfgrad::engine
