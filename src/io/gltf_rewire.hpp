#pragma once

#include "image/image.hpp"
#include "io/gltf_edit.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace surfgrad::io::gltf {

/// Maps over one UV set that materials are to use.
struct BakedMaps {
  std::vector<std::byte> normal_png{};
  const image::Image* roughness = nullptr; ///< its first channel; null: materials keep theirs
  std::size_t uv_set = 0;
  bool is_repeated = false; ///< texture coordinates leave [0, 1]; else the maps end at their borders
};

/// Makes materials of a document use baked maps. Each map is put in once, when first used.
class Rewiring {
 public:
  /// Both must outlive it.
  Rewiring(Edit& edit, const BakedMaps& maps) : edit_(&edit), maps_(&maps) {}

  /// The normal texture becomes the baked one, at scale 1 and without a KHR_texture_transform. With a
  /// roughness, the metallic-roughness texture becomes one with it in G and with the metallic in B that
  /// was there (else 1), and the factor of the roughness becomes 1. All else stays.
  ///
  /// material  an entry of the document to be. Messages call it `place`.
  /// Throws InputError where the metallic to be kept lies over another UV set or cannot be read.
  void rewire(std::size_t material, const std::string& place);

 private:
  [[nodiscard]] int add_texture(std::vector<std::byte> png, const std::string& name);
  void point(nlohmann::ordered_json& info, int texture) const;
  /// The texture of the roughness with the metallic of these values of a material.
  [[nodiscard]] int roughness_texture(const nlohmann::ordered_json& shading, const std::string& place);

  Edit* edit_;
  const BakedMaps* maps_;
  std::optional<int> sampler_{};
  std::optional<int> normal_{};    ///< texture
  std::optional<int> roughness_{}; ///< texture; of materials that have no metallic to keep
};

} // namespace surfgrad::io::gltf
