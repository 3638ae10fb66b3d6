// A scene made ready: who is culled, where texture coordinates lie, which program runs.

#include "stage/stage.hpp"

#include "engine/reference.hpp"

#include "diagnostic/error.hpp"
#include "mesh/mikktspace.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::stage {
namespace {

using surfgrad::test::Random;

/// A plane whose second triangle has a material of its own.
scene::Scene two_materials() {
  Random random(221);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::plane(1));
  scene.meshes[0].material_of_triangle = {0, 1};
  scene.materials.push_back({"second", stack::BackFaces::cull, {}});
  surfgrad::test::add_image(scene, "tilt", surfgrad::test::constant_image(1, 1, {0.75, 0.5, 1}));
  scene.materials[1].layers = {surfgrad::test::normal_layer("tilt")};
  return scene;
}

TEST(Stage, CullsBackFacesOfTheMaterialsThatSaySo) {
  const scene::Scene scene = two_materials();
  const Stage stage(scene, {0, 0, 0}, {}, {});
  EXPECT_FALSE(stage.culled({0, 0}, true));
  EXPECT_FALSE(stage.culled({0, 0}, false));
  EXPECT_FALSE(stage.culled({0, 1}, true));
  EXPECT_TRUE(stage.culled({0, 1}, false));
}

TEST(Stage, RunsEachTrianglesOwnLayers) {
  const scene::Scene scene = two_materials();
  const Stage stage(scene, {0, 0, 0}, {}, {});
  for (const std::uint32_t t : {0u, 1u}) {
    const auto planes = raster::Projection::texture(stage.slot_of(0), 9, 9).planes(stage.surfaces()[0], t);
    const auto f = raster::make_fragment(stage.surfaces()[0], t, planes, 4.5, 4.5);
    const engine::TileWork work = stage.work_of({0, t});
    const auto c = engine::compose_reference(*work.program, f, work.back_faces, *work.placement);
    EXPECT_EQ(max_abs(c.normal - vec3<double>{0, 0, 1}) > 0.1, t == 1);
  }
}

TEST(Stage, LetsGoOfTheImagesOfASceneThatIsMovedToIt) {
  scene::Scene scene = two_materials();
  surfgrad::test::add_image(scene, "unused", surfgrad::test::constant_image(1, 1, {0.5, 0.5, 1}));
  scene.materials[0].layers = {surfgrad::test::normal_layer("tilt"), surfgrad::test::normal_layer("tilt")};
  std::vector<std::weak_ptr<const image::Image>> images;
  for (const auto& [name, image] : scene.images) images.emplace_back(image);
  ASSERT_EQ(images.size(), 2u);
  const Stage of_a_copy(scene, {0, 0, 0}, {}, {});
  for (const auto& image : images) EXPECT_FALSE(image.expired());
  const Stage stage(std::move(scene), {0, 0, 0}, {}, {});
  for (const auto& image : images) EXPECT_TRUE(image.expired());
}

TEST(Stage, FindsTheSlotsOfLayersAndOfTheJob) {
  scene::Scene scene = two_materials();
  scene.meshes[0].uv_sets.resize(4, scene.meshes[0].uv_sets[0]);
  stack::NormalMapLayer layer = surfgrad::test::normal_layer("tilt");
  layer.map.uv = 3;
  scene.materials[0].layers = {layer};
  const Stage stage(scene, {0, 0, 0}, {{2, false}}, {});
  for (const int set : {0, 2, 3}) {
    const auto& slot = stage.surfaces()[0].slots[stage.slot_of(set)];
    EXPECT_TRUE(slot.present);
    EXPECT_EQ(slot.tangents.empty(), set == 2) << set;
  }
}

TEST(Stage, PlacesSurfacesRelativeToTheOrigin) {
  scene::Scene scene = two_materials();
  scene.objects.push_back(
      {"far", 0, surfgrad::test::affine(surfgrad::test::scaling({2, 2, 2}), {1e6, 0, 0})});
  const Stage stage(scene, {1e6, 0, 0}, {}, {});
  ASSERT_EQ(stage.surfaces().size(), 2u);
  EXPECT_EQ(stage.surfaces()[0].positions[0].x, -1e6 - 1);
  EXPECT_EQ(stage.surfaces()[1].positions[0].x, -2);
}

TEST(Stage, RefusesMoreTextureCoordinatesThanAFragmentCarries) {
  scene::Scene scene = two_materials();
  scene.meshes[0].uv_sets.resize(9, scene.meshes[0].uv_sets[0]);
  scene.materials[0].layers.clear();
  for (int set = 0; set < 9; ++set) {
    stack::NormalMapLayer layer = surfgrad::test::normal_layer("tilt");
    layer.map.uv = set;
    scene.materials[0].layers.emplace_back(layer);
  }
  EXPECT_THROW(Stage(scene, {0, 0, 0}, {}, {}), InputError);
}

TEST(Stage, RefusesAJobWhoseTextureCoordinatesAMeshLacks) {
  scene::Scene scene = two_materials();
  scene.source = "bare.obj";
  for (scene::Material& material : scene.materials) material.layers.clear();
  scene.meshes[0].uv_sets.clear();
  EXPECT_NO_THROW(Stage(scene, {0, 0, 0}, {}, {}));
  try {
    const Stage stage(scene, {0, 0, 0}, {{0, false}}, {});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("bare.obj: mesh ")) << error.what();
  }
}

TEST(Stage, WarnsWhereGivenTangentsContradictTheTextureCoordinates) {
  scene::Scene scene = two_materials();
  scene.materials[0].layers = scene.materials[1].layers;
  mesh::TriangleMesh& mesh = scene.meshes[0];
  mesh.tangent_spaces = {mesh::generate_tangents(mesh, 0)};
  const auto warnings = [&] {
    std::vector<std::string> said;
    const Stage stage(scene, {0, 0, 0}, {}, {{}, [&](std::string_view text) { said.emplace_back(text); }});
    return said;
  };
  EXPECT_TRUE(warnings().empty());
  for (vec4<float>& corner : mesh.tangent_spaces[0].corners) corner.w = -corner.w;
  ASSERT_EQ(warnings().size(), 1u);
  EXPECT_NE(warnings()[0].find("2 of 2 triangles contradict"), std::string::npos) << warnings()[0];
}

} // namespace
} // namespace surfgrad::stage
