#include "io/gltf_primitive.hpp"

#include "io/gltf_accessor.hpp"
#include "mesh/morph.hpp"
#include "mesh/normals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::io::gltf {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles in the order and with the corners that the format prescribes for each mode.
std::vector<Triangle> assemble(const Document& document, const std::string& place, int mode,
                               const std::vector<std::uint32_t>& indices) {
  const std::size_t count = indices.size();
  const bool is_list = mode == TINYGLTF_MODE_TRIANGLES;
  if (count < 3 || (is_list && count % 3 != 0))
    document.fail(place, fmt::format("has {} indices", count),
                  is_list ? "expected a multiple of 3" : "expected 3 or more");
  std::vector<Triangle> result;
  if (is_list) {
    result.reserve(count / 3);
    for (std::size_t i = 0; i < count; i += 3) result.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return result;
  }
  result.reserve(count - 2);
  for (std::size_t i = 0; i + 2 < count; ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) result.push_back({indices[i + 1], indices[i + 2], indices[0]});
    // Every other triangle of a strip is turned over, to face as its neighbours do.
    else
      result.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
  }
  return result;
}

using Accessors = std::map<std::string, int>;

/// Reads vertex attributes, each with one element a vertex.
class Attributes {
 public:
  Attributes(const Document& document, const Accessors& accessors, std::string place,
             std::size_t vertex_count)
      : document_(&document), accessors_(&accessors), place_(std::move(place)), vertex_count_(vertex_count) {}

  /// An attribute made of vec3 or vec4; empty if there is none.
  template <class Vector>
  [[nodiscard]] std::vector<Vector> vectors(const std::string& key, Attribute attribute) const {
    const std::vector<float> v = read(key, attribute);
    const std::size_t n = component_count(attribute);
    std::vector<Vector> result(v.size() / n);
    for (std::size_t i = 0; i < result.size(); ++i) {
      result[i].x = v[n * i];
      result[i].y = v[n * i + 1];
      result[i].z = v[n * i + 2];
      if constexpr (requires { result[i].w; }) result[i].w = v[n * i + 3];
    }
    return result;
  }

  /// All sets, with t up.
  [[nodiscard]] std::vector<std::vector<vec2<float>>> uv_sets() const {
    const auto count = std::ranges::count_if(
        *accessors_, [](const auto& attribute) { return attribute.first.starts_with("TEXCOORD_"); });
    std::vector<std::vector<vec2<float>>> sets(static_cast<std::size_t>(count));
    for (std::size_t set = 0; set < sets.size(); ++set) {
      const std::string key = fmt::format("TEXCOORD_{}", set);
      if (!accessors_->contains(key))
        document_->fail(place_, fmt::format("has {} TEXCOORD sets but no {}", count, key),
                        "expected sets numbered from 0");
      const std::vector<float> v = read(key, Attribute::texcoord);
      for (std::size_t i = 0; i < v.size(); i += 2) sets[set].push_back({v[i], 1.0f - v[i + 1]});
    }
    return sets;
  }

 private:
  [[nodiscard]] std::vector<float> read(const std::string& key, Attribute attribute) const {
    const auto accessor = accessors_->find(key);
    if (accessor == accessors_->end()) return {};
    const std::string place = fmt::format("{}.{}", place_, key);
    std::vector<float> result = read_attribute(*document_, accessor->second, attribute, place);
    const std::size_t count = result.size() / component_count(attribute);
    if (count != vertex_count_)
      document_->fail(place, fmt::format("has {} elements but POSITION has {}", count, vertex_count_),
                      "expected one a vertex");
    return result;
  }

  const Document* document_;
  const Accessors* accessors_;
  std::string place_;
  std::size_t vertex_count_;
};

/// How many vertices POSITION gives the primitive; all other attributes must have as many.
std::size_t vertex_count_of(const Document& document, const Accessors& accessors, const std::string& place) {
  const auto positions = accessors.find("POSITION");
  if (positions == accessors.end())
    document.fail(place, "\"POSITION\" is missing", "expected the key \"POSITION\" here");
  return document.model.accessors[static_cast<std::size_t>(positions->second)].count;
}

