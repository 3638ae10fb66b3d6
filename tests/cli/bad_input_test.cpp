// Whatever is wrong with an input: one line that names the file and what would be right, exit status 1,
// no partial output. The modules' own tests hold many more cases; these go through the whole program.

#include "cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace surfgrad {
namespace {

using testing::HasSubstr;

/// A triangle with texture coordinates; `%` is replaced by further lines.
std::string obj(const std::string& extra = "") {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n" + extra + "f 1/1 2/2 3/3\n";
}

std::string stack(const std::string& layers, const std::string& mesh = "m.obj") {
  return "{ \"surfgrad\": 1,\n  \"mesh\": \"" + mesh + "\",\n  \"layers\": [ " + layers + " ] }\n";
}

/// The smallest glTF document with one accessor over a data URI of `bytes` zero bytes.
std::string gltf(const std::string& uri, int count) {
  return R"({ "asset": { "version": "2.0" }, "scenes": [ { "nodes": [ 0 ] } ], "nodes": [ { "mesh": 0 } ],
  "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 } } ] } ],
  "accessors": [ { "bufferView": 0, "componentType": 5126, "count": )" +
         std::to_string(count) + R"(, "type": "VEC3" } ],
  "bufferViews": [ { "buffer": 0, "byteLength": 36 } ],
  "buffers": [ { "byteLength": 36, "uri": ")" +
         uri + R"(" } ] })";
}

std::string zeros_uri() { return "data:application/octet-stream;base64," + std::string(48, 'A'); }

void append_chunk(std::string& png, const char* type, const std::string& data, std::uint32_t crc) {
  const auto u32 = [&](std::uint32_t v) {
    for (int shift = 24; shift >= 0; shift -= 8) png += static_cast<char>(v >> shift & 0xff);
  };
  u32(static_cast<std::uint32_t>(data.size()));
  png += type;
  png += data;
  u32(crc);
}

/// A PNG that says it is 60000x60000 16-bit RGBA and holds next to nothing.
std::string huge_png() {
  std::string png = "\x89PNG\r\n\x1a\n";
  std::string header("\x00\x00\xea\x60\x00\x00\xea\x60\x10\x06\x00\x00\x00", 13);
  append_chunk(png, "IHDR", header, 0x9b8f39a5u); // the size is refused whether or not the checksum is
  append_chunk(png, "IDAT", "x", 0);
  return png;
}

struct BadInput {
  const char* name;
  std::string file;    ///< name of the scene given to the program
  std::string content; ///< its bytes; empty: the file is not written
  std::vector<const char*> says;
};

