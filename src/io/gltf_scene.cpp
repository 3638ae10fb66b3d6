#include "io/gltf_scene.hpp"

#include "io/model_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

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
mat4<double> compose(vec3<double> translation, vec4<double> rotation, vec3<double> scale) {
  const auto& [x, y, z, w] = rotation;
  const double s = 2.0 / (x * x + y * y + z * z + w * w);
  const mat3<double> r{{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                       {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
                       {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}};
  return {{r.x.x * scale.x, r.x.y * scale.y, r.x.z * scale.z, translation.x},
          {r.y.x * scale.x, r.y.y * scale.y, r.y.z * scale.z, translation.y},
          {r.z.x * scale.x, r.z.y * scale.y, r.z.z * scale.z, translation.z},
          {0, 0, 0, 1}};
}

mat4<double> transform_of(const Document& document, const tinygltf::Node& node, const std::string& place) {
  if (const std::vector<double>& m = node.matrix; !m.empty()) { // column by column
    const double off_affine =
        std::max({std::abs(m[3]), std::abs(m[7]), std::abs(m[11]), std::abs(m[15] - 1.0)});
    if (!(off_affine < affine_tolerance))
      document.fail(place + ".matrix", "has a last row that is not 0 0 0 1", "expected an affine transform");
    return {{m[0], m[4], m[8], m[12]}, {m[1], m[5], m[9], m[13]}, {m[2], m[6], m[10], m[14]}, {0, 0, 0, 1}};
  }
  const auto& [t, r, s] = std::tie(node.translation, node.rotation, node.scale);
  return compose(t.empty() ? vec3<double>{0, 0, 0} : vec3<double>{t[0], t[1], t[2]},
                 r.empty() ? vec4<double>{0, 0, 0, 1} : vec4<double>{r[0], r[1], r[2], r[3]},
                 s.empty() ? vec3<double>{1, 1, 1} : vec3<double>{s[0], s[1], s[2]});
}

/// Walks the nodes and lists each mesh when a node first shows it.
class Walk {
 public:
  Walk(const Document& document, std::span<const double> morph_weights)
      : document_(&document), morph_weights_(morph_weights) {}

  Shown take() {
    std::vector<Visit> pending = roots();
    std::vector<bool> visited(nodes().size(), false);
    while (!pending.empty()) {
      const Visit visit = std::move(pending.back());
      pending.pop_back();
      const std::string place = fmt::format("nodes[{}]", visit.node);
      if (visited[visit.node])
        document_->fail(visit.named_at, place + " is reached twice",
                        "expected a tree: one parent a node and no cycles");
      visited[visit.node] = true;
      const tinygltf::Node& node = nodes()[visit.node];
      const mat4<double> world_from_node = visit.world_from_parent * transform_of(*document_, node, place);
      if (!is_finite(world_from_node))
        document_->fail(place, "its transform is not finite", "expected numbers of moderate size");
      if (node.mesh >= 0) add_objects(visit.node, place, world_from_node);
      push_reversed(node.children, place + ".children", world_from_node, pending);
    }
    if (shown_.objects.empty())
      document_->fail("", "no node of the scene shows a mesh of triangles", "expected at least one");
    if (morph_weights_.size() > most_targets_)
      throw TooManyWeights(
          {.file = document_->file,
           .problem = fmt::format("has {} morph targets but {} weights are given",
                                  most_targets_ == 0 ? "no" : fmt::format("at most {}", most_targets_),
                                  morph_weights_.size()),
           .remedy = fmt::format("expected at most {}", most_targets_)});
    return std::move(shown_);
  }

 private:
  struct Visit {
    std::size_t node;
    std::string named_at; ///< where the document names the node
    mat4<double> world_from_parent;
  };

  [[nodiscard]] const std::vector<tinygltf::Node>& nodes() const { return document_->model.nodes; }

  /// Reversed, so that the stack yields them in the document's order.
  static void push_reversed(const std::vector<int>& references, const std::string& place,
                            const mat4<double>& world_from_parent, std::vector<Visit>& pending) {
    for (std::size_t i = references.size(); i-- > 0;)
      pending.push_back(
          {static_cast<std::size_t>(references[i]), fmt::format("{}[{}]", place, i), world_from_parent});
  }

  /// The nodes that the scene starts from, last first.
  [[nodiscard]] std::vector<Visit> roots() const {
    std::vector<Visit> result;
    const tinygltf::Model& source = document_->model;
    if (!source.scenes.empty()) {
      const auto scene = static_cast<std::size_t>(std::max(source.defaultScene, 0));
      push_reversed(source.scenes[scene].nodes, fmt::format("scenes[{}].nodes", scene), identity, result);
      return result;
    }
    std::vector<bool> is_child(nodes().size(), false);
    for (const tinygltf::Node& node : nodes())
      for (const int child : node.children) is_child[static_cast<std::size_t>(child)] = true;
    for (std::size_t i = is_child.size(); i-- > 0;)
      if (!is_child[i]) result.push_back({i, fmt::format("nodes[{}]", i), identity});
    return result;
  }

  void add_objects(std::size_t index, const std::string& place, const mat4<double>& world_from_node) {
    const tinygltf::Node& node = nodes()[index];
    const auto mesh = static_cast<std::size_t>(node.mesh);
    std::vector<double> weights = weights_of(node, place);
    auto listed = listed_.find({mesh, weights});
    if (listed == listed_.end()) {
      std::vector<std::size_t> places = list_mesh(mesh, weights);
      listed = listed_.try_emplace({mesh, std::move(weights)}, std::move(places)).first;
    }
    const std::vector<std::size_t>& meshes = listed->second;
    if (meshes.size() > most_objects - shown_.objects.size())
      document_->fail(place, fmt::format("the scene shows more than {} meshes", most_objects),
                      "expected fewer");
    std::string name = node.name.empty() ? document_->model.meshes[mesh].name : node.name;
    if (name.empty()) name = place;
    for (const std::size_t m : meshes) shown_.objects.push_back({name, index, m, world_from_node});
  }

  /// One weight for each morph target of the mesh that the node shows: the caller's, else the node's, else
  /// the mesh's, else 0.
  std::vector<double> weights_of(const tinygltf::Node& node, const std::string& place) {
    const tinygltf::Mesh& mesh = document_->model.meshes[static_cast<std::size_t>(node.mesh)];
    const std::string mesh_place = fmt::format("meshes[{}]", node.mesh);
    const std::size_t count = mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i)
      if (const std::size_t other = mesh.primitives[i].targets.size(); other != count)
        document_->fail(fmt::format("{}.primitives[{}].targets", mesh_place, i),
                        fmt::format("has {} entries but primitives[0] has {}", other, count),
                        "expected the same morph targets in all primitives of a mesh");
    const auto require_count = [&](const std::vector<double>& weights, const std::string& owner) {
      if (!weights.empty() && weights.size() != count)
        document_->fail(
            owner + ".weights",
            fmt::format("has {} entries but the mesh has {} morph targets", weights.size(), count),
            "expected one a morph target");
    };
    require_count(mesh.weights, mesh_place);
    require_count(node.weights, place);
    std::vector<double> weights = node.weights.empty() ? mesh.weights : node.weights;
    weights.resize(count, 0.0);
    std::copy_n(morph_weights_.begin(), std::min(morph_weights_.size(), count), weights.begin());
    most_targets_ = std::max(most_targets_, count);
    return weights;
  }

  /// Adds the mesh's primitives, points and lines left out; their places in the list.
  std::vector<std::size_t> list_mesh(std::size_t index, const std::vector<double>& weights) {
    std::vector<std::size_t> places;
    const std::vector<tinygltf::Primitive>& primitives = document_->model.meshes[index].primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      if (primitives[i].mode < TINYGLTF_MODE_TRIANGLES) continue;
      places.push_back(shown_.meshes.size());
      shown_.meshes.push_back({{index, i}, weights});
    }
    return places;
  }

  const Document* document_;
  std::span<const double> morph_weights_;
  /// Places in the list of a mesh with these weights.
  std::map<std::pair<std::size_t, std::vector<double>>, std::vector<std::size_t>> listed_{};
  std::size_t most_targets_ = 0; ///< of the meshes that are shown
  Shown shown_{};
};

} // namespace

std::string PrimitivePlace::text() const { return fmt::format("meshes[{}].primitives[{}]", mesh, primitive); }

const tinygltf::Primitive& primitive_of(const Document& document, PrimitivePlace place) {
  return document.model.meshes[place.mesh].primitives[place.primitive];
}

Shown shown_by(const Document& document, std::span<const double> morph_weights) {
  return Walk(document, morph_weights).take();
}

} // namespace surfgrad::io::gltf