/// All targets are read, so that a mistake shows whatever the weights; those of weight 0 are left empty.
std::vector<mesh::MorphTarget> read_targets(const Document& document, const tinygltf::Primitive& primitive,
                                            const std::string& place, std::size_t vertex_count,
                                            std::span<const double> weights) {
  std::vector<mesh::MorphTarget> targets(primitive.targets.size());
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Accessors& accessors = primitive.targets[i];
    const std::string target_place = fmt::format("{}.targets[{}]", place, i);
    for (const char* key : {"NORMAL", "TANGENT"})
      if (accessors.contains(key) && !primitive.attributes.contains(key))
        document.fail(fmt::format("{}.{}", target_place, key), "moves what the primitive does not have",
                      fmt::format("expected \"{}\" among its attributes too", key));
    const Attributes attributes(document, accessors, target_place, vertex_count);
    // A tangent's w does not move: its difference is made as a normal's is.
    mesh::MorphTarget target{.positions = attributes.vectors<vec3<float>>("POSITION", Attribute::position),
                             .normals = attributes.vectors<vec3<float>>("NORMAL", Attribute::normal),
                             .tangents = attributes.vectors<vec3<float>>("TANGENT", Attribute::normal)};
    if (weights[i] != 0) targets[i] = std::move(target);
  }
  return targets;
}

bool is_finite(const mesh::TriangleMesh& mesh) {
  const auto finite = [](const auto& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  return std::ranges::all_of(mesh.positions, finite) && std::ranges::all_of(mesh.normals, finite) &&
         std::ranges::all_of(mesh.tangent_spaces,
                             [&](const auto& space) { return std::ranges::all_of(space.corners, finite); });
}

} // namespace

std::vector<Triangle> read_triangles(const Document& document, const tinygltf::Primitive& primitive,
                                     const std::string& place) {
  const std::size_t vertex_count = vertex_count_of(document, primitive.attributes, place + ".attributes");
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = read_indices(document, primitive.indices, vertex_count, place + ".indices");
  } else {
    indices.resize(vertex_count);
    std::iota(indices.begin(), indices.end(), 0u);
  }
  return assemble(document, place, primitive.mode, indices);
}

mesh::TriangleMesh read_primitive(const Document& document, const tinygltf::Primitive& primitive,
                                  const std::string& place, std::uint32_t material, std::size_t tangent_set,
                                  std::span<const double> morph_weights) {
  const std::string attributes_place = place + ".attributes";
  const std::size_t vertex_count = vertex_count_of(document, primitive.attributes, attributes_place);
  const Attributes attributes(document, primitive.attributes, attributes_place, vertex_count);
  mesh::TriangleMesh mesh;
  mesh.positions = attributes.vectors<vec3<float>>("POSITION", Attribute::position);
  mesh.triangles = read_triangles(document, primitive, place);
  mesh.material_of_triangle.assign(mesh.triangles.size(), material);
  mesh.normals = attributes.vectors<vec3<float>>("NORMAL", Attribute::normal);
  mesh.uv_sets = attributes.uv_sets();

  const auto tangents = attributes.vectors<vec4<float>>("TANGENT", Attribute::tangent);
  if (!tangents.empty() && tangent_set < mesh.uv_sets.size()) {
    mesh.tangent_spaces.resize(tangent_set + 1);
    auto& corners = mesh.tangent_spaces[tangent_set].corners;
    corners.reserve(3 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) corners.push_back(tangents[vertex]);
  }

  if (!primitive.targets.empty()) {
    mesh = mesh::morph(mesh, read_targets(document, primitive, place, vertex_count, morph_weights),
                       morph_weights);
    if (!is_finite(mesh))
      document.fail(place + ".targets", "move a vertex farther than a number can tell",
                    "expected smaller weights of its morph targets");
  }
  return mesh.normals.empty() ? mesh::with_flat_normals(mesh) : mesh;
}

} // namespace surfgrad::io::gltf
