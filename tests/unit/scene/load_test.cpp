// Documents and models to scenes: what is found where, and which layers a material gets.

#include "scene/scene.hpp"

#include "scene_folder.hpp"

#include <gtest/gtest.h>

#include <variant>

namespace surfgrad::scene {
namespace {

const stack::NormalMapLayer& normal_map(const Material& material, std::size_t i) {
  return std::get<stack::NormalMapLayer>(material.layers.at(i));
}

TEST(LoadScene, ResolvesNamesAgainstTheDocumentsFolder) {
  const test::SceneFolder folder;
  const auto file = folder.write("s.json", R"({ "surfgrad": 1, "mesh": "quad.obj",
    "layers": [ { "type": "normal_map", "map": "maps/a.png", "mask": { "map": "maps/b.png" } },
                { "type": "resolve" },
                { "type": "object_normal_map", "map": "./maps/a.png" } ],
    "lights": { "environment": "maps/b.png" } })");
  const Scene scene = load_scene(file);
  ASSERT_EQ(scene.materials.size(), 2u);
  for (const Material& m : scene.materials) {
    ASSERT_EQ(m.layers.size(), 3u);
    EXPECT_EQ(normal_map(m, 0).map.file.path, file.parent_path() / "maps/a.png");
    EXPECT_EQ(scene.image(normal_map(m, 0).map.file.path).width, 8);
    EXPECT_EQ(scene.image(normal_map(m, 0).common.mask->file.path).width, 8);
    EXPECT_EQ(scene.image(std::get<stack::ObjectNormalMapLayer>(m.layers[2]).map.file.path).width, 8);
  }
  EXPECT_EQ(scene.environment, scene.images.at(file.parent_path() / "maps/b.png"));
}

TEST(LoadScene, TakesAbsoluteNamesAsTheyAre) {
  const test::SceneFolder folder;
  const auto root = folder.write("unused.txt", "").parent_path();
  const Scene scene =
      load_scene(folder.write("maps/s.json", R"({ "surfgrad": 1, "mesh": ")" + (root / "quad.obj").string() +
                                                 R"(", "layers": [ { "type": "normal_map", "map": ")" +
                                                 (root / "maps/a.png").string() + R"(" } ] })"));
  EXPECT_EQ(normal_map(scene.materials[0], 0).map.file.path, root / "maps/a.png");
}

TEST(LoadScene, GivesNamedMaterialsTheirOwnLayersAndTheRestTheCommonOnes) {
  const test::SceneFolder folder;
  const Scene scene = load_scene(folder.write("s.json", R"({ "surfgrad": 1, "mesh": "quad.obj",
    "layers": [ { "type": "normal_map", "map": "maps/a.png" } ],
    "materials": { "cloth": [ { "type": "normal_map", "map": "maps/b.png" }, { "type": "resolve" } ] } })"));
  for (const Material& m : scene.materials) {
    const bool cloth = m.name == "cloth";
    ASSERT_EQ(m.layers.size(), cloth ? 2u : 1u) << m.name;
    EXPECT_EQ(normal_map(m, 0).map.file.path.filename(), cloth ? "b.png" : "a.png");
  }
}

TEST(LoadScene, OfAModelAloneUsesItsOwnTexturesWithScaleAndTransform) {
  const test::SceneFolder folder;
  const auto file = folder.write_gltf(0);
  const Scene scene = load_scene(file);
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].back_faces, stack::BackFaces::flip);
  ASSERT_EQ(scene.materials[0].layers.size(), 1u);
  const stack::NormalMapLayer& layer = normal_map(scene.materials[0], 0);
  EXPECT_EQ(layer.common.scale, 0.5);
  EXPECT_EQ(layer.map.tile.x, 2);
  EXPECT_EQ(layer.map.tile.y, 3);
  EXPECT_EQ(layer.map.offset.x, 0.25);
  // v' = 3 v runs down from the top: t' = 1 - 3 (1 - t) = 3 t - 2.
  EXPECT_DOUBLE_EQ(layer.map.offset.y, -2);
  EXPECT_EQ(scene.image(layer.map.file.path).width, 8);
}

TEST(LoadScene, OfADocumentAroundAModelKeepsTheModelsLayersUnlessItHasItsOwn) {
  const test::SceneFolder folder;
  (void)folder.write_gltf(0);
  const Scene kept = load_scene(folder.write("kept.json", R"({ "surfgrad": 1, "mesh": "quad.gltf" })"));
  EXPECT_EQ(kept.materials[0].layers.size(), 1u);
  const Scene bare =
      load_scene(folder.write("bare.json", R"({ "surfgrad": 1, "mesh": "quad.gltf", "layers": [] })"));
  EXPECT_TRUE(bare.materials[0].layers.empty());
}

TEST(LoadScene, WithoutAMeshDressesTheDemo) {
  const test::SceneFolder folder;
  const Scene scene = load_scene(folder.write("s.json", R"({ "surfgrad": 1,
    "layers": [ { "type": "normal_map", "map": "maps/a.png", "uv": 1 } ] })"));
  EXPECT_EQ(scene.meshes[0].triangles.size(), demo_scene().meshes[0].triangles.size());
  ASSERT_EQ(scene.materials[0].layers.size(), 1u);
  const Scene plain = load_scene(folder.write("plain.json", R"({ "surfgrad": 1 })"));
  EXPECT_EQ(plain.materials[0].layers.size(), demo_scene().materials[0].layers.size());
  for (const auto& [name, image] : demo_scene().images)
    EXPECT_EQ(plain.images.at(name)->texels, image->texels);
}

TEST(LoadScene, BackFacesOfTheDocumentOverrideTheMaterials) {
  const test::SceneFolder folder;
  const Scene model = load_scene(folder.write("s.json", R"({ "surfgrad": 1, "mesh": "quad.obj" })"));
  for (const Material& m : model.materials)
    EXPECT_EQ(m.back_faces, stack::BackFaces::flip); // an OBJ says nothing: both sides
  const Scene mirror =
      load_scene(folder.write("m.json", R"({ "surfgrad": 1, "mesh": "quad.obj", "back_faces": "mirror" })"));
  for (const Material& m : mirror.materials) EXPECT_EQ(m.back_faces, stack::BackFaces::mirror);
}

TEST(LoadScene, KnowsADocumentByItsExtensionInAnyCase) {
  const test::SceneFolder folder;
  EXPECT_EQ(load_scene(folder.write("S.JSON", R"({ "surfgrad": 1, "mesh": "quad.obj" })")).materials.size(),
            2u);
}

} // namespace
} // namespace surfgrad::scene
