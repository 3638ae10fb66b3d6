#pragma once

#include "mesh/triangle_mesh.hpp"

#include <cstddef>

namespace surfgrad::mesh {

/// How many triangles' given tangents have another handedness than their texture coordinates: such a
/// file shows its relief inverted along one axis. Triangles without texture area do not count.
///
/// uv_set  a set whose tangent space the mesh holds
[[nodiscard]] inline std::size_t contradicting_triangles(const TriangleMesh& mesh, std::size_t uv_set) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto st = [&](std::size_t corner) {
      const vec2<float> v = mesh.uv_sets[uv_set][mesh.triangles[i][corner]];
      return vec2<double>{v.x, v.y};
    };
    const double area = cross(st(1) - st(0), st(2) - st(0));
    const double sign = static_cast<double>(mesh.tangent_spaces[uv_set].corners[3 * i].w);
    if (area * sign < 0) ++count;
  }
  return count;
}

} // namespace surfgrad::mesh
