#include "io/gltf_primitive.hpp"

#include "io/gltf_accessor.hpp"
#include "mesh/normals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::io::gltf {
namespace {

/// The format's numbers for primitive modes; 0 to 3 are points and lines.
enum Mode : std::size_t { triangles = 4, triangle_strip = 5, triangle_fan = 6 };

using Triangle = std::array<std::uint32_t, 3>;

/// Triangles in the order and with the corners that the format prescribes for each mode.
std::vector<Triangle> assemble(const Element& primitive, std::size_t mode,
                               const std::vector<std::uint32_t>& indices) {
  const std::size_t count = indices.size();
  if (count < 3 || (mode == triangles && count % 3 != 0))
    primitive.fail(fmt::format("has {} indices", count),
                   mode == triangles ? "expected a multiple of 3" : "expected 3 or more");
  std::vector<Triangle> result;
  if (mode == triangles) {
    result.reserve(count / 3);
    for (std::size_t i = 0; i < count; i += 3) result.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return result;
  }
  result.reserve(count - 2);
  for (std::size_t i = 0; i + 2 < count; ++i) {
    if (mode == triangle_fan) result.push_back({indices[i + 1], indices[i + 2], indices[0]});
    // Every other triangle of a strip is turned over, to face as its neighbours do.
    else
      result.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
  }
  return result;
}

/// Reads the vertex attributes of one primitive; all must have as many elements as POSITION.
class Attributes {
 public:
  Attributes(const Element& element, Buffers& buffers) : element_(element), buffers_(&buffers) {
    positions_ = read_attribute(element_.at("POSITION"), Attribute::position, *buffers_);
  }

  [[nodiscard]] std::size_t vertex_count() const { return positions_.size() / 3; }
  [[nodiscard]] std::vector<vec3<float>> positions() const { return as_vec3(positions_); }

  /// Empty if there are none.
  [[nodiscard]] std::vector<vec3<float>> normals() const {
    return as_vec3(values("NORMAL", Attribute::normal));
  }

  [[nodiscard]] std::vector<vec4<float>> tangents() const {
    const std::vector<float> v = values("TANGENT", Attribute::tangent);
    std::vector<vec4<float>> result(v.size() / 4);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = {v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]};
    return result;
  }

  /// All sets, with t up.
  [[nodiscard]] std::vector<std::vector<vec2<float>>> uv_sets() const {
    const std::vector<std::string> keys = element_.keys();
    const auto count =
        std::ranges::count_if(keys, [](const std::string& key) { return key.starts_with("TEXCOORD_"); });
    std::vector<std::vector<vec2<float>>> sets(static_cast<std::size_t>(count));
    for (std::size_t set = 0; set < sets.size(); ++set) {
      const std::string key = fmt::format("TEXCOORD_{}", set);
      if (!element_.find(key))
        element_.fail(fmt::format("has {} TEXCOORD sets but no {}", count, key),
                      "expected sets numbered from 0");
      const std::vector<float> v = values(key, Attribute::texcoord);
      sets[set].resize(v.size() / 2);
      for (std::size_t i = 0; i < sets[set].size(); ++i) sets[set][i] = {v[2 * i], 1.0f - v[2 * i + 1]};
    }
    return sets;
  }

 private:
  [[nodiscard]] std::vector<float> values(const std::string& key, Attribute attribute) const {
    const auto reference = element_.find(key);
    if (!reference) return {};
    std::vector<float> result = read_attribute(*reference, attribute, *buffers_);
    if (const std::size_t count = result.size() / component_count(attribute); count != vertex_count())
      reference->fail(fmt::format("has {} elements but POSITION has {}", count, vertex_count()),
                      "expected one a vertex");
    return result;
  }

  static std::vector<vec3<float>> as_vec3(const std::vector<float>& v) {
    std::vector<vec3<float>> result(v.size() / 3);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
    return result;
  }

  Element element_;
  Buffers* buffers_;
  std::vector<float> positions_{};
};

} // namespace

std::optional<mesh::TriangleMesh> read_primitive(const Element& primitive, std::uint32_t material,
                                                 std::size_t tangent_set, Buffers& buffers) {
  const std::size_t mode = primitive.whole_or("mode", triangles);
  if (mode < triangles) return std::nullopt;
  if (mode > triangle_fan) primitive.at("mode").fail(fmt::format("is {}", mode), "expected 0 to 6");

  const Attributes attributes(primitive.at("attributes"), buffers);
  std::vector<std::uint32_t> indices;
  if (const auto reference = primitive.find("indices")) {
    indices = read_indices(*reference, attributes.vertex_count(), buffers);
  } else {
    indices.resize(attributes.vertex_count());
    std::iota(indices.begin(), indices.end(), 0u);
  }

  mesh::TriangleMesh mesh;
  mesh.triangles = assemble(primitive, mode, indices);
  mesh.material_of_triangle.assign(mesh.triangles.size(), material);
  mesh.positions = attributes.positions();
  mesh.normals = attributes.normals();
  mesh.uv_sets = attributes.uv_sets();
  if (mesh.normals.empty()) return mesh::with_flat_normals(mesh);

  const std::vector<vec4<float>> tangents = attributes.tangents();
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
