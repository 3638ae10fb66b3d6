#include "io/model_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <ostream>
#include <set>

namespace surfgrad::io {
namespace {

const std::filesystem::path mesh_folder = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh";

/// Facts about a model, as its manifest states them. Materials are counted, those the reader adds left out.
struct Facts {
  const char* file;
  std::size_t triangles;
  std::size_t meshes;
  std::size_t uv_sets;
  std::size_t with_tangents;
  std::ptrdiff_t normal_mapped;
  std::ptrdiff_t double_sided;
};

void PrintTo(const Facts& facts, std::ostream* out) { *out << facts.file; }

constexpr Facts all_facts[] = {
    {"bevy_Mountains/Mountains.gltf", 12800, 1, 1, 0, 0, 1},
    {"blenderio_suzanne/02_suzanne.gltf", 3936, 1, 1, 1, 1, 0},
    {"khr_Box_With_Spaces/Box With Spaces.gltf", 12, 1, 1, 0, 1, 0},
    {"khr_ClearCoatTest/ClearCoatTest.glb", 37116, 27, 1, 0, 6, 0},
    {"khr_MultiUVTest/MultiUVTest.glb", 12, 1, 2, 1, 0, 0},
    {"khr_NegativeScaleTest/NegativeScaleTest.glb", 3884, 8, 1, 0, 0, 3},
    {"khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb", 5240, 1, 1, 1, 1, 1},
    {"khr_NormalTangentTest/NormalTangentTest.glb", 7774, 1, 1, 0, 1, 1},
    {"khr_TextureTransformMultiTest/TextureTransformMultiTest.glb", 3956, 29, 2, 0, 3, 2},
    {"khr_TwoSidedPlane/TwoSidedPlane.gltf", 2, 1, 1, 1, 1, 1},
    {"mmikk_meshes/LP_Normal_Map_Stress_Test.obj", 220, 1, 1, 0, 0, 1},
    {"mmikk_meshes/LP_Pirate.obj", 4010, 1, 1, 0, 0, 1},
    {"mmikk_meshes/Rock_Overgrown_A.obj", 19580, 1, 1, 0, 0, 1},
    {"mmikk_meshes/quad.obj", 2, 1, 1, 0, 0, 1},
    {"mmikk_meshes/sphere.obj", 760, 1, 1, 0, 0, 1},
    {"mx_boombox/boombox.glb", 6036, 1, 1, 0, 0, 0},
    {"mx_plane/plane.obj", 1800, 1, 1, 0, 0, 1},
    {"oded_goathead/goathead.obj", 5522, 1, 0, 0, 0, 1},
    {"oded_spot/spot_control_mesh.obj", 372, 1, 1, 0, 0, 1},
    {"oded_spot/spot_low_resolution.obj", 1654, 1, 0, 0, 0, 1},
    {"ogre_athene/athene_converted.obj", 6000, 1, 1, 0, 0, 1},
    {"ogre_mirrored_uv/testmirroreduvmesh_converted.obj", 4, 1, 1, 0, 0, 1},
    {"pc_house/house.glb", 10497, 2, 2, 0, 0, 0},
    {"t3d_rockA/RockA.glb", 248, 1, 1, 0, 0, 0},
};

class SharedModel : public testing::TestWithParam<Facts> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(mesh_folder)) GTEST_SKIP() << "no shared assets at " << mesh_folder;
  }
};

TEST_P(SharedModel, HoldsWhatItsManifestSays) {
  const Facts& facts = GetParam();
  const Model model = read_model(mesh_folder / facts.file);

  std::size_t triangles = 0;
  std::size_t uv_sets = 0;
  std::size_t with_tangents = 0;
  for (const mesh::TriangleMesh& mesh : model.meshes) {
    triangles += mesh.triangles.size();
    uv_sets = std::max(uv_sets, mesh.uv_sets.size());
    if (!mesh.tangent_spaces.empty()) ++with_tangents;
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_EQ(mesh.material_of_triangle.size(), mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.positions.size());
    for (const std::uint32_t material : mesh.material_of_triangle)
      ASSERT_LT(material, model.materials.size());
    for (const auto& space : mesh.tangent_spaces) {
      EXPECT_TRUE(space.corners.empty() || space.corners.size() == 3 * mesh.triangles.size());
    }
  }
  EXPECT_EQ(triangles, facts.triangles);
  EXPECT_EQ(model.meshes.size(), facts.meshes);
  EXPECT_EQ(uv_sets, facts.uv_sets);
  EXPECT_EQ(with_tangents, facts.with_tangents);
  const auto& materials = model.materials;
  EXPECT_EQ(std::ranges::count_if(materials, [](const auto& m) { return m.normal.has_value(); }),
            facts.normal_mapped);
  EXPECT_EQ(std::ranges::count_if(materials, [](const auto& m) { return m.double_sided; }),
            facts.double_sided);
  for (const ModelMaterial& material : materials) {
    EXPECT_TRUE(!material.normal || !material.normal->image->texels.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(, SharedModel, testing::ValuesIn(all_facts), [](const auto& entry) {
  std::string name = std::filesystem::path(entry.param.file).stem().string();
  std::ranges::replace_if(
      name,
      [](char c) { return !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9'); },
      '_');
  return name;
});

TEST(SharedModels, TableLeavesNoneOut) {
  if (!std::filesystem::exists(mesh_folder)) GTEST_SKIP() << "no shared assets at " << mesh_folder;
  std::set<std::filesystem::path> known;
  for (const Facts& facts : all_facts) known.insert(mesh_folder / facts.file);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(mesh_folder)) {
    const auto extension = entry.path().extension();
    const bool is_model = extension == ".gltf" || extension == ".glb" || extension == ".obj";
    EXPECT_TRUE(!is_model || known.contains(entry.path())) << entry.path();
  }
}

TEST(SharedModels, NormalTangentMirrorTestKeepsTheSignsOfItsTangents) {
  const std::filesystem::path file = mesh_folder / "khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared assets at " << mesh_folder;
  const mesh::TriangleMesh mesh = read_model(file).meshes[0];
  std::set<std::uint32_t> negative;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      if (mesh.tangent_spaces[0].corners[3 * t + c].w < 0) negative.insert(mesh.triangles[t][c]);
  EXPECT_EQ(mesh.positions.size(), 2770u);
  EXPECT_EQ(negative.size(), 80u);
}

} // namespace
} // namespace surfgrad::io
