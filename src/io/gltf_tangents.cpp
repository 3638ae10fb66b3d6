#include "io/gltf_tangents.hpp"

#include "io/gltf_accessor.hpp"
#include "io/gltf_primitive.hpp"
#include "mesh/mikktspace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Bits3 = std::array<std::uint32_t, 3>;
using Bits4 = std::array<std::uint32_t, 4>;

// For a vertex whose normal is zero: the format wants a unit one.
constexpr vec3<float> no_normal{0, 0, 1};

/// Some unit vector perpendicular to a unit vector.
vec3<float> perpendicular(vec3<float> n) {
  const vec3<float> axis = std::abs(n.x) < 0.5f ? vec3<float>{1, 0, 0} : vec3<float>{0, 1, 0};
  const vec3<float> t = normalize_or_zero(axis - dot(axis, n) * n);
  return max_abs(t) > 0 ? t : vec3<float>{1, 0, 0};
}

/// The mesh that tangents are made of: unmorphed, with unit normals where the file gives none.
mesh::TriangleMesh read_mesh(const Document& document, PrimitivePlace place) {
  tinygltf::Primitive primitive = primitive_of(document, place);
  primitive.targets.clear();
  primitive.attributes.erase("TANGENT");
  mesh::TriangleMesh mesh = read_primitive(document, primitive, place.text(), 0, 0, {});
  if (!primitive.attributes.contains("NORMAL")) // those of triangles without area are zero
    for (vec3<float>& n : mesh.normals)
      if (max_abs(n) == 0) n = no_normal;
  return mesh;
}

/// Vertices for the corners: one for each vertex that is used, in its order, and behind them one for each
/// further tangent or normal that it has in another corner.
///
/// normals  one a corner; empty where they belong to the vertices
TangentVertices vertices_of(const std::vector<Triangle>& triangles, const std::vector<vec4<float>>& tangents,
                            const std::vector<vec3<float>>& normals) {
  const std::size_t corners = tangents.size();
  const auto vertex_of = [&](std::size_t corner) { return triangles[corner / 3][corner % 3]; };
  TangentVertices result;

  constexpr std::uint32_t none = 0xFFFFFFFF; // no vertex: there are fewer
  std::uint32_t largest = 0;
  for (const auto& triangle : triangles) largest = std::max(largest, std::ranges::max(triangle));
  std::vector<std::uint32_t> first_corner(std::size_t{largest} + 1, none);
  for (std::size_t corner = corners; corner-- > 0;)
    first_corner[vertex_of(corner)] = static_cast<std::uint32_t>(corner);

  const auto add = [&](std::size_t corner) {
    result.source.push_back(vertex_of(corner));
    result.tangents.push_back(tangents[corner]);
    if (!normals.empty()) result.normals.push_back(normals[corner]);
    return static_cast<std::uint32_t>(result.source.size() - 1);
  };
  std::vector<std::uint32_t> first_vertex(first_corner.size(), none);
  for (std::size_t vertex = 0; vertex < first_corner.size(); ++vertex)
    if (first_corner[vertex] != none) first_vertex[vertex] = add(first_corner[vertex]);
  const std::size_t used = result.source.size();

  using Key = std::pair<Bits4, Bits3>;
  const auto key_of = [&](std::size_t corner) {
    return Key{std::bit_cast<Bits4>(tangents[corner]),
               normals.empty() ? Bits3{} : std::bit_cast<Bits3>(normals[corner])};
  };
  std::map<std::pair<std::uint32_t, Key>, std::uint32_t> further;
  result.indices.reserve(corners);
  for (std::size_t corner = 0; corner < corners; ++corner) {
    const std::uint32_t vertex = vertex_of(corner);
    const Key key = key_of(corner);
    if (key == key_of(first_corner[vertex])) {
      result.indices.push_back(first_vertex[vertex]);
      continue;
    }
    const auto [entry, is_new] = further.try_emplace({vertex, key}, 0);
    if (is_new) entry->second = add(corner);
    result.indices.push_back(entry->second);
  }
  result.split = result.source.size() - used;
  return result;
}

