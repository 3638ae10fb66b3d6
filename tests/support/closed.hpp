#pragma once

/// Whether a mesh is closed, to the bit.

#include "mesh/places.hpp"
#include "mesh/triangle_mesh.hpp"

#include <cstdlib>
#include <map>
#include <utility>

namespace surfgrad::test {

/// How many edges, told by the places of their ends, no other triangle runs along in the other direction.
/// Triangles with two corners at one place have no sides there.
inline long open_edges(const mesh::TriangleMesh& mesh) {
  const mesh::Places places = mesh::places_of(mesh.positions);
  std::map<std::pair<std::uint32_t, std::uint32_t>, long> surplus;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = places.of_vertex[triangle[i]];
      const std::uint32_t b = places.of_vertex[triangle[(i + 1) % 3]];
      if (a < b) ++surplus[{a, b}];
      if (b < a) --surplus[{b, a}];
    }
  long open = 0;
  for (const auto& [edge, count] : surplus) open += std::abs(count);
  return open;
}

} // namespace surfgrad::test
