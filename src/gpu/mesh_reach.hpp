#pragma once

#include "raster/surface.hpp"

#include <cstdint>
#include <vector>

namespace surfgrad::gpu {

/// How far what is interpolated over the triangles of a material strays from unit vectors at right angles:
/// bounds, from the vectors at the corners. Infinite where corners are too far apart for one.
struct MeshReach {
  double tilt_rad = 0;       ///< between the interpolated normal and that of the triangle
  double tangent_length = 1; ///< of a vertex tangent divided by the length of the normal (mikktspace_basis)
  struct Slot {
    double along_normal = 0;     ///< component of that tangent along the normal
    double tangent_tilt_rad = 0; ///< angle between the tangent and the plane at right angles to the normal
  };
  std::vector<Slot> slots{}; ///< parallel to Surface::slots
};

/// derivation  Vectors at the corners, weighted w, of sum 1. With m the direction of the sum of the unit
///             normals n, the interpolated normal is no shorter than its part along m: the least dot(n, m) =
///             c. Its product with the interpolated tangent is the sum of w_i^2 dot(t_i, n_i) and, for each
///             edge, of w_i w_j (dot(t_i, n_j) + dot(t_j, n_i)); the w_i w_j of three edges sum to 1/3 at
///             most. The tangent is no longer than 1.
[[nodiscard]] MeshReach mesh_reach(const std::vector<raster::Surface>& surfaces, std::uint32_t material);

} // namespace surfgrad::gpu
