// What artists are promised: a map decodes to the normals that were composed, on real models and the demo.

#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "io/image_file.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

namespace surfgrad::bake {
namespace {

struct Model {
  const char* name;
  const char* mesh; ///< of the shared assets; empty: the demo
  std::string layers;
};

void PrintTo(const Model& model, std::ostream* out) { *out << model.name; }

const Model models[] = {
    {"suzanne", "mesh/blenderio_suzanne/02_suzanne.gltf", ""},
    {"normal_tangent_test", "mesh/khr_NormalTangentTest/NormalTangentTest.glb", ""},
    {"normal_tangent_mirror_test", "mesh/khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb", ""},
    {"ogre_mirrored_uv", "mesh/ogre_mirrored_uv/testmirroreduvmesh_converted.obj",
     R"({ "type": "normal_map", "map": "@/normal_tile/ogre_nm/NMBalls.png", "green": "down" },
        { "type": "noise", "function": "turbulence", "frequency": 0.2, "scale": 0.3 })"},
    {"pirate", "mesh/mmikk_meshes/LP_Pirate.obj",
     R"({ "type": "normal_map", "map": "@/normal_tile/mmikk_details/Pirate_details.png", "tile": 8 },
        { "type": "normal_map", "map": "@/normal_tile/mmikk_details/sofa.png", "tile": 6, "basis": "derived",
          "mask": { "map": "@/mask/mmikk_masks/Pirate_Mask_rgb.png", "channel": "g" }, "blend": "mix" })"},
    {"demo", "", ""},
};

class Targets : public testing::TestWithParam<Model> {};

scene::Scene load(const Model& model, const std::filesystem::path& assets) {
  if (std::string(model.mesh).empty()) return scene::demo_scene();
  if (model.layers.empty()) return scene::load_scene(assets / model.mesh);
  std::string document = "{ \"surfgrad\": 1, \"mesh\": \"@/" + std::string(model.mesh) + "\", \"layers\": [" +
                         model.layers + "] }";
  for (std::size_t at = document.find('@'); at != std::string::npos; at = document.find('@', at))
    document.replace(at, 1, assets.generic_string());
  const surfgrad::test::TemporaryFolder folder;
  return scene::load_scene(folder.write("stack.json", std::string_view(document)));
}

TEST_P(Targets, OfTheRoundTripAreMet) {
  const Model& model = GetParam();
  const std::filesystem::path assets = SURFGRAD_SHARED_DIR "/assets";
  if (!std::string(model.mesh).empty() && !std::filesystem::exists(assets / model.mesh))
    GTEST_SKIP() << assets / model.mesh << " is absent";
  const scene::Scene scene = load(model, assets);
  for (const image::Depth depth : {image::Depth::unorm16, image::Depth::unorm8}) {
    const bool dithered = depth == image::Depth::unorm8;
    const Options options{.width = 256, .height = 256, .padding = 16, .depth = depth, .dither = dithered};
    const Baked baked = bake(scene, options);
    const image::Image map =
        io::decode_image(io::encode_image(baked.map, depth, io::ImageFormat::png), "map.png");
    const Verification got = verify(scene, options, map);
    const auto print = [&](const char* how, const Deviation& off) {
      std::printf(
          "  %s, %d bits, %s: mean %.4f, 99.9 %% %.4f, most %.4f degrees at (%d, %d) of %lld; %lld left "
          "out\n",
          model.name, dithered ? 8 : 16, how, off.mean_deg, off.high_deg, off.most_deg, off.x, off.y,
          static_cast<long long>(off.compared), static_cast<long long>(off.left_out));
    };
    print("texels", got.texels);
    print("on screen", got.on_screen);
    EXPECT_GT(got.texels.compared, 10000);
    EXPECT_GT(got.texels.mean_deg, dithered ? 0.01 : 0.0001) << "nothing was bumped or rounded";
    EXPECT_LT(got.texels.left_out, got.texels.compared / 1000);
    // The product's targets.
    EXPECT_LT(got.texels.mean_deg, dithered ? 0.35 : 0.01);
    if (!dithered) {
      EXPECT_LT(got.texels.most_deg, 0.1);
    }
    EXPECT_GT(got.on_screen.compared, 10000);
  }
}

INSTANTIATE_TEST_SUITE_P(Bake, Targets, testing::ValuesIn(models),
                         [](const auto& model) { return std::string(model.param.name); });

} // namespace
} // namespace surfgrad::bake