template <class Vector>
std::vector<std::uint32_t> bits_of(const std::vector<Vector>& vectors) {
  std::vector<std::uint32_t> bits;
  for (const Vector& v : vectors) {
    const auto components = std::bit_cast<std::array<std::uint32_t, sizeof(Vector) / 4>>(v);
    bits.insert(bits.end(), components.begin(), components.end());
  }
  return bits;
}

/// An accessor of vectors of floats.
template <class Vector>
int add_floats(Edit& edit, const std::vector<Vector>& vectors, bool is_bounded = false) {
  return edit.add({.type = sizeof(Vector) / sizeof(float), // VECn is the number n
                   .component_type = TINYGLTF_COMPONENT_TYPE_FLOAT,
                   .is_bounded = is_bounded,
                   .bits = bits_of(vectors)},
                  -1);
}

/// like  the accessor of the indices before, or -1
void install_indices(Edit& edit, nlohmann::ordered_json& primitive, const TangentVertices& vertices,
                     int like) {
  // Shorts hold indices below their largest, which may mean a restart.
  const bool is_short = vertices.source.size() <= 0xFFFF;
  primitive["indices"] = edit.add({.type = TINYGLTF_TYPE_SCALAR,
                                   .component_type = is_short ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                                              : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                   .is_index = true,
                                   .bits = vertices.indices},
                                  like);
  primitive.erase("mode"); // a list of triangles
  erase_extension(primitive, "KHR_draco_mesh_compression");
}

/// Puts the vertices and triangles into the document.
class Installer {
 public:
  Installer(Edit& edit, PrimitivePlace place, const TangentVertices& result)
      : edit_(&edit), place_(place), result_(&result), source_(&primitive_of(edit.document(), place)) {}

  void install() {
    nlohmann::ordered_json& written = edit_->primitive(place_);
    for (const auto& [name, accessor] : source_->attributes)
      if (name != "TANGENT") written["attributes"][name] = moved(name, accessor);
    if (!result_->normals.empty()) written["attributes"]["NORMAL"] = add_floats(*edit_, result_->normals);
    written["attributes"]["TANGENT"] = add_floats(*edit_, result_->tangents);
    for (std::size_t i = 0; i < source_->targets.size(); ++i) {
      nlohmann::ordered_json& target = written["targets"][i];
      for (const auto& [name, accessor] : source_->targets[i]) {
        const bool has_base = name != "NORMAL" || result_->normals.empty();
        if (name == "TANGENT" || !has_base)
          target.erase(name);
        else
          target[name] = moved(name, accessor);
      }
    }
    install_indices(*edit_, written, *result_, source_->indices);
  }

 private:
  /// The accessor's elements for the new vertices.
  int moved(const std::string& name, int index) {
    const Document& document = edit_->document();
    const auto& accessors = document.model.accessors;
    const tinygltf::Accessor& accessor = accessors[static_cast<std::size_t>(index)];
    const std::size_t count = accessors[static_cast<std::size_t>(source_->attributes.at("POSITION"))].count;
    if (accessor.count != count)
      document.fail(fmt::format("{}.{}", place_.text(), name),
                    fmt::format("has {} elements but POSITION has {}", accessor.count, count),
                    "expected one a vertex");
    const std::vector<std::uint32_t> bits = read_bits(document, index);
    const std::size_t n = bits.size() / count;
    AccessorData data{.type = accessor.type,
                      .component_type = accessor.componentType,
                      .is_bounded = name == "POSITION" || !accessor.minValues.empty()};
    data.bits.reserve(result_->source.size() * n);
    for (const std::uint32_t vertex : result_->source)
      data.bits.insert(data.bits.end(), bits.begin() + static_cast<std::ptrdiff_t>(vertex * n),
                       bits.begin() + static_cast<std::ptrdiff_t>((vertex + 1) * n));
    return edit_->add(data, index);
  }

