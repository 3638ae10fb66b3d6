#pragma once

#include <surfgrad/vec.hpp>

#include <cstdint>

namespace surfgrad::engine {

/// The point that the positions of a noise are relative to, in cells of its first octave. Uniform.
struct NoiseOrigin {
  vec3<double> cells{0, 0, 0};
  double lacunarity = 1; ///< cells of an octave, per cell of the one before

  [[nodiscard]] bool moved() const { return cells.x != 0 || cells.y != 0 || cells.z != 0; }
};

/// A point of a lattice: whole cells, and the rest.
struct LatticeOrigin {
  std::uint32_t start; ///< of a MovedLatticeHash, for the whole cells
  vec3<double> rest;   ///< from there to the point, each component in [0, 3]
};

/// The origin in an octave's lattice. Exact up to 2^53 cells away, the last cell's fraction aside.
///
/// skewed  for a lattice of simplices
[[nodiscard]] LatticeOrigin lattice_origin(const NoiseOrigin& origin, int octave, bool skewed);

} // namespace surfgrad::engine
