#include "io/gltf.hpp"

#include "io/gltf_buffer.hpp"
#include "io/gltf_document.hpp"
#include "io/gltf_material.hpp"
#include "io/gltf_primitive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace surfgrad::io {
namespace {

using gltf::Buffers;
using gltf::Document;
using gltf::Element;

// Exporters multiply matrices in single precision, so the last row is right to a few of its roundings.
constexpr double affine_tolerance = 1e-5;

// N nodes that show one mesh of N primitives ask for N * N objects: bounded, for a file of a
// megabyte could ask for more than any memory holds.
constexpr std::size_t most_objects = std::size_t{1} << 22;

constexpr mat4<double> identity{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

bool is_finite(vec4<double> v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}
bool is_finite(const mat4<double>& m) {
  return is_finite(m.x) && is_finite(m.y) && is_finite(m.z) && is_finite(m.w);
}

/// Translation * rotation * scale. The quaternion (x, y, z, w) need not be of unit length.
mat4<double> compose(vec3<double> translation, const std::array<double, 4>& rotation, vec3<double> scale) {
  const auto [x, y, z, w] = rotation;
  const double s = 2.0 / (x * x + y * y + z * z + w * w);
  const mat3<double> r{{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                       {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
                       {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}};
  return {{r.x.x * scale.x, r.x.y * scale.y, r.x.z * scale.z, translation.x},
          {r.y.x * scale.x, r.y.y * scale.y, r.y.z * scale.z, translation.y},
          {r.z.x * scale.x, r.z.y * scale.y, r.z.z * scale.z, translation.z},
          {0, 0, 0, 1}};
}

mat4<double> read_transform(const Element& node) {
  std::array<double, 16> m{};
  if (node.numbers("matrix", m)) { // column by column
    if (node.find("translation") || node.find("rotation") || node.find("scale"))
      node.fail("has a matrix beside translation, rotation or scale", "expected one or the other");
    const double off_affine =
        std::max({std::abs(m[3]), std::abs(m[7]), std::abs(m[11]), std::abs(m[15] - 1.0)});
    if (!(off_affine < affine_tolerance))
      node.at("matrix").fail("has a last row that is not 0 0 0 1", "expected an affine transform");
    return {{m[0], m[4], m[8], m[12]}, {m[1], m[5], m[9], m[13]}, {m[2], m[6], m[10], m[14]}, {0, 0, 0, 1}};
  }
  std::array<double, 3> translation{0, 0, 0};
  std::array<double, 4> rotation{0, 0, 0, 1};
  std::array<double, 3> scale{1, 1, 1};
  node.numbers("translation", translation);
  node.numbers("rotation", rotation);
  node.numbers("scale", scale);
  return compose({translation[0], translation[1], translation[2]}, rotation, {scale[0], scale[1], scale[2]});
}

/// Puts a model together: walks the nodes and reads each mesh when a node first shows it.
class Reader {
 public:
  explicit Reader(const Document& document)
      : document_(&document), buffers_(document), meshes_(document.count("meshes")) {}

  Model read() {
    model_.materials = gltf::read_materials(*document_, buffers_);
    std::vector<Visit> pending = roots();
    std::vector<bool> visited(document_->count("nodes"), false);
    while (!pending.empty()) {
      const Visit visit = std::move(pending.back());
      pending.pop_back();
      if (visited[visit.node])
        visit.named_at.fail(fmt::format("nodes[{}] is reached twice", visit.node),
                            "expected a tree: one parent a node and no cycles");
      visited[visit.node] = true;
      const Element node = document_->entry("nodes", visit.node);
      const mat4<double> world_from_node = visit.world_from_parent * read_transform(node);
      if (!is_finite(world_from_node))
        node.fail("its transform is not finite", "expected numbers of moderate size");
      add_objects(node, world_from_node);
      if (const auto children = node.find("children")) push_reversed(*children, world_from_node, pending);
    }
    if (model_.objects.empty())
      document_->root().fail("no node of the scene shows a mesh of triangles", "expected at least one");
    return std::move(model_);
  }

 private:
  struct Visit {
    std::size_t node;
    Element named_at; ///< where the document names the node
    mat4<double> world_from_parent;
  };

  /// Reversed, so that the stack yields them in the document's order.
  static void push_reversed(const Element& references, const mat4<double>& world_from_parent,
                            std::vector<Visit>& pending) {
    for (std::size_t i = references.size(); i-- > 0;) {
      const Element reference = references[i];
      pending.push_back({reference.index_into("nodes"), reference, world_from_parent});
    }
  }

  /// The nodes that the scene starts from, last first.
  std::vector<Visit> roots() {
    std::vector<Visit> result;
    const auto scene_index = document_->root().find("scene");
    if (scene_index || document_->count("scenes") > 0) {
      const Element scene = scene_index ? scene_index->entry_of("scenes") : document_->entry("scenes", 0);
      if (const auto nodes = scene.find("nodes")) push_reversed(*nodes, identity, result);
      return result;
    }
    std::vector<bool> is_child(document_->count("nodes"), false);
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (const auto children = document_->entry("nodes", i).find("children"))
        for (std::size_t c = 0; c < children->size(); ++c)
          is_child[(*children)[c].index_into("nodes")] = true;
    for (std::size_t i = is_child.size(); i-- > 0;)
      if (!is_child[i]) result.push_back({i, document_->entry("nodes", i), identity});
    return result;
  }

  void add_objects(const Element& node, const mat4<double>& world_from_node) {
    const auto reference = node.find("mesh");
    if (!reference) return;
    const std::size_t index = reference->index_into("meshes");
    const Element element = document_->entry("meshes", index);
    if (!meshes_[index]) meshes_[index] = read_mesh(element);
    if (meshes_[index]->size() > most_objects - model_.objects.size())
      node.fail(fmt::format("the scene shows more than {} meshes", most_objects), "expected fewer");
    std::string name = node.text_or("name", "");
    if (name.empty()) name = element.text_or("name", "");
    if (name.empty()) name = node.place();
    for (const std::size_t mesh : *meshes_[index]) model_.objects.push_back({name, mesh, world_from_node});
  }

  /// Adds the mesh's primitives to the model; their places there.
  std::vector<std::size_t> read_mesh(const Element& element) {
    std::vector<std::size_t> places;
    const Element primitives = element.at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const Element primitive = primitives[i];
      const std::size_t material = material_of(primitive);
      const auto& normal = model_.materials[material].normal;
      const auto tangent_set = static_cast<std::size_t>(normal ? normal->uv_set : 0);
      auto mesh =
          gltf::read_primitive(primitive, static_cast<std::uint32_t>(material), tangent_set, buffers_);
      if (!mesh) continue;
      places.push_back(model_.meshes.size());
      model_.meshes.push_back(std::move(*mesh));
    }
    return places;
  }

  std::size_t material_of(const Element& primitive) {
    if (const auto reference = primitive.find("material")) return reference->index_into("materials");
    if (!default_material_) {
      default_material_ = model_.materials.size();
      model_.materials.push_back({.name = "default"});
    }
    return *default_material_;
  }

  const Document* document_;
  Buffers buffers_;
  std::vector<std::optional<std::vector<std::size_t>>> meshes_; ///< places in the model, once read
  std::optional<std::size_t> default_material_{};
  Model model_{};
};

} // namespace

Model read_gltf(const std::filesystem::path& file, std::vector<std::byte> bytes) {
  const Document document(file, std::move(bytes));
  return Reader(document).read();
}

} // namespace surfgrad::io
