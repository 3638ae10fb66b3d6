#pragma once

#include "scene/scene.hpp"

#include <vector>

namespace surfgrad::bake {

/// A unit square of the UV plane with a map of its own. UDIM counts them from 1001 at the origin, ten in a
/// row along s, rows along t.
struct UdimTile {
  int column = 0; ///< 0 to 9
  int row = 0;
  [[nodiscard]] int number() const { return 1001 + column + 10 * row; }
};

/// The tiles that a scene's triangles have a part of their area in, in the order of their numbers.
///
/// Throws InputError where a mesh lacks the UV set, none of its triangles has an area there, or one reaches
/// out of the columns 0 to 9, below row 0 or beyond tile 9999.
[[nodiscard]] std::vector<UdimTile> udim_tiles(const scene::Scene& scene, int uv_set);

} // namespace surfgrad::bake
