#include "io/model_bake.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"
#include "io/gltf_edit.hpp"
#include "io/gltf_rewire.hpp"
#include "io/gltf_tangents.hpp"
#include "io/model_bytes.hpp"
#include "io/model_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace surfgrad::io {
namespace {

using gltf::Edit;
using gltf::PrimitivePlace;
using Json = nlohmann::ordered_json;

bool is_gltf(const std::filesystem::path& file) { return !file.empty() && lower_extension(file) != ".obj"; }

gltf::BakedMaps maps_of(BakedModel& baked) {
  return {std::move(baked.normal_png), baked.roughness, baked.uv_set, baked.is_repeated};
}

void stop_where_asked(const Report& report, double done) {
  if (report.progress && !report.progress(done)) throw Cancelled();
}

/// A model that comes from no glTF file.
std::vector<std::byte> encode_new(BakedModel baked, const Report& report) {
  std::set<std::size_t> used;
  for (mesh::TriangleMesh& mesh : baked.model.meshes) {
    std::size_t arbitrary = 0;
    // The writer takes those of the first set for TANGENT, which has no room for others.
    mesh.tangent_spaces = {{gltf::corner_tangents(mesh, baked.uv_set, arbitrary)}};
    for (vec3<float>& n : mesh.normals)
      if (max_abs(n) == 0) n = {0, 0, 1}; // the format wants unit ones
    used.insert(mesh.material_of_triangle.begin(), mesh.material_of_triangle.end());
  }
  stop_where_asked(report, 0);
  Edit edit(baked.file, encode_model(baked.model, ModelFormat::glb));
  const gltf::BakedMaps maps = maps_of(baked);
  gltf::Rewiring rewiring(edit, maps);
  for (const std::size_t material : used)
    if (baked.is_bumped[material]) rewiring.rewire(material, fmt::format("materials[{}]", material));
  return edit.glb(report);
}

/// A model that comes from a glTF file.
class Rework {
 public:
  Rework(BakedModel& baked, const Report& report)
      : baked_(&baked), report_(report), edit_(baked.file, read_model_bytes(baked.file)),
        shown_(gltf::shown_by(edit_.document(), baked.morph_weights)) {
    const bool is_same = shown_.meshes.size() == baked.model.meshes.size() &&
                         shown_.objects.size() == baked.model.objects.size() &&
                         baked.is_bumped.size() == baked.model.materials.size() &&
                         document().model.materials.size() <= baked.model.materials.size();
    if (!is_same) document().fail("", "has changed since it was baked", "bake it again");
  }

  std::vector<std::byte> glb() {
    find_places();
    reshape();
    rewire();
    return edit_.glb(report_);
  }

 private:
  [[nodiscard]] const gltf::Document& document() const { return edit_.document(); }
  [[nodiscard]] const tinygltf::Primitive& source_of(std::size_t shown) const {
    return gltf::primitive_of(document(), shown_.meshes[shown].place);
  }
  /// Whether its shape is not the file's.
  [[nodiscard]] bool is_moved(std::size_t shown) const {
    return baked_->is_displaced ||
           std::ranges::any_of(shown_.meshes[shown].weights, [](double weight) { return weight != 0; });
  }

  /// Where each mesh goes: its own place, or one in a copy where nodes show other forms of it too.
  void find_places() {
    std::map<std::size_t, std::set<std::size_t>> nodes_of; // by the document's mesh
    const std::vector<tinygltf::Node>& nodes = document().model.nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (nodes[n].mesh >= 0) nodes_of[static_cast<std::size_t>(nodes[n].mesh)].insert(n);
    std::map<std::size_t, std::set<std::size_t>> nodes_showing; // by the shown mesh
    for (const gltf::ShownObject& object : shown_.objects) nodes_showing[object.mesh].insert(object.node);

    // The primitives of a mesh under the same weights are shown by the same nodes.
    std::map<std::pair<std::size_t, std::vector<double>>, std::size_t> copies;
    Json& meshes = edit_.json()["meshes"];
    for (std::size_t i = 0; i < shown_.meshes.size(); ++i) {
      PrimitivePlace place = shown_.meshes[i].place;
      if (is_moved(i)) {
        const std::set<std::size_t>& showing = nodes_showing[i];
        if (nodes_of[place.mesh] != showing) {
          const auto [copy, is_new] =
              copies.try_emplace({place.mesh, shown_.meshes[i].weights}, meshes.size());
          if (is_new) meshes.push_back(Json(meshes[place.mesh]));
          place.mesh = copy->second;
          for (const std::size_t node : showing) edit_.json()["nodes"][node]["mesh"] = place.mesh;
        }
        moved_meshes_.insert(place.mesh);
        moved_nodes_.insert(showing.begin(), showing.end());
      }
      places_.push_back(place);
    }
  }

  [[nodiscard]] bool is_rewired(std::size_t shown) const {
    const std::size_t material = material_of(shown);
    const auto& materials = document().model.materials;
    return baked_->is_bumped[material] ||
           (material < materials.size() && materials[material].normalTexture.index >= 0);
  }
  [[nodiscard]] std::size_t material_of(std::size_t shown) const {
    const int material = source_of(shown).material;
    return material >= 0 ? static_cast<std::size_t>(material) : document().model.materials.size();
  }

