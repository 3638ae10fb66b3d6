// Normal maps of other people, and what is known of them.

#include "io/image_file.hpp"
#include "io/model_file.hpp"
#include "maps/inspect.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

namespace surfgrad::maps {
namespace {

namespace fs = std::filesystem;

enum class Known { up, down, cannot_tell };

struct Case {
  const char* file;
  Known green;
  Look look = Look::tangent_normals;
};

// As the list of the shared maps has them: found by the heights they were made of, by their curl, or not at
// all.
const Case cases[] = {
    {"height_normal/mmikk_base/base_height_conv_to_nmap.png", Known::up},
    {"height_normal/acg_Bricks102/Bricks102_NormalGL.jpg", Known::up},
    {"height_normal/acg_Bricks102/Bricks102_NormalDX.jpg", Known::down},
    {"height_normal/acg_Tiles036/Tiles036_1K_Normal.jpg", Known::down},
    {"height_normal/acg_Metal007/Metal007_1K_Normal.jpg", Known::down},
    {"height_normal/bevy_parallax_cube/cube_normal.png", Known::up},
    {"height_normal/godot_wool/wool_normal.png", Known::up},
    {"height_normal/godot_cheese/texture_cheese_normal.png", Known::up},
    {"height_normal/panda_layingrock/layingrock-n.jpg", Known::down}, // red against the heights, green as up
    {"normal_tile/mmikk_details/details.png", Known::up},
    {"normal_tile/mmikk_details/sofa.png", Known::up},
    {"normal_tile/mmikk_details/Pirate_details.png", Known::up},
    {"normal_tile/mx_mesh_wire/mesh_wire_norm.png",
     Known::cannot_tell}, // wires that cross have no one height
    {"normal_tile/ogre_nm/NMBalls.png", Known::down},
    {"normal_tile/ogre_nm/NMStripes.png", Known::down},
    {"normal_tile/yughues_242/pattern_242_normal.png", Known::up},
    {"decal/godot_scifi_1_3/scifi_1_normal.png", Known::up},
    {"decal/godot_scifi_1_3/scifi_3_normal.png", Known::up},
    {"mesh/khr_TwoSidedPlane/TwoSidedPlane_Normal.png", Known::up},
    {"mesh/khr_Box_With_Spaces/Normal Map.png", Known::up},
    {"mesh/mx_boombox/BoomBox_normal.png", Known::up},
    {"mesh/ogre_athene/atheneNormalMap.png", Known::cannot_tell},
    {"mesh/blenderio_suzanne/02_suzanne_Normal.png", Known::cannot_tell},
    {"cube_normal/ogre_nm_cube/nm_fr.png",
     Known::cannot_tell}, // directions about +z: a dome in tangent space too
    {"cube_normal/ogre_nm_cube/nm_bk.png", Known::cannot_tell, Look::other_normals},
    {"cube_normal/ogre_nm_cube/nm_lf.png", Known::cannot_tell, Look::other_normals},
    {"cube_normal/ogre_nm_cube/nm_rt.png", Known::cannot_tell, Look::other_normals},
    {"cube_normal/ogre_nm_cube/nm_up.png", Known::cannot_tell, Look::other_normals},
    {"cube_normal/ogre_nm_cube/nm_dn.png", Known::cannot_tell, Look::other_normals},
    {"height_only/mx_heightmap/plain_heightmap.png", Known::cannot_tell, Look::heights},
    {"mask/mmikk_masks/mask.png", Known::cannot_tell, Look::no_normals},
    {"mask/mmikk_masks/Pirate_Mask_rgb.png", Known::cannot_tell, Look::no_normals},
    {"mask/bevy_alphanoise/AlphaNoise.png", Known::cannot_tell, Look::no_normals},
    {"decal/godot_scifi_1_3/scifi_1_albedo.png", Known::cannot_tell, Look::no_normals},
    {"decal/godot_scifi_1_3/scifi_3_albedo.png", Known::cannot_tell, Look::no_normals},
    {"mesh/khr_TwoSidedPlane/TwoSidedPlane_BaseColor.png", Known::cannot_tell, Look::no_normals},
    {"mesh/khr_TwoSidedPlane/TwoSidedPlane_MetallicRoughness.png", Known::cannot_tell, Look::no_normals},
};

fs::path assets() { return fs::path(SURFGRAD_SHARED_DIR) / "assets"; }

TEST(SharedMaps, EachIsWhatItIsKnownToBe) {
  if (!fs::exists(assets())) GTEST_SKIP() << "no " << assets();
  double least_decided = 1;
  double most_undecided = 0;
  for (const Case& known : cases) {
    SCOPED_TRACE(known.file);
    const fs::path file = assets() / known.file;
    const Inspection found = inspect(io::read_image(file), nullptr, file);
    std::printf("  %-60s agreement %6.3f, %7.1f standard errors; unit %.3f\n", known.file,
                found.green.agreement, found.green.certainty, found.unit_share);
    EXPECT_EQ(found.look, known.look);
    const bool is_decided = found.green.confidence != Confidence::cannot_tell;
    EXPECT_EQ(is_decided, known.green != Known::cannot_tell);
    if (is_decided) {
      EXPECT_EQ(found.green.green, known.green == Known::up ? stack::Green::up : stack::Green::down);
    }
    if (known.look != Look::tangent_normals) continue;
    double& bound = is_decided ? least_decided : most_undecided;
    bound = is_decided ? std::min(bound, std::abs(found.green.agreement))
                       : std::max(bound, std::abs(found.green.agreement));
  }
  std::printf("  decided from %.3f on, undecided up to %.3f\n", least_decided, most_undecided);
}

TEST(SharedMaps, OfModelsHaveGreenUpAsTheirFormatSays) {
  if (!fs::exists(assets())) GTEST_SKIP() << "no " << assets();
  for (const char* model : {"khr_NormalTangentTest/NormalTangentTest.glb",
                            "khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb",
                            "khr_TextureTransformMultiTest/TextureTransformMultiTest.glb",
                            "khr_ClearCoatTest/ClearCoatTest.glb"}) {
    for (const io::ModelMaterial& material : io::read_model(assets() / "mesh" / model).materials) {
      if (!material.normal) continue;
      const Inspection found = inspect(*material.normal->image, nullptr, material.normal->name);
      std::printf("  %-60s %s: agreement %6.3f\n", model, material.name.c_str(), found.green.agreement);
      EXPECT_EQ(found.look, Look::tangent_normals);
      // One of them holds ridges along t alone, whose slopes have no other axis to agree with.
      EXPECT_EQ(found.green.confidence == Confidence::cannot_tell, found.green.agreement == 0);
      EXPECT_EQ(found.green.green, stack::Green::up);
    }
  }
}

struct PairCase {
  const char* folder;
  const char* heights;
  const char* normals;
  bool is_inverted;
  stack::Green green;
  Confidence least;
};

// What the list says of the slopes' correlations: strong ones are certain, weaker ones likely.
const PairCase pair_cases[] = {
    {"mmikk_base", "base_height.tiff", "base_height_conv_to_nmap.png", false, stack::Green::up,
     Confidence::certain},
    {"acg_Bricks102", "Bricks102_Displacement.jpg", "Bricks102_NormalGL.jpg", false, stack::Green::up,
     Confidence::certain},
    {"acg_Bricks102", "Bricks102_Displacement.jpg", "Bricks102_NormalDX.jpg", false, stack::Green::down,
     Confidence::certain},
    {"acg_Tiles036", "Tiles036_1K_Displacement.jpg", "Tiles036_1K_Normal.jpg", false, stack::Green::down,
     Confidence::certain},
    {"acg_Metal007", "Metal007_1K_Displacement.jpg", "Metal007_1K_Normal.jpg", false, stack::Green::down,
     Confidence::likely},
    {"bevy_parallax_cube", "cube_depth.png", "cube_normal.png", true, stack::Green::up, Confidence::likely},
    {"godot_wool", "wool_depth.png", "wool_normal.png", true, stack::Green::up, Confidence::likely},
    {"godot_cheese", "texture_cheese_depth.png", "texture_cheese_normal.png", true, stack::Green::up,
     Confidence::certain},
    {"panda_layingrock", "layingrock-h.jpg", "layingrock-n.jpg", true, stack::Green::down,
     Confidence::certain},
};

TEST(SharedMaps, HeightsTellWhichWayTheReliefGoes) {
  if (!fs::exists(assets())) GTEST_SKIP() << "no " << assets();
  for (const PairCase& pair : pair_cases) {
    SCOPED_TRACE(pair.normals);
    const fs::path folder = assets() / "height_normal" / pair.folder;
    const image::Image heights =
        read_heights(io::read_image(folder / pair.heights), {.kind = Kind::height}, pair.heights);
    const Inspection found = inspect(io::read_image(folder / pair.normals), &heights, pair.normals);
    ASSERT_TRUE(found.heights);
    std::printf("  %-32s correlation %6.3f, %6.3f; scale %.2f\n", pair.normals, found.heights->correlation.x,
                found.heights->correlation.y, found.heights->scale);
    EXPECT_GE(found.heights->confidence, pair.least);
    EXPECT_EQ(found.heights->is_inverted, pair.is_inverted);
    EXPECT_EQ(found.heights->green, pair.green);
  }
}

} // namespace
} // namespace surfgrad::maps
