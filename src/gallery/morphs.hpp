#pragma once

#include "mesh/triangle_mesh.hpp"

namespace surfgrad::gallery {

/// What a morphed mesh takes for its vertices' tangents.
enum class MorphedTangents {
  stale,      ///< those of the shape before
  blended,    ///< each target adds its difference, as it does to positions
  recomputed, ///< MikkTSpace of the morphed mesh, when they are asked for
};

/// An upright sheet of edge 2 under three targets at once, which swirl its middle, stretch it sideways
/// and make it bulge. One UV set over [0, 1]^2. Positions and normals are those of the morphed surface
/// whatever the tangents are.
///
/// cells  quads along each edge
[[nodiscard]] mesh::TriangleMesh morphed_sheet(int cells, MorphedTangents tangents);

/// The sheet before the morph: a square facing +z.
[[nodiscard]] mesh::TriangleMesh flat_sheet(int cells);

} // namespace surfgrad::gallery