  /// Tangents, and the shapes of meshes that were moved.
  void reshape() {
    std::vector<std::size_t> changed;
    std::vector<PrimitivePlace> given_up;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const bool keeps_tangents = mesh::has_tangents(baked_->model.meshes[i], baked_->uv_set);
      if (!is_moved(i) && (keeps_tangents || !is_rewired(i))) continue;
      changed.push_back(i);
      if (places_[i].mesh < document().model.meshes.size()) given_up.push_back(places_[i]);
    }
    edit_.give_up(given_up);
    for (const std::size_t i : changed) {
      stop_where_asked(report_, static_cast<double>(i) / static_cast<double>(places_.size()));
      if (!is_moved(i)) {
        gltf::install(edit_, places_[i], gltf::make_tangents(document(), places_[i], baked_->uv_set));
        continue;
      }
      warn_about_losses(i);
      gltf::install(edit_, places_[i], baked_->model.meshes[i], baked_->uv_set);
    }
    forget_motion();
  }

  void warn_about_losses(std::size_t shown) const {
    const tinygltf::Primitive& primitive = source_of(shown);
    std::string lost;
    for (const auto& [name, accessor] : primitive.attributes)
      if (!name.starts_with("TEXCOORD_") && name != "POSITION" && name != "NORMAL" && name != "TANGENT")
        lost += (lost.empty() ? "" : ", ") + name;
    if (!primitive.targets.empty()) lost += (lost.empty() ? "" : ", ") + std::string("morph targets");
    if (!lost.empty())
      report_.warn(fmt::format("{}: {} is written in the shape that was baked, without its {}",
                               document().file.string(), shown_.meshes[shown].place.text(), lost));
  }

  /// What moves vertices that are no more: morph weights, skins, and the animations of weights.
  void forget_motion() {
    Json& json = edit_.json();
    for (const std::size_t mesh : moved_meshes_) {
      json["meshes"][mesh].erase("weights");
      for (Json& primitive : json["meshes"][mesh]["primitives"]) primitive.erase("targets");
    }
    for (const std::size_t node : moved_nodes_)
      for (const char* key : {"weights", "skin"}) json["nodes"][node].erase(key);
    const auto animations = json.find("animations");
    if (animations == json.end() || !animations->is_array() || moved_nodes_.empty()) return;
    const auto moves_weights = [&](const Json& channel) {
      if (!channel.is_object() || !channel.contains("target")) return false;
      const Json& target = channel["target"];
      return target.is_object() && target.contains("node") && target["node"].is_number_unsigned() &&
             target.contains("path") && target["path"] == "weights" &&
             moved_nodes_.contains(target["node"].get<std::size_t>());
    };
    Json kept = Json::array();
    for (Json& animation : *animations) {
      if (animation.is_object() && animation.contains("channels") && animation["channels"].is_array()) {
        Json channels = Json::array();
        for (Json& channel : animation["channels"])
          if (!moves_weights(channel)) channels.push_back(std::move(channel));
        if (channels.empty()) continue; // the format knows no empty ones
        animation["channels"] = std::move(channels);
      }
      kept.push_back(std::move(animation));
    }
    if (kept.empty())
      json.erase("animations");
    else
      *animations = std::move(kept);
  }

  void rewire() {
    std::map<std::size_t, std::vector<PrimitivePlace>> users; // by the material
    std::set<std::pair<std::size_t, std::size_t>> baked;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      baked.insert({places_[i].mesh, places_[i].primitive});
      if (is_rewired(i)) users[material_of(i)].push_back(places_[i]);
    }
    std::set<int> used_elsewhere;
    const std::vector<tinygltf::Mesh>& meshes = document().model.meshes;
    for (std::size_t m = 0; m < meshes.size(); ++m)
      for (std::size_t p = 0; p < meshes[m].primitives.size(); ++p)
        if (!baked.contains({m, p})) used_elsewhere.insert(meshes[m].primitives[p].material);

    const gltf::BakedMaps maps = maps_of(*baked_);
    gltf::Rewiring rewiring(edit_, maps);
    const std::size_t own_materials = document().model.materials.size();
    for (const auto& [material, places] : users) {
      std::size_t target = material;
      if (material == own_materials || used_elsewhere.contains(static_cast<int>(material))) {
        Json& materials = edit_.json()["materials"];
        target = materials.size();
        materials.push_back(material == own_materials ? Json{{"name", "default"}}
                                                      : Json(materials[material]));
        for (const PrimitivePlace place : places) edit_.primitive(place)["material"] = target;
      }
      rewiring.rewire(target, fmt::format("materials[{}]", material));
    }
  }

  BakedModel* baked_;
  Report report_;
  Edit edit_;
  gltf::Shown shown_;
  std::vector<PrimitivePlace> places_{}; ///< [shown mesh] in the document to be
  std::set<std::size_t> moved_meshes_{}; ///< of the document to be, whose shapes are not the file's
  std::set<std::size_t> moved_nodes_{};  ///< that show them
};

} // namespace

std::vector<std::byte> encode_baked_model(BakedModel baked, const Report& report) {
  if (is_gltf(baked.file)) return Rework(baked, report).glb();
  return encode_new(std::move(baked), report);
}

} // namespace surfgrad::io
