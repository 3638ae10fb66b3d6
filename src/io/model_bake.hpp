#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "io/model.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace surfgrad::io {

/// A model and the maps that were baked for it.
struct BakedModel {
  /// What it was read from, with these morph weights (ModelOptions). Of a glTF file all is kept; for others,
  /// or where there is none, the model alone is written.
  std::filesystem::path file{};
  std::vector<double> morph_weights{};
  /// The shape that was baked: meshes, objects and materials of read_model, in their order; where
  /// `is_displaced` the meshes are others, each in the place of its own. Not used: the materials' textures.
  Model model{};
  bool is_displaced = false;
  std::vector<bool> is_bumped{}; ///< [material] has layers of its own

  std::vector<std::byte> normal_png{};     ///< the normal map: a PNG in tangent space, green up
  const image::Image* roughness = nullptr; ///< its first channel; null: materials keep theirs
  std::size_t uv_set = 0;                  ///< that the maps lie over; every mesh has it
  bool is_repeated = false;                ///< texture coordinates leave [0, 1]: the maps repeat there
};

/// The model as .glb, with the maps inside and TANGENT as a bake takes it: the file's where it has tangents
/// for that UV set, MikkTSpace's else. The materials that the meshes use get the normal map as normalTexture
/// (scale 1), and the roughness as G of metallicRoughnessTexture, whose B keeps the metallic; those that are
/// neither bumped nor had a normal texture stay as they are.
///
/// glTF  All else is kept, as add_tangents keeps it. A material that other meshes use too, which the scene
/// does
///       not show, is doubled. Meshes that were displaced or morphed are written as they were baked: without
///       morph targets, skins, colours and other attributes, with a warning where they had some; a node that
///       shows another form of the same mesh keeps that.
/// else  As encode_model.
///
/// errors  InputError where the file has changed since, where the metallic to be kept lies over another UV
///         set, for a result beyond 4 GiB; as add_tangents. Cancelled.
[[nodiscard]] std::vector<std::byte> encode_baked_model(BakedModel baked, const Report& report = {});

} // namespace surfgrad::io
