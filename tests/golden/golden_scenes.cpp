#include "golden/golden_scenes.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace surfgrad {

std::filesystem::path shared_assets() { return std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets"; }

const std::vector<GoldenScene>& golden_scenes() {
  static const std::string front = R"("camera": { "yaw": 0, "pitch": 0 })";
  static const std::vector<GoldenScene> scenes{
      {"demo", "", R"("camera": { "pitch": 35 })"},
      {"normal_tangent_test", "mesh/khr_NormalTangentTest/NormalTangentTest.glb", front},
      {"normal_tangent_mirror_test", "mesh/khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb", front},
      {"suzanne", "mesh/blenderio_suzanne/02_suzanne.gltf", R"("camera": { "yaw": 25, "pitch": 5 })"},
      {"pirate_details", "mesh/mmikk_meshes/LP_Pirate.obj",
       R"("layers": [ { "type": "normal_map", "map": "@/normal_tile/mmikk_details/Pirate_details.png", "tile": 8 },
                      { "type": "normal_map", "map": "@/normal_tile/mmikk_details/sofa.png", "tile": 6, "basis": "derived",
                        "mask": { "map": "@/mask/mmikk_masks/Pirate_Mask_rgb.png", "channel": "g" }, "blend": "mix" } ],
          "camera": { "yaw": 20, "pitch": 5 })"},
      {"negative_scale", "mesh/khr_NegativeScaleTest/NegativeScaleTest.glb", front},
      {"negative_scale_balls", "mesh/khr_NegativeScaleTest/NegativeScaleTest.glb",
       R"("camera": { "position": [2, -2.25, 10], "target": [2, -2.25, 0], "fov": 20 })"},
      // The plane's own TANGENT contradicts its texture coordinates (the program warns): with tangents
      // the relief is inverted along one axis, so the plane shows the balls in the derived frame.
      {"two_sided_plane_own_map", "mesh/khr_TwoSidedPlane/TwoSidedPlane.gltf",
       R"("camera": { "yaw": 20, "pitch": 40 })"},
      {"two_sided_plane_front", "mesh/khr_TwoSidedPlane/TwoSidedPlane.gltf",
       R"("layers": [ { "type": "normal_map", "map": "@/normal_tile/ogre_nm/NMBalls.png", "green": "down", "basis": "derived" } ],
          "camera": { "yaw": 20, "pitch": 40 })"},
      {"two_sided_plane_back", "mesh/khr_TwoSidedPlane/TwoSidedPlane.gltf",
       R"("layers": [ { "type": "normal_map", "map": "@/normal_tile/ogre_nm/NMBalls.png", "green": "down", "basis": "derived" } ],
          "camera": { "yaw": 20, "pitch": -40 }, "lights": { "sun": { "direction": [0.4, -0.6, 0.7] } })"},
      {"texture_transform", "mesh/khr_TextureTransformMultiTest/TextureTransformMultiTest.glb",
       R"("camera": { "position": [0.45, 0.36, 2], "target": [0.45, 0.36, 0], "fov": 20 })"},
      {"royal_esplanade", "mesh/mmikk_meshes/sphere.obj",
       R"("layers": [], "lights": { "sun": { "direction": [0, 1, 0], "strength": 0 },
          "environment": "@/hdr/royal_esplanade/royal_esplanade_1k.hdr" }, "camera": { "yaw": 0, "pitch": 0 })"},
  };
  return scenes;
}

scene::Scene load(const GoldenScene& golden) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "surfgrad_golden";
  std::filesystem::create_directories(folder);
  // Tests run in parallel processes: each scene has its own document.
  const std::filesystem::path file = folder / (golden.name + ".json");
  const std::string assets = shared_assets().generic_string();
  std::string document = "{ \"surfgrad\": 1,\n";
  if (!golden.model.empty()) document += "\"mesh\": \"@/" + golden.model + "\",\n";
  document += golden.document + " }\n";
  for (std::size_t at = document.find('@'); at != std::string::npos; at = document.find('@', at))
    document.replace(at, 1, assets);
  std::ofstream(file) << document;
  return scene::load_scene(file);
}

} // namespace surfgrad