  Edit* edit_;
  PrimitivePlace place_;
  const TangentVertices* result_;
  const tinygltf::Primitive* source_;
};

std::vector<vec3<float>> corner_normals(const mesh::TriangleMesh& mesh) {
  std::vector<vec3<float>> normals;
  normals.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) normals.push_back(mesh.normals[vertex]);
  return normals;
}

/// The elements of these vertices.
template <class Vector>
std::vector<Vector> taken(const std::vector<Vector>& all, const std::vector<std::uint32_t>& vertices) {
  std::vector<Vector> some;
  some.reserve(vertices.size());
  for (const std::uint32_t vertex : vertices) some.push_back(all[vertex]);
  return some;
}

} // namespace

std::vector<vec4<float>> corner_tangents(const mesh::TriangleMesh& mesh, std::size_t uv_set,
                                         std::size_t& arbitrary) {
  std::vector<vec4<float>> tangents = mesh::has_tangents(mesh, uv_set)
                                          ? mesh.tangent_spaces[uv_set].corners
                                          : mesh::generate_tangents(mesh, uv_set).corners;
  for (std::size_t corner = 0; corner < tangents.size(); ++corner) {
    vec4<float>& t = tangents[corner];
    if (t.x != 0 || t.y != 0 || t.z != 0) continue;
    const vec3<float> any = perpendicular(mesh.normals[mesh.triangles[corner / 3][corner % 3]]);
    t = {any.x, any.y, any.z, t.w};
    ++arbitrary;
  }
  return tangents;
}

TangentVertices make_tangents(const Document& document, PrimitivePlace place, std::size_t uv_set) {
  const tinygltf::Primitive& primitive = primitive_of(document, place);
  const mesh::TriangleMesh mesh = read_mesh(document, place);
  std::size_t arbitrary = 0;
  const std::vector<vec4<float>> tangents = corner_tangents(mesh, uv_set, arbitrary);
  const bool has_normals = primitive.attributes.contains("NORMAL");
  TangentVertices result = vertices_of(read_triangles(document, primitive, place.text()), tangents,
                                       has_normals ? std::vector<vec3<float>>{} : corner_normals(mesh));
  result.arbitrary = arbitrary;
  return result;
}

void install(Edit& edit, PrimitivePlace place, const TangentVertices& vertices) {
  Installer(edit, place, vertices).install();
}

void install(Edit& edit, PrimitivePlace place, const mesh::TriangleMesh& mesh, std::size_t uv_set) {
  std::size_t arbitrary = 0;
  const TangentVertices vertices = vertices_of(mesh.triangles, corner_tangents(mesh, uv_set, arbitrary), {});
  std::vector<vec3<float>> normals = taken(mesh.normals, vertices.source);
  for (vec3<float>& n : normals)
    if (max_abs(n) == 0) n = no_normal;
  nlohmann::ordered_json attributes;
  attributes["POSITION"] = add_floats(edit, taken(mesh.positions, vertices.source), true);
  attributes["NORMAL"] = add_floats(edit, normals);
  attributes["TANGENT"] = add_floats(edit, vertices.tangents);
  for (std::size_t set = 0; set < mesh.uv_sets.size(); ++set) {
    std::vector<vec2<float>> uvs = taken(mesh.uv_sets[set], vertices.source);
    for (vec2<float>& uv : uvs) uv.y = 1.0f - uv.y;
    attributes[fmt::format("TEXCOORD_{}", set)] = add_floats(edit, uvs);
  }
  nlohmann::ordered_json& written = edit.primitive(place);
  written["attributes"] = std::move(attributes);
  written.erase("targets");
  install_indices(edit, written, vertices, -1);
}

} // namespace surfgrad::io::gltf
