#include "mesh/normals.hpp"

#include "mesh/precision.hpp"

#include <cmath>
#include <cstddef>

namespace surfgrad::mesh {
namespace {

using double3 = vec3<double>;
using Triangle = std::array<std::uint32_t, 3>;

/// Unit normal, or zero for a triangle of zero area or with a non-finite position. In double, differences,
/// products and lengths of float coordinates neither overflow nor underflow.
double3 face_normal(std::span<const vec3<float>> positions, const Triangle& triangle) {
  const double3 p = widen(positions[triangle[0]]);
  const double3 normal = cross(widen(positions[triangle[1]]) - p, widen(positions[triangle[2]]) - p);
  return std::isfinite(dot(normal, normal)) ? normalize_or_zero(normal) : double3{0, 0, 0};
}

} // namespace

std::vector<vec3<float>> generate_normals(std::span<const vec3<float>> positions,
                                          std::span<const Triangle> triangles) {
  std::vector<double3> sums(positions.size(), double3{0, 0, 0});
  for (const Triangle& triangle : triangles) {
    const double3 normal = face_normal(positions, triangle);
    if (max_abs(normal) == 0) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const double3 p = widen(positions[triangle[i]]);
      const double3 a = widen(positions[triangle[(i + 1) % 3]]) - p;
      const double3 b = widen(positions[triangle[(i + 2) % 3]]) - p;
      // Unlike acos, atan2 keeps its precision at angles near 0 and pi.
      const double angle = std::atan2(length(cross(a, b)), dot(a, b));
      sums[triangle[i]] = sums[triangle[i]] + angle * normal;
    }
  }
  std::vector<vec3<float>> normals;
  normals.reserve(sums.size());
  for (const double3& sum : sums) normals.push_back(narrow(normalize_or_zero(sum)));
  return normals;
}

TriangleMesh with_flat_normals(const TriangleMesh& mesh) {
  const std::uint32_t corners = corner_count(mesh);
  TriangleMesh flat;
  flat.positions.reserve(corners);
  flat.normals.reserve(corners);
  flat.triangles.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(flat.positions.size());
    flat.triangles.push_back({first, first + 1, first + 2});
    const vec3<float> normal = narrow(face_normal(mesh.positions, triangle));
    for (const std::uint32_t index : triangle) {
      flat.positions.push_back(mesh.positions[index]);
      flat.normals.push_back(normal);
    }
  }
  for (const std::vector<vec2<float>>& set : mesh.uv_sets) {
    std::vector<vec2<float>>& uvs = flat.uv_sets.emplace_back();
    uvs.reserve(corners);
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t index : triangle) uvs.push_back(set[index]);
  }
  flat.material_of_triangle = mesh.material_of_triangle;
  return flat;
}

} // namespace surfgrad::mesh
