// A document's morph weights on their way to the model.

#include "diagnostic/error.hpp"
#include "scene/scene.hpp"
#include "scene_folder.hpp"

#include <gtest/gtest.h>

namespace surfgrad::scene {
namespace {

/// A triangle with two targets: the first lifts all vertices by 1, the second by 10.
std::filesystem::path write_targets(const test::SceneFolder& folder) {
  const float numbers[] = {0, 0, 0, 1, 0, 0, 0,  1, 0, 0,  0, 1, 0, 0,
                           1, 0, 0, 1, 0, 0, 10, 0, 0, 10, 0, 0, 10};
  folder.write("m.bin", {reinterpret_cast<const char*>(numbers), sizeof numbers});
  return folder.write("m.gltf",
                      R"({ "asset": { "version": "2.0" }, "buffers": [{ "uri": "m.bin", "byteLength": 108 }],
    "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 36 },
                    { "buffer": 0, "byteOffset": 72, "byteLength": 36 }],
    "accessors": [
      { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
      { "bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3" },
      { "bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3" }],
    "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "targets": [{ "POSITION": 1 }, { "POSITION": 2 }] }],
                 "weights": [0, 0.5] }],
    "nodes": [{ "mesh": 0 }], "scenes": [{ "nodes": [0] }], "scene": 0 })");
}

float height_with(const test::SceneFolder& folder, const std::string& keys) {
  const auto file =
      folder.write("s.json", "{ \"surfgrad\": 1, \"mesh\": \"m.gltf\",\n" + keys + "\"layers\": [] }");
  return load_scene(file).meshes.at(0).positions.at(0).z;
}

TEST(SceneMorph, TheDocumentsWeightsReplaceTheFilesFromTheFirstOn) {
  const test::SceneFolder folder;
  write_targets(folder);
  EXPECT_EQ(height_with(folder, ""), 5);
  EXPECT_EQ(height_with(folder, "\"morph\": [],"), 5);
  EXPECT_EQ(height_with(folder, "\"morph\": [2],"), 7);
  EXPECT_EQ(height_with(folder, "\"morph\": [0, -1],"), -10);
}

TEST(SceneMorph, MoreWeightsThanTargetsAreAMistakeOfTheDocument) {
  const test::SceneFolder folder;
  write_targets(folder);
  const auto message = [&](const char* mesh) -> std::string {
    const std::string start = "{ \"surfgrad\": 1,";
    const std::string named = mesh == nullptr ? "\n" : std::string(" \"mesh\": \"") + mesh + "\",\n";
    const auto file = folder.write("s.json", start + named + "\"morph\": [0, 0, 1] }");
    try {
      (void)load_scene(file);
    } catch (const InputError& error) {
      EXPECT_EQ(error.fault().file, file);
      EXPECT_EQ(error.fault().line, 2);
      EXPECT_EQ(error.fault().place, "morph");
      return error.fault().problem + "; " + error.fault().remedy;
    }
    return "no error";
  };
  EXPECT_EQ(message("m.gltf"),
            "m.gltf has at most 2 morph targets but 3 weights are given; expected at most 2");
  EXPECT_EQ(message("quad.obj"),
            "quad.obj has no morph targets: the format knows none; leave out their weights or "
            "convert the model to glTF");
  EXPECT_EQ(message(nullptr), "the built-in demo has no morph targets; give a \"mesh\" that has some");
}

} // namespace
} // namespace surfgrad::scene
