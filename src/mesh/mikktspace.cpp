#include "mesh/mikktspace.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

// Results equal those of the reference bit for bit: the order of float operations below is part of
// the specification, and sums run over triangles in ascending order.

namespace surfgrad::mesh {
namespace {

using float2 = vec2<float>;
using float3 = vec3<float>;

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// What a corner without any usable triangle gets.
constexpr vec4<float> fallback_tangent{1, 0, 0, -1};

/// A corner is 3 * triangle + {0, 1, 2}; it also names the edge that leaves it.
constexpr std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
constexpr std::uint32_t previous_corner(std::uint32_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

/// False for zero, subnormal and NaN.
bool not_zero(float a) { return std::abs(a) > std::numeric_limits<float>::min(); }
bool not_zero(float3 v) { return not_zero(v.x) || not_zero(v.y) || not_zero(v.z); }

float3 normalize_if_not_zero(float3 v) { return not_zero(v) ? (1.0f / length(v)) * v : v; }

/// Direction of v within the plane perpendicular to n.
float3 project(float3 v, float3 n) { return normalize_if_not_zero(v - dot(n, v) * n); }

bool same(float3 a, float3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// The attributes that make two corners one vertex.
struct Vertices {
  std::span<const float3> positions;
  std::span<const float3> normals;
  std::span<const float2> uvs;

  [[nodiscard]] bool equal(std::uint32_t a, std::uint32_t b) const {
    return same(positions[a], positions[b]) && same(normals[a], normals[b]) && uvs[a].x == uvs[b].x &&
           uvs[a].y == uvs[b].y;
  }

  [[nodiscard]] std::uint64_t hash(std::uint32_t i) const {
    const float3 p = positions[i];
    const float3 n = normals[i];
    std::uint64_t h = 0;
    for (const float a : {p.x, p.y, p.z, n.x, n.y, n.z, uvs[i].x, uvs[i].y}) {
      // Adding 0 makes -0 the +0 it compares equal to. The constants are those of the splitmix64
      // finalizer, which spreads every input bit over the word.
      h = (h ^ std::bit_cast<std::uint32_t>(a + 0.0f)) * 0xbf58476d1ce4e5b9u;
      h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
      h ^= h >> 31;
    }
    return h;
  }
};

/// For each vertex, the first that equals it. A vertex with a NaN equals none.
std::vector<std::uint32_t> weld(const Vertices& vertices) {
  const auto count = static_cast<std::uint32_t>(vertices.positions.size());
  // At most half full, so that probing stays short.
  std::vector<std::uint32_t> table(std::bit_ceil(std::size_t{2} * count + 1), none);
  const std::size_t mask = table.size() - 1;
  std::vector<std::uint32_t> first(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    first[i] = i;
    if (!vertices.equal(i, i)) continue; // kept out of the table: equal NaNs would pile up in one chain
    std::size_t slot = vertices.hash(i) & mask;
    while (table[slot] != none && !vertices.equal(table[slot], i)) slot = (slot + 1) & mask;
    if (table[slot] == none) table[slot] = i;
    first[i] = table[slot];
  }
  return first;
}

/// Directions of +s and +t over one triangle.
struct Face {
  float3 s{0, 0, 0}; ///< unit, or zero
  float3 t{0, 0, 0};
  bool preserves_orientation = false; ///< texture area positive
  bool joins_any = true;              ///< no usable texture area: follows its neighbours
  bool degenerate = false;            ///< two corners at one position
};

/// The mesh as the algorithm sees it: welded corners, faces and edges.
struct Topology {
  Vertices vertices;
  std::vector<std::uint32_t> vertex; ///< [corner] welded vertex
  std::vector<Face> faces;           ///< [triangle]
  std::vector<std::uint32_t> twin;   ///< [corner] the same edge in the other direction, or none

  [[nodiscard]] float3 position(std::uint32_t corner) const { return vertices.positions[vertex[corner]]; }
  [[nodiscard]] float2 uv(std::uint32_t corner) const { return vertices.uvs[vertex[corner]]; }
};

Face make_face(const Topology& mesh, std::uint32_t corner) {
  const float3 p0 = mesh.position(corner);
  const float3 p1 = mesh.position(corner + 1);
  const float3 p2 = mesh.position(corner + 2);
  Face face;
  if (same(p0, p1) || same(p0, p2) || same(p1, p2)) {
    face.degenerate = true;
    return face;
  }
  const float2 uv1 = mesh.uv(corner + 1) - mesh.uv(corner);
  const float2 uv2 = mesh.uv(corner + 2) - mesh.uv(corner);
  const float3 d1 = p1 - p0;
  const float3 d2 = p2 - p0;
  const float area = uv1.x * uv2.y - uv1.y * uv2.x; // twice the signed area in texture space
  face.preserves_orientation = area > 0;
  // dp/ds and dp/dt times the area, by Cramer's rule.
  face.s = uv2.y * d1 - uv1.y * d2;
  face.t = -uv2.x * d1 + uv1.x * d2;
  if (!not_zero(area)) return face;
  const float sign = face.preserves_orientation ? 1.0f : -1.0f;
  const float length_s = length(face.s);
  const float length_t = length(face.t);
  if (not_zero(length_s)) face.s = (sign / length_s) * face.s;
  if (not_zero(length_t)) face.t = (sign / length_t) * face.t;
  face.joins_any = !(not_zero(length_s / std::abs(area)) && not_zero(length_t / std::abs(area)));
  return face;
}

/// Pairs every edge with the one that runs back along it. Where more than two triangles meet, each
/// edge takes the first opposite one that is still free, in the order of the triangles.
std::vector<std::uint32_t> pair_edges(const Topology& mesh) {
  struct Edge {
    std::uint32_t far_vertex; ///< the larger of its two vertices
    std::uint32_t corner;
  };
  const auto corners = static_cast<std::uint32_t>(mesh.vertex.size());
  const auto near_vertex = [&](std::uint32_t c) {
    return std::min(mesh.vertex[c], mesh.vertex[next_corner(c)]);
  };

  // Bucket the edges by their smaller vertex; corners come in ascending order within a bucket.
  std::vector<std::uint32_t> begin(mesh.vertices.positions.size() + 1, 0);
  for (std::uint32_t c = 0; c < corners; ++c)
    if (!mesh.faces[c / 3].degenerate) ++begin[near_vertex(c)];
  std::uint32_t sum = 0;
  for (std::uint32_t& b : begin) {
    const std::uint32_t size = b;
    b = sum;
    sum += size;
  }
  std::vector<Edge> edges(sum);
  std::vector<std::uint32_t> end = begin;
  for (std::uint32_t c = 0; c < corners; ++c)
    if (!mesh.faces[c / 3].degenerate)
      edges[end[near_vertex(c)]++] = {std::max(mesh.vertex[c], mesh.vertex[next_corner(c)]), c};

  std::vector<std::uint32_t> twin(corners, none);
  std::vector<std::uint32_t> waiting; // free edges, all of one direction, first come first served
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    const auto bucket = std::span(edges).subspan(begin[v], begin[v + 1] - begin[v]);
    std::sort(bucket.begin(), bucket.end(), [](const Edge& a, const Edge& b) {
      return a.far_vertex != b.far_vertex ? a.far_vertex < b.far_vertex : a.corner < b.corner;
    });
    std::size_t served = 0;
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      if (i == 0 || bucket[i].far_vertex != bucket[i - 1].far_vertex) {
        waiting.clear();
        served = 0;
      }
      const std::uint32_t corner = bucket[i].corner;
      if (served < waiting.size() && mesh.vertex[waiting[served]] != mesh.vertex[corner]) {
        twin[corner] = waiting[served];
        twin[waiting[served]] = corner;
        ++served;
      } else {
        waiting.push_back(corner);
      }
    }
  }
  return twin;
}

Topology make_topology(const TriangleMesh& mesh, const std::vector<float2>& uvs) {
  const std::uint32_t corners = corner_count(mesh);
  Topology topology{{mesh.positions, mesh.normals, uvs}, {}, {}, {}};
  const std::vector<std::uint32_t> welded = weld(topology.vertices);
  topology.vertex.reserve(corners);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) topology.vertex.push_back(welded[index]);
  topology.faces.reserve(mesh.triangles.size());
  for (std::uint32_t c = 0; c < corners; c += 3) topology.faces.push_back(make_face(topology, c));
  topology.twin = pair_edges(topology);
  return topology;
}

/// Walks the corners around each vertex into groups of one orientation that hang together by edges,
/// and averages each group.
class Grouping {
 public:
  explicit Grouping(Topology& mesh) : mesh_(mesh), grouped_(mesh.vertex.size(), 0) {}

