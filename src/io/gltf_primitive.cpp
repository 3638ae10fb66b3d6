#include "io/gltf_primitive.hpp"

#include "io/gltf_accessor.hpp"
#include "mesh/normals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

/// Reads the vertex attributes of one primitive; all must have as many elements as POSITION.
class Attributes {
 public:
  Attributes(const Document& document, const tinygltf::Primitive& primitive, const std::string& place)
      : document_(&document), accessors_(&primitive.attributes), place_(place + ".attributes") {
    if (!accessors_->contains("POSITION"))
      document.fail(place_, "\"POSITION\" is missing", "expected the key \"POSITION\" here");
    vertex_count_ = read("POSITION", Attribute::position).size() / 3;
  }

  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }

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
    if (vertex_count_ > 0 && count != vertex_count_)
      document_->fail(place, fmt::format("has {} elements but POSITION has {}", count, vertex_count_),
                      "expected one a vertex");
    return result;
  }

  const Document* document_;
  const std::map<std::string, int>* accessors_;
  std::string place_;
  std::size_t vertex_count_ = 0; ///< 0: POSITION is still to be read
};

} // namespace

mesh::TriangleMesh read_primitive(const Document& document, const tinygltf::Primitive& primitive,
                                  const std::string& place, std::uint32_t material, std::size_t tangent_set) {
  const Attributes attributes(document, primitive, place);
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0) {
    indices = read_indices(document, primitive.indices, attributes.vertex_count(), place + ".indices");
  } else {
    indices.resize(attributes.vertex_count());
    std::iota(indices.begin(), indices.end(), 0u);
  }

  mesh::TriangleMesh mesh;
  mesh.triangles = assemble(document, place, primitive.mode, indices);
  mesh.material_of_triangle.assign(mesh.triangles.size(), material);
  mesh.positions = attributes.vectors<vec3<float>>("POSITION", Attribute::position);
  mesh.normals = attributes.vectors<vec3<float>>("NORMAL", Attribute::normal);
  mesh.uv_sets = attributes.uv_sets();
  if (mesh.normals.empty()) return mesh::with_flat_normals(mesh);

  const auto tangents = attributes.vectors<vec4<float>>("TANGENT", Attribute::tangent);
  if (!tangents.empty() && tangent_set < mesh.uv_sets.size()) {
    mesh.tangent_spaces.resize(tangent_set + 1);
    auto& corners = mesh.tangent_spaces[tangent_set].corners;
    corners.reserve(3 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) corners.push_back(tangents[vertex]);
  }
  return mesh;
}

} // namespace surfgrad::io::gltf
