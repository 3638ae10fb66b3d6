#pragma once

#include <surfgrad/vec.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace surfgrad::mesh {

/// Which vertices lie at one place: what was one point of the surface before texture seams and hard edges
/// doubled it.
struct Places {
  std::vector<std::uint32_t> of_vertex{}; ///< one a vertex: number of its place, by first appearance
  std::size_t count = 0;
};

/// Vertices share a place where their coordinates are equal (0 and -0 are); near ones do not.
///
/// positions  finite; at most as many as 32 bits can number
[[nodiscard]] Places places_of(std::span<const vec3<float>> positions);

} // namespace surfgrad::mesh