  /// The group of `corner`, sorted; empty if the corner cannot begin one.
  std::span<const std::uint32_t> collect(std::uint32_t corner) {
    group_.clear();
    const Face& face = mesh_.faces[corner / 3];
    if (face.degenerate || face.joins_any || grouped_[corner]) return {};
    const bool orientation = face.preserves_orientation;
    add(corner);
    for (std::uint32_t c = left_of(corner); joins(c, orientation); c = left_of(c)) add(c);
    for (std::uint32_t c = right_of(corner); joins(c, orientation); c = right_of(c)) add(c);
    std::sort(group_.begin(), group_.end());
    return group_;
  }

 private:
  void add(std::uint32_t corner) {
    grouped_[corner] = 1;
    group_.push_back(corner);
  }

  /// The corner at the same vertex across the edge that leaves it.
  [[nodiscard]] std::uint32_t left_of(std::uint32_t corner) const {
    const std::uint32_t twin = mesh_.twin[corner];
    return twin == none ? none : next_corner(twin);
  }
  /// The corner at the same vertex across the edge that reaches it.
  [[nodiscard]] std::uint32_t right_of(std::uint32_t corner) const {
    return mesh_.twin[previous_corner(corner)];
  }

  bool joins(std::uint32_t corner, bool orientation) {
    if (corner == none || grouped_[corner]) return false;
    Face& face = mesh_.faces[corner / 3];
    // The first group to reach a triangle without texture area gives it its orientation.
    if (face.joins_any && !grouped_[corner] && !grouped_[next_corner(corner)] &&
        !grouped_[previous_corner(corner)])
      face.preserves_orientation = orientation;
    return face.preserves_orientation == orientation;
  }

