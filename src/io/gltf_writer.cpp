#include "io/gltf_writer.hpp"

#include "io/gltf_check.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <locale>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

// Numbers are copied into bytes as they lie; glTF is little-endian.
static_assert(std::endian::native == std::endian::little);

// A .glb counts its bytes in 32 bits, and so do parsers the bytes of JSON: half of that leaves them room.
constexpr std::size_t most_binary_bytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t most_text_bytes = std::size_t{1} << 30;

// What a node without a matrix has.
constexpr std::array<double, 16> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// Any unit vector: for vertices that no triangle uses, the format wants a tangent all the same.
constexpr vec4<float> unused_tangent{1, 0, 0, 1};

/// The name with bytes that are no UTF-8, such as those of an old OBJ, replaced: JSON holds no others.
std::string as_utf8(const std::string& name) {
  using nlohmann::json;
  return json::parse(json(name).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

/// The vertices of a mesh as the format wants them: one tangent a vertex, not one a corner.
struct Vertices {
  std::vector<std::uint32_t> source;           ///< [vertex] vertex of the mesh
  std::vector<vec4<float>> tangents;           ///< [vertex]; empty: none
  std::vector<std::uint32_t> vertex_of_corner; ///< [3 * triangle + corner]
};

/// The mesh's own vertices, and behind them one for each further tangent that corners give a vertex.
Vertices vertices_of(const mesh::TriangleMesh& mesh) {
  Vertices result;
  const std::size_t count = mesh.positions.size();
  for (std::uint32_t i = 0; i < count; ++i) result.source.push_back(i);
  for (const auto& triangle : mesh.triangles)
    result.vertex_of_corner.insert(result.vertex_of_corner.end(), triangle.begin(), triangle.end());
  // The format's TANGENT goes with the normal texture, and without one with the first UV set.
  if (!mesh::has_tangents(mesh, 0)) return result;

  using Bits = std::array<std::uint32_t, 4>;
  const auto& corners = mesh.tangent_spaces[0].corners;
  result.tangents.assign(count, unused_tangent);
  std::vector<bool> is_set(count, false);
  std::map<std::pair<std::uint32_t, Bits>, std::uint32_t> further;
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    std::uint32_t& vertex = result.vertex_of_corner[corner];
    const auto bits = std::bit_cast<Bits>(corners[corner]);
    if (!is_set[vertex]) {
      is_set[vertex] = true;
      result.tangents[vertex] = corners[corner];
    } else if (std::bit_cast<Bits>(result.tangents[vertex]) != bits) {
      const auto next = static_cast<std::uint32_t>(result.source.size());
      const auto [entry, is_new] = further.try_emplace({vertex, bits}, next);
      if (is_new) {
        result.source.push_back(vertex);
        result.tangents.push_back(corners[corner]);
      }
      vertex = entry->second;
    }
  }
  return result;
}

/// Puts the document together. Each accessor has a bufferView of its own.
class Writer {
 public:
  Writer(const Model& model, std::size_t most_bytes, const std::filesystem::path& file)
      : model_(&model), most_bytes_(most_bytes), file_(&file) {}

  tinygltf::Model write() {
    document_.asset.version = "2.0";
    document_.asset.generator = "surfgrad";
    document_.buffers.resize(1);
    for (const ModelMaterial& material : model_->materials) {
      tinygltf::Material& written = document_.materials.emplace_back();
      written.name = as_utf8(material.name);
      written.doubleSided = material.double_sided;
    }
    for (const mesh::TriangleMesh& mesh : model_->meshes) add_mesh(mesh);
    tinygltf::Scene& scene = document_.scenes.emplace_back();
    for (const ModelObject& object : model_->objects) {
      scene.nodes.push_back(static_cast<int>(document_.nodes.size()));
      add_node(object);
    }
    document_.defaultScene = 0;
    return std::move(document_);
  }

  void require_size(std::size_t bytes) const {
    if (bytes > most_bytes_)
      fail(*file_, "", fmt::format("would have more than {} bytes", most_bytes_),
           most_bytes_ == most_text_bytes ? "write a .glb" : "write a mesh of fewer vertices");
  }

 private:
  static void require(bool is_right) {
    if (!is_right) throw std::invalid_argument("encode_model: an array or index does not match the model");
  }

  void add_node(const ModelObject& object) {
    require(object.mesh < model_->meshes.size());
    tinygltf::Node& node = document_.nodes.emplace_back();
    node.name = as_utf8(object.name);
    node.mesh = static_cast<int>(object.mesh);
    const mat4<double>& m = object.world_from_object;
    node.matrix = {m.x.x, m.y.x, m.z.x, m.w.x, m.x.y, m.y.y, m.z.y, m.w.y, // column by column
                   m.x.z, m.y.z, m.z.z, m.w.z, m.x.w, m.y.w, m.z.w, m.w.w};
    const auto is_finite = [](double number) { return std::isfinite(number); };
    if (!std::ranges::all_of(node.matrix, is_finite))
      fail(*file_, "object \"" + node.name + "\"", "its transform is not finite", "expected finite numbers");
    if (std::ranges::equal(node.matrix, identity)) node.matrix.clear();
  }

  void add_mesh(const mesh::TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    require(mesh.normals.size() == count && mesh.material_of_triangle.size() == mesh.triangles.size());
    for (const auto& triangle : mesh.triangles) require(std::ranges::max(triangle) < count);
    require(!mesh::has_tangents(mesh, 0) ||
            mesh.tangent_spaces[0].corners.size() == 3 * mesh.triangles.size());

    const Vertices vertices = vertices_of(mesh);
    std::map<std::string, int> attributes;
    const auto add = [&](const std::string& key, int components, const auto& of_vertex) {
      attributes[key] = add_attribute(key, components, vertices.source.size(), of_vertex);
    };
    add("POSITION", 3, [&](std::size_t i) { return array_of(mesh.positions[vertices.source[i]]); });
    bound_positions(attributes["POSITION"], mesh.positions);
    add("NORMAL", 3, [&](std::size_t i) { return array_of(mesh.normals[vertices.source[i]]); });
    for (std::size_t set = 0; set < mesh.uv_sets.size(); ++set) {
      require(mesh.uv_sets[set].size() == count);
      add(fmt::format("TEXCOORD_{}", set), 2, [&](std::size_t i) {
        const vec2<float> st = mesh.uv_sets[set][vertices.source[i]];
        return std::array{st.x, 1.0f - st.y};
      });
    }
    if (!vertices.tangents.empty())
      add("TANGENT", 4, [&](std::size_t i) {
        const vec4<float> t = vertices.tangents[i];
        return std::array{t.x, t.y, t.z, t.w};
      });

    // One primitive a material; all share the vertices.
    tinygltf::Mesh& written = document_.meshes.emplace_back();
    for (const std::uint32_t material :
         std::set<std::uint32_t>(mesh.material_of_triangle.begin(), mesh.material_of_triangle.end())) {
      require(material < model_->materials.size());
      std::vector<std::uint32_t> indices;
      for (std::size_t corner = 0; corner < vertices.vertex_of_corner.size(); ++corner)
        if (mesh.material_of_triangle[corner / 3] == material)
          indices.push_back(vertices.vertex_of_corner[corner]);
      tinygltf::Primitive& primitive = written.primitives.emplace_back();
      primitive.attributes = attributes;
      primitive.material = static_cast<int>(material);
      primitive.mode = TINYGLTF_MODE_TRIANGLES;
      primitive.indices =
          add_accessor(std::as_bytes(std::span(indices)), indices.size(), TINYGLTF_TYPE_SCALAR,
                       TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    }
  }

  static std::array<float, 3> array_of(vec3<float> v) { return {v.x, v.y, v.z}; }

  /// The accessor of floats of_vertex(i), all finite.
  template <class OfVertex>
  int add_attribute(const std::string& key, int components, std::size_t count, const OfVertex& of_vertex) {
    std::vector<float> numbers;
    numbers.reserve(count * static_cast<std::size_t>(components));
    for (std::size_t i = 0; i < count; ++i)
      for (const float number : of_vertex(i)) {
        if (!std::isfinite(number))
          fail(*file_, fmt::format("meshes[{}].{}", document_.meshes.size(), key),
               fmt::format("vertex {} is {}", i, number), "expected finite numbers");
        numbers.push_back(number);
      }
    return add_accessor(std::as_bytes(std::span(numbers)), count, components, // VECn is the number n
                        TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TARGET_ARRAY_BUFFER);
  }

  int add_accessor(std::span<const std::byte> bytes, std::size_t count, int type, int component, int target) {
    std::vector<unsigned char>& buffer = document_.buffers[0].data;
    tinygltf::BufferView& view = document_.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = buffer.size(); // all numbers have four bytes: aligned as the format demands
    view.byteLength = bytes.size();
    view.target = target;
    require_size(buffer.size() + bytes.size());
    const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
    buffer.insert(buffer.end(), first, first + bytes.size());
    tinygltf::Accessor& accessor = document_.accessors.emplace_back();
    accessor.bufferView = static_cast<int>(document_.bufferViews.size()) - 1;
    accessor.componentType = component;
    accessor.count = count;
    accessor.type = type;
    return static_cast<int>(document_.accessors.size()) - 1;
  }

  /// The format demands the range of POSITION.
  void bound_positions(int accessor, std::span<const vec3<float>> positions) {
    std::vector<double> low(3, std::numeric_limits<double>::infinity());
    std::vector<double> high(3, -std::numeric_limits<double>::infinity());
    for (const vec3<float>& position : positions) {
      const std::array<float, 3> p = array_of(position);
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], static_cast<double>(p[i]));
        high[i] = std::max(high[i], static_cast<double>(p[i]));
      }
    }
    document_.accessors[static_cast<std::size_t>(accessor)].minValues = low;
    document_.accessors[static_cast<std::size_t>(accessor)].maxValues = high;
  }

  const Model* model_;
  std::size_t most_bytes_;
  const std::filesystem::path* file_;
  tinygltf::Model document_{};
};

} // namespace

std::vector<std::byte> encode(const Model& model, bool is_binary, const std::filesystem::path& file) {
  Writer writer(model, is_binary ? most_binary_bytes : most_text_bytes, file);
  const tinygltf::Model document = writer.write();
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.exceptions(std::ios::badbit); // lets bad_alloc out
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&document, stream, true, is_binary);
  const std::string_view written = stream.view();
  writer.require_size(written.size());
  const auto bytes = std::as_bytes(std::span(written));
  return {bytes.begin(), bytes.end()};
}

} // namespace surfgrad::io::gltf
