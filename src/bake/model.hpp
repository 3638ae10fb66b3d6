#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "scene/scene.hpp"

#include <cstddef>
#include <vector>

namespace surfgrad::bake {

/// Maps of a bake, for the model that it was made of.
struct ModelMaps {
  int uv_set = 0;                          ///< that was baked over
  std::vector<std::byte> normal_png{};     ///< in tangent space, encoding rgb, green up
  const image::Image* roughness = nullptr; ///< its first channel; null: materials keep theirs
  bool is_repeated = false; ///< Counts::outside is not 0: the maps repeat beyond the unit square
};

/// The scene's model with the maps, as the bytes of a .glb: see io::encode_baked_model. Of a scene with a
/// displacement it is the displaced mesh, which was baked. Throws as that does, and as displace::displaced.
[[nodiscard]] std::vector<std::byte> encode_model_with_maps(const scene::Scene& scene, ModelMaps maps,
                                                            const Report& report = {});

} // namespace surfgrad::bake