  Topology& mesh_;
  std::vector<std::uint8_t> grouped_; ///< [corner]
  std::vector<std::uint32_t> group_{};
};

/// One corner's part in the average of its group.
struct Share {
  float3 s, t;       ///< projected to the vertex's tangent plane; unit, or zero
  float3 weighted_s; ///< s times the corner's angle; zero if the face joins any
  bool joins_any;
};

Share make_share(const Topology& mesh, std::uint32_t corner) {
  const Face& face = mesh.faces[corner / 3];
  const float3 n = mesh.vertices.normals[mesh.vertex[corner]];
  Share share{project(face.s, n), project(face.t, n), {0, 0, 0}, face.joins_any};
  if (face.joins_any) return share;
  const float3 p = mesh.position(corner);
  const float3 to_previous = project(mesh.position(previous_corner(corner)) - p, n);
  const float3 to_next = project(mesh.position(next_corner(corner)) - p, n);
  float cosine = dot(to_previous, to_next);
  cosine = cosine > 1 ? 1.0f : (cosine < -1 ? -1.0f : cosine);
  share.weighted_s = static_cast<float>(std::acos(static_cast<double>(cosine))) * share.s;
  return share;
}

/// Whether the two corners of a group are averaged: all but exactly opposed directions, which is
/// what the angle threshold of 180 degrees leaves.
bool averaged(const Share& a, const Share& b) {
  return a.joins_any || b.joins_any || (dot(a.s, b.s) > -1 && dot(a.t, b.t) > -1);
}

/// True if no two shares can be opposed because their directions lie well within a half space.
bool unopposed(std::span<const Share> shares, float3 Share::*direction) {
  float3 axis{0, 0, 0};
  for (const Share& share : shares) axis = axis + share.*direction;
  axis = normalize_or_zero(axis);
  return std::all_of(shares.begin(), shares.end(), [&](const Share& share) {
    const float3 v = share.*direction;
    // Two unit vectors that reach 0.01 along an axis have a cosine of at least 2e-4 - 1, far more
    // above -1 than rounding.
    return dot(v, axis) > 0.01f || same(v, {0, 0, 0});
  });
}

vec4<float> finish(float3 sum, bool preserves_orientation) {
  float3 t = normalize_if_not_zero(sum);
  if (!std::isfinite(t.x) || !std::isfinite(t.y) || !std::isfinite(t.z)) t = {1, 0, 0};
  return {t.x, t.y, t.z, preserves_orientation ? 1.0f : -1.0f};
}

/// Writes the tangents of one group.
void average(std::span<const std::uint32_t> group, std::span<const Share> shares, bool orientation,
             std::vector<vec4<float>>& tangents) {
  // Comparing all pairs is quadratic: past this size an input made for it would run for minutes.
  constexpr std::size_t most_compared = 2048;
  if (group.size() > most_compared || (unopposed(shares, &Share::s) && unopposed(shares, &Share::t))) {
    float3 sum{0, 0, 0};
    for (const Share& share : shares) sum = sum + share.weighted_s;
    const vec4<float> tangent = finish(sum, orientation);
    for (const std::uint32_t corner : group) tangents[corner] = tangent;
    return;
  }
  for (std::size_t i = 0; i < group.size(); ++i) {
    float3 sum{0, 0, 0};
    for (std::size_t j = 0; j < group.size(); ++j)
      if (i == j || averaged(shares[i], shares[j])) sum = sum + shares[j].weighted_s;
    tangents[group[i]] = finish(sum, orientation);
  }
}

/// Degenerate triangles take what the first sound corner at the same vertex has.
void fill_degenerate(const Topology& mesh, std::vector<vec4<float>>& tangents) {
  std::vector<std::uint32_t> sound(mesh.vertices.positions.size(), none);
  for (std::uint32_t c = 0; c < mesh.vertex.size(); ++c)
    if (!mesh.faces[c / 3].degenerate && sound[mesh.vertex[c]] == none) sound[mesh.vertex[c]] = c;
  for (std::uint32_t c = 0; c < mesh.vertex.size(); ++c)
    if (mesh.faces[c / 3].degenerate && sound[mesh.vertex[c]] != none)
      tangents[c] = tangents[sound[mesh.vertex[c]]];
}

} // namespace

TangentSpace generate_tangents(const TriangleMesh& mesh, std::size_t uv_set) {
  assert(uv_set < mesh.uv_sets.size());
  const std::vector<float2>& uvs = mesh.uv_sets[uv_set];
  assert(mesh.normals.size() == mesh.positions.size() && uvs.size() == mesh.positions.size());
  assert(mesh.positions.size() < none); // more could not be indexed

  Topology topology = make_topology(mesh, uvs);
  TangentSpace result{std::vector<vec4<float>>(topology.vertex.size(), fallback_tangent)};
  Grouping grouping(topology);
  std::vector<Share> shares;
  for (std::uint32_t c = 0; c < topology.vertex.size(); ++c) {
    const std::span<const std::uint32_t> group = grouping.collect(c);
    if (group.empty()) continue;
    shares.clear();
    for (const std::uint32_t member : group) shares.push_back(make_share(topology, member));
    average(group, shares, topology.faces[c / 3].preserves_orientation, result.corners);
  }
  fill_degenerate(topology, result.corners);
  return result;
}

} // namespace surfgrad::mesh