std::vector<BadInput> bad_inputs() {
  const std::string map = R"({ "type": "normal_map", "map": "n.png" })";
  return {
      {"missing_scene", "none.json", "", {"none.json"}},
      {"missing_model", "none.glb", "", {"none.glb"}},
      {"unknown_extension", "scene.fbx", "Kaydara", {"scene.fbx", ".obj"}},
      {"folder_as_a_scene", ".", "", {"is a folder", ".json"}},
      {"wrong_type", "scene.glb", "this is no GLB file at all", {"scene.glb"}},
      {"truncated_json", "s.json", "{ \"surfgrad\": 1,\n \"mesh\": \"m.obj\",\n", {"s.json:2"}},
      {"unknown_key",
       "s.json",
       "{ \"surfgrad\": 1,\n \"mesch\": \"m.obj\" }",
       {"s.json:2", "mesch", "did you mean \"mesh\""}},
      {"newer_version", "s.json", "{ \"surfgrad\": 2 }", {"s.json:1", "newer"}},
      {"missing_mesh", "s.json", stack(map, "gone.obj"), {"gone.obj", "s.json:2"}},
      {"missing_map",
       "s.json",
       stack(R"({ "type": "normal_map", "map": "gone.png" })"),
       {"gone.png", "s.json:3"}},
      {"truncated_map",
       "s.json",
       stack(R"({ "type": "normal_map", "map": "cut.png" })"),
       {"cut.png", "s.json:3"}},
      {"huge_map", "s.json", stack(R"({ "type": "normal_map", "map": "huge.png" })"), {"huge.png"}},
      {"map_that_is_text", "s.json", stack(R"({ "type": "normal_map", "map": "m.obj" })"), {"m.obj"}},
      {"uv_set_the_mesh_lacks",
       "s.json",
       stack(R"({ "type": "normal_map", "map": "n.png", "uv": 3 })"),
       {"s.json:3", "layers[0].uv", "UV set"}},
      {"no_uvs_at_all", "s.json", stack(map, "bare.obj"), {"s.json:3", "no texture coordinates"}},
      {"accessor_past_the_buffer", "m.gltf", gltf(zeros_uri(), 4000), {"m.gltf", "accessors[0]"}},
      {"uri_that_leaves_the_folder", "m.gltf", gltf("../secret.bin", 3), {"m.gltf", "../secret.bin"}},
      {"uri_with_a_scheme", "m.gltf", gltf("http://example.com/a.bin", 3), {"m.gltf", "http"}},
      {"index_out_of_range", "m9.obj", obj("f 1 2 9\n"), {"m9.obj"}},
      {"nan_position", "nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", {"nan.obj"}},
      {"unknown_material",
       "s.json",
       "{ \"surfgrad\": 1, \"mesh\": \"m.obj\", \"materials\": { \"skin\": [] } }",
       {"s.json:1", "skin"}},
  };
}

class BadInputs : public testing::TestWithParam<BadInput> {};

TEST_P(BadInputs, GiveOneLineStatus1AndNoOutput) {
  const BadInput& bad = GetParam();
  const Folder folder;
  folder.write("m.obj", obj());
  folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("huge.png", huge_png());
  ASSERT_EQ(run_program({"bake", "-o", "n.png", "--size", "8"}, folder.path()).status, 0);
  std::filesystem::copy(folder.path() / "n.png", folder.path() / "cut.png");
  std::filesystem::resize_file(folder.path() / "cut.png",
                               std::filesystem::file_size(folder.path() / "cut.png") / 2);
  if (!bad.content.empty()) folder.write(bad.file, bad.content);
  const std::vector<std::string> before = folder.files();

  for (const char* verb : {"render", "bake"}) {
    const Outcome run = run_program({verb, bad.file, "-o", "out.png", "--size", "8"}, folder.path());
    EXPECT_EQ(run.status, 1) << run.error;
    EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
    EXPECT_THAT(run.error, testing::StartsWith("surfgrad: "));
    for (const char* part : bad.says) EXPECT_THAT(run.error, HasSubstr(part));
    EXPECT_EQ(folder.files(), before);
  }
}

INSTANTIATE_TEST_SUITE_P(Inputs, BadInputs, testing::ValuesIn(bad_inputs()),
                         [](const auto& input) { return input.param.name; });

void PrintTo(const BadInput& bad, std::ostream* out) { *out << bad.name; }

TEST(BadInputs, ShowingTextureCoordinatesThatAMeshLacksIsRefused) {
  const Folder folder;
  folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome run =
      run_program({"render", "bare.obj", "-o", "out.png", "--size", "8", "--aov", "uv"}, folder.path());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("bare.obj: mesh"));
  EXPECT_THAT(folder.files(), testing::ElementsAre("bare.obj"));
}

TEST(BadInputs, BakingAMeshWithoutTextureCoordinatesIsRefused) {
  const Folder folder;
  folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome run = run_program({"bake", "bare.obj", "-o", "out.png", "--size", "8"}, folder.path());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("bare.obj: mesh"));
  EXPECT_THAT(run.error, HasSubstr("no texture coordinates"));
  EXPECT_THAT(folder.files(), testing::ElementsAre("bare.obj"));
}

} // namespace
} // namespace surfgrad
