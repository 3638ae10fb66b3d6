#include "mesh/subdivide.hpp"

#include "mesh/bounds.hpp"
#include "mesh/places.hpp"
#include "mesh/precision.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>

namespace surfgrad::mesh {
namespace {

using double3 = vec3<double>;
using Triangle = std::array<std::uint32_t, 3>;

// In double, sums and products of float coordinates neither overflow nor underflow.
vec2<float> halfway(vec2<float> a, vec2<float> b) {
  return {static_cast<float>(0.5 * (static_cast<double>(a.x) + static_cast<double>(b.x))),
          static_cast<float>(0.5 * (static_cast<double>(a.y) + static_cast<double>(b.y)))};
}

vec4<float> halfway(vec4<float> a, vec4<float> b, float sign) {
  const vec3<float> t = narrow(normalize_or_zero(widen({a.x, a.y, a.z}) + widen({b.x, b.y, b.z})));
  return {t.x, t.y, t.z, sign};
}

struct Middle {
  vec3<float> position;
  vec3<float> normal;
};

/// Swapping the ends gives the same bits: it only swaps the terms of sums of two and negates others.
Middle middle_of(double3 a, double3 b, double3 normal_a, double3 normal_b, EdgeShape shape) {
  double3 position = 0.5 * (a + b);
  double3 normal = normalize_or_zero(normal_a + normal_b);
  if (shape == EdgeShape::curved) {
    // What the edge rises above the tangent plane at each end, along its normal; opposite signs, for b
    // sees the edge from its other end.
    const double3 edge = b - a;
    const double3 rise_a = dot(edge, normal_a) * normal_a;
    const double3 rise_b = dot(edge, normal_b) * normal_b;
    // Control points a, a + (edge - rise_a) / 3, b - (edge - rise_b) / 3, b; the cubic at 1/2 ...
    position = position - 0.125 * (rise_a - rise_b);
    // ... and four times its derivative there.
    const double3 along = 4.0 * edge + (rise_a + rise_b);
    const double squared = dot(along, along);
    if (squared > 0) normal = normalize_or_zero(normal - (dot(along, normal) / squared) * along);
  }
  return {narrow(position), narrow(normal)};
}

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  return std::uint64_t{low} << 32 | high;
}

/// Makes the vertex in the middle of each edge once.
class Middles {
 public:
  Middles(TriangleMesh& mesh, EdgeShape shape) : mesh_(&mesh), shape_(shape), first_(mesh.positions.size()) {
    // Most edges belong to two triangles.
    vertex_of_edge_.reserve(mesh.triangles.size() / 2 * 3);
  }

  std::uint32_t vertex(std::uint32_t a, std::uint32_t b) {
    const auto next = static_cast<std::uint32_t>(mesh_->positions.size());
    const auto [entry, is_new] = vertex_of_edge_.try_emplace(edge_key(a, b), next);
    if (is_new) add(a, b);
    return entry->second;
  }

  /// Brings the middles together that the sides of a crease have put in different places: to the centre of
  /// the box around them, which does not depend on their order or on how many of them coincide.
  void close_creases() {
    const Places ends = places_of(std::span(mesh_->positions).first(first_));
    std::unordered_map<std::uint64_t, Bounds> sides;
    sides.reserve(vertex_of_edge_.size());
    const auto place_key = [&](std::uint64_t edge) {
      return edge_key(ends.of_vertex[edge >> 32], ends.of_vertex[edge & 0xffffffff]);
    };
    for (const auto& [edge, vertex] : vertex_of_edge_) {
      const double3 p = widen(mesh_->positions[vertex]);
      Bounds& around = sides[place_key(edge)];
      around = unite(around, {p, p});
    }
    for (const auto& [edge, vertex] : vertex_of_edge_)
      mesh_->positions[vertex] = narrow(center(sides[place_key(edge)]));
  }

 private:
  void add(std::uint32_t a, std::uint32_t b) {
    const auto unit_normal = [&](std::uint32_t i) { return normalize_or_zero(widen(mesh_->normals[i])); };
    const Middle middle = middle_of(widen(mesh_->positions[a]), widen(mesh_->positions[b]), unit_normal(a),
                                    unit_normal(b), shape_);
    mesh_->positions.push_back(middle.position);
    mesh_->normals.push_back(middle.normal);
    for (std::vector<vec2<float>>& uvs : mesh_->uv_sets) uvs.push_back(halfway(uvs[a], uvs[b]));
  }

  TriangleMesh* mesh_;
  EdgeShape shape_;
  std::size_t first_; ///< vertices before this one are not middles
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_edge_{};
};

void split(TriangleMesh& mesh, EdgeShape shape) {
  std::vector<Triangle> triangles;
  triangles.reserve(4 * mesh.triangles.size());
  std::vector<std::uint32_t> materials;
  materials.reserve(4 * mesh.triangles.size());
  Middles middles(mesh, shape);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    const std::uint32_t ab = middles.vertex(a, b);
    const std::uint32_t bc = middles.vertex(b, c);
    const std::uint32_t ca = middles.vertex(c, a);
    triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    materials.insert(materials.end(), 4, mesh.material_of_triangle[i]);
  }
  if (shape == EdgeShape::curved) middles.close_creases();
  for (TangentSpace& space : mesh.tangent_spaces) {
    std::vector<vec4<float>> corners;
    corners.reserve(4 * space.corners.size());
    for (std::size_t i = 0; i < space.corners.size(); i += 3) {
      const vec4<float> a = space.corners[i];
      const vec4<float> b = space.corners[i + 1];
      const vec4<float> c = space.corners[i + 2];
      const vec4<float> ab = halfway(a, b, a.w);
      const vec4<float> bc = halfway(b, c, a.w);
      const vec4<float> ca = halfway(c, a, a.w);
      corners.insert(corners.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    space.corners = std::move(corners);
  }
  mesh.triangles = std::move(triangles);
  mesh.material_of_triangle = std::move(materials);
}

/// No level makes more vertices than triangles: each new vertex is the middle of an edge, and a triangle has
/// three of them at most for itself where it makes three new triangles.
void require_numbers(const TriangleMesh& mesh, int levels) {
  // As many as corner_count() accepts; that many vertices have numbers too.
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() / 3 - 1;
  std::uint64_t triangles = mesh.triangles.size();
  for (int level = 0; level < levels && triangles <= most; ++level) triangles *= 4;
  if (triangles > most || triangles + mesh.positions.size() > 3 * most)
    throw MachineError("the mesh would have more than " + std::to_string(most) + " triangles after " +
                       std::to_string(levels) + " subdivisions of its " +
                       std::to_string(mesh.triangles.size()));
}

} // namespace

TriangleMesh subdivide(const TriangleMesh& mesh, int levels, EdgeShape shape) {
  assert(levels >= 0);
  require_numbers(mesh, levels);
  TriangleMesh result = mesh;
  for (int level = 0; level < levels; ++level) split(result, shape);
  return result;
}

} // namespace surfgrad::mesh
