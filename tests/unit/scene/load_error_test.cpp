// What a scene refuses, and how it names the place.

#include "scene/scene.hpp"

#include "diagnostic/error.hpp"
#include "scene_folder.hpp"

#include <gtest/gtest.h>

namespace surfgrad::scene {
namespace {

using ::testing::Test;

struct LoadErrors : Test {
  const test::SceneFolder folder{};

  static Fault fault_of(const std::filesystem::path& file) {
    try {
      (void)load_scene(file);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.fault();
    }
    ADD_FAILURE() << file << " was loaded";
    return {};
  }
  static void expect_in(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << '"' << text << "\" should hold \"" << part << '"';
  }
};

TEST_F(LoadErrors, AnUnknownMaterialNamesItsLineAndTheMeshsMaterials) {
  const auto file = folder.write("s.json", "{ \"surfgrad\": 1, \"mesh\": \"quad.obj\",\n  \"materials\": {\n"
                                           "    \"skni\": [ ] } }");
  const Fault fault = fault_of(file);
  EXPECT_EQ(fault.file, file);
  EXPECT_EQ(fault.line, 3);
  expect_in(fault.place, "skni");
  expect_in(fault.remedy, "skin");
  expect_in(fault.remedy, "cloth");
}

TEST_F(LoadErrors, AMissingUvSetNamesTheLayersLine) {
  const auto file = folder.write("s.json", "{ \"surfgrad\": 1, \"mesh\": \"quad.obj\",\n  \"layers\": [\n"
                                           "    { \"type\": \"normal_map\", \"map\": \"maps/a.png\",\n"
                                           "      \"uv\": 2 } ] }");
  const Fault fault = fault_of(file);
  EXPECT_EQ(fault.file, file);
  EXPECT_EQ(fault.line, 4);
  EXPECT_EQ(fault.place, "layers[0].uv");
  expect_in(fault.problem, "UV set 2");
  expect_in(fault.problem, "1 UV set");
  const auto mask = folder.write("m.json", "{ \"surfgrad\": 1, \"mesh\": \"quad.obj\",\n  \"layers\": [\n"
                                           "    { \"type\": \"normal_map\", \"map\": \"maps/a.png\",\n"
                                           "      \"mask\": { \"map\": \"maps/b.png\",\n \"uv\": 1 } } ] }");
  EXPECT_EQ(fault_of(mask).line, 5);
  EXPECT_EQ(fault_of(mask).place, "layers[0].mask.uv");
}

TEST_F(LoadErrors, AMeshWithoutTextureCoordinatesSaysSo) {
  const auto file = folder.write("s.json", R"({ "surfgrad": 1, "mesh": "bare.obj",
    "layers": [ { "type": "normal_map", "map": "maps/a.png" } ] })");
  expect_in(fault_of(file).problem, "no texture coordinates");
  EXPECT_NO_THROW((void)load_scene(folder.write("ok.json", R"({ "surfgrad": 1, "mesh": "bare.obj" })")));
}

TEST_F(LoadErrors, AModelsOwnTextureWithoutItsUvSetNamesTheModel) {
  const auto model = folder.write_gltf(1);
  EXPECT_EQ(fault_of(model).file, model);
  const auto document = folder.write("s.json", R"({ "surfgrad": 1, "mesh": "quad.gltf" })");
  EXPECT_EQ(fault_of(document).file, model); // not a line of the document's making
}

TEST_F(LoadErrors, AMissingImageNamesItselfAndTheDocumentsLine) {
  const auto file =
      folder.write("s.json", "{ \"surfgrad\": 1, \"mesh\": \"quad.obj\",\n  \"layers\": [\n"
                             "    { \"type\": \"normal_map\",\n      \"map\": \"maps/none.png\" } ] }");
  const Fault fault = fault_of(file);
  EXPECT_EQ(fault.file, file.parent_path() / "maps/none.png");
  expect_in(fault.place, "s.json:4");
  expect_in(fault.place, "layers[0].map");
  const auto mask = folder.write("m.json", "{ \"surfgrad\": 1, \"mesh\": \"quad.obj\", \"layers\": [\n"
                                           "  { \"type\": \"normal_map\", \"map\": \"maps/a.png\",\n"
                                           "    \"mask\": { \"map\": \"none.png\" } } ] }");
  expect_in(fault_of(mask).place, "m.json:3");
  const auto sky = folder.write("e.json", "{ \"surfgrad\": 1, \"mesh\": \"quad.obj\",\n"
                                          "  \"lights\": { \"environment\": \"none.hdr\" } }");
  expect_in(fault_of(sky).place, "e.json:2");
}

TEST_F(LoadErrors, AnImageThatCannotBeReadKeepsTheDecodersWords) {
  folder.write("maps/broken.png", "\x89PNG\r\n\x1a\n");
  const auto file = folder.write("s.json", R"({ "surfgrad": 1, "mesh": "quad.obj",
    "layers": [ { "type": "normal_map", "map": "maps/broken.png" } ] })");
  const Fault fault = fault_of(file);
  EXPECT_EQ(fault.file.filename(), "broken.png");
  expect_in(fault.place, "s.json:2");
  EXPECT_FALSE(fault.problem.empty());
}

TEST_F(LoadErrors, AMissingMeshOrDocumentNamesTheFile) {
  EXPECT_EQ(fault_of("no_such_document.json").file, "no_such_document.json");
  EXPECT_EQ(fault_of("no_such_model.glb").file, "no_such_model.glb");
  const auto file = folder.write("s.json", R"({ "surfgrad": 1, "mesh": "none.obj" })");
  EXPECT_EQ(fault_of(file).file, file.parent_path() / "none.obj");
}

} // namespace
} // namespace surfgrad::scene
