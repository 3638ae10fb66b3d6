#include "mesh/morph.hpp"

#include "mesh/precision.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace surfgrad::mesh {
namespace {

using List = std::vector<vec3<float>>;

/// Sums of weight * difference, one a vertex, in double: a float is rounded once, at the end. Empty where
/// no target that counts has such differences.
std::vector<vec3<double>> moves_of(std::span<const MorphTarget> targets, std::span<const double> weights,
                                   List MorphTarget::*kind) {
  std::vector<vec3<double>> moves;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const List& list = targets[i].*kind;
    if (weights[i] == 0 || list.empty()) continue;
    moves.resize(list.size(), {0, 0, 0});
    for (std::size_t v = 0; v < list.size(); ++v) {
      const vec3<double> difference{list[v].x, list[v].y, list[v].z};
      moves[v] = moves[v] + weights[i] * difference;
    }
  }
  return moves;
}

vec3<double> moved(vec3<float> v, vec3<double> by) { return vec3<double>{v.x, v.y, v.z} + by; }

} // namespace

TriangleMesh morph(const TriangleMesh& mesh, std::span<const MorphTarget> targets,
                   std::span<const double> weights) {
  assert(targets.size() == weights.size());
  TriangleMesh result = mesh;

  const auto positions = moves_of(targets, weights, &MorphTarget::positions);
  assert(positions.empty() || positions.size() == mesh.positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    result.positions[v] = narrow(moved(mesh.positions[v], positions[v]));

  const auto normals = moves_of(targets, weights, &MorphTarget::normals);
  assert(normals.empty() || normals.size() == mesh.normals.size());
  for (std::size_t v = 0; v < normals.size(); ++v)
    result.normals[v] = narrow(normalize_or_zero(moved(mesh.normals[v], normals[v])));

  const auto tangents = moves_of(targets, weights, &MorphTarget::tangents);
  assert(tangents.empty() || tangents.size() == mesh.positions.size());
  if (tangents.empty()) return result;
  for (TangentSpace& space : result.tangent_spaces)
    for (std::size_t corner = 0; corner < space.corners.size(); ++corner) {
      vec4<float>& tangent = space.corners[corner];
      const std::uint32_t vertex = mesh.triangles[corner / 3][corner % 3];
      const vec3<float> t =
          narrow(normalize_or_zero(moved({tangent.x, tangent.y, tangent.z}, tangents[vertex])));
      tangent = {t.x, t.y, t.z, tangent.w};
    }
  return result;
}

} // namespace surfgrad::mesh
