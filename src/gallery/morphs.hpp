#pragma once

#include "mesh/triangle_mesh.hpp"

namespace surfgrad::gallery {

/// What a morphed mesh takes for its vertices' tangents.
enum class MorphedTangents {
  stale,      ///< those of the shape before
  blended,    ///< each target adds its difference, as it does to positions
  recomputed, ///< MikkTSpace of the morphed mesh, when they are asked for
};

/// An upright tube under three targets at once: one twists it, one bends it and one swells it. uv: s once
/// around, t once along the tube; a seam at s = 0. Normals are those of the morphed surface whatever the
/// tangents are.
///
/// cells  quads around, and as many along
[[nodiscard]] mesh::TriangleMesh morphed_tube(int cells, MorphedTangents tangents);

/// The tube before the morph.
[[nodiscard]] mesh::TriangleMesh straight_tube(int cells);

} // namespace surfgrad::gallery
