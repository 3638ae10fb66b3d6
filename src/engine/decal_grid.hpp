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

  std::vector<Bounds> boxes_;
  std::map<int, Level> levels_; ///< by the exponent of the cells' size
};

} // namespace surfgrad::engine
