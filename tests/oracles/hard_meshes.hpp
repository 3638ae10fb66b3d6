#pragma once

/// Meshes that are hard on a maker of tangents, made by code.

#include "mesh/triangle_mesh.hpp"

#include <string>
#include <vector>

namespace surfgrad::test {

struct HardMesh {
  std::string name;
  mesh::TriangleMesh mesh; ///< of one UV set
};

/// One of every kind: degenerate triangles and texture areas, mirrored islands, vertices shared by islands,
/// quads cut along either diagonal, crowded vertices and edges, tiny and huge coordinates.
[[nodiscard]] std::vector<HardMesh> hard_meshes();

/// A few triangles over the points of a small lattice, with few normals and texture coordinates: nearly
/// everything about them is degenerate, shared, mirrored or crowded. Different for every seed.
[[nodiscard]] mesh::TriangleMesh lattice_soup(unsigned seed);

/// A few triangles between vertices of zeros of both signs, subnormal and huge numbers. Different for every
/// seed.
[[nodiscard]] mesh::TriangleMesh extreme_soup(unsigned seed);

} // namespace surfgrad::test
