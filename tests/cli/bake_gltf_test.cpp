// surfgrad bake --gltf: the model with its map inside, and how it refuses.

#include "cli/program.hpp"
#include "io/file.hpp"
#include "io/model_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace surfgrad {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                             "vt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\nusemtl clay\nf 1/1 2/2 3/3 4/4\n";
constexpr const char* bumps = R"({ "surfgrad": 1, "mesh": "m.obj",
  "layers": [{ "type": "noise", "function": "turbulence", "frequency": 4, "scale": 0.2 }] })";

void write_scene(const Folder& folder) {
  folder.write("m.obj", quad);
  folder.write("s.json", bumps);
}

Outcome bake(const Folder& folder, const std::vector<std::string>& options) {
  std::vector<std::string> arguments{"bake", "s.json", "--size", "32", "-o", "map.png"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return run_program(arguments, folder.path());
}

TEST(BakeGltf, HoldsTheModelWithTheMapThatWasWritten) {
  const Folder folder;
  write_scene(folder);
  const Outcome run = bake(folder, {"--gltf", "out.glb"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("wrote map.png (32x32, 256 texels covered)\nwrote out.glb\n"));
  EXPECT_THAT(run.error, IsEmpty());
  EXPECT_THAT(folder.files(), ElementsAre("m.obj", "map.png", "out.glb", "s.json"));
  EXPECT_THAT(text_of(folder.path() / "out.glb"), HasSubstr(text_of(folder.path() / "map.png")));
  const io::Model model = io::read_model(folder.path() / "out.glb");
  ASSERT_TRUE(model.materials.at(0).normal.has_value());
  EXPECT_EQ(model.materials[0].name, "clay");
  EXPECT_EQ(model.materials[0].normal->image->width, 32);
  EXPECT_EQ(model.meshes.at(0).tangent_spaces.at(0).corners.size(), 6u);

  // It is a scene by itself, which bakes to itself.
  const Outcome again = run_program({"bake", "out.glb", "-o", "again.png", "--size", "32", "--gltf",
                                     "again.glb", "--verify", "--json", "-q"},
                                    folder.path());
  EXPECT_EQ(again.status, 0) << again.error;
  const auto summary = nlohmann::json::parse(again.out);
  EXPECT_EQ(summary["gltf"], "again.glb");
  EXPECT_EQ(summary["covered_texels"], 256);
}

TEST(BakeGltf, DoesNotDependOnThreads) {
  const Folder folder;
  write_scene(folder);
  for (const char* threads : {"1", "2"}) {
    const Outcome run = bake(folder, {"--gltf", std::string(threads) + ".glb", "--threads", threads, "-q"});
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.out, IsEmpty());
  }
  EXPECT_EQ(text_of(folder.path() / "1.glb"), text_of(folder.path() / "2.glb"));
}

TEST(BakeGltf, OfTheDisplacedDemoIsTheDisplacedMesh) {
  const Folder folder;
  folder.write(
      "s.json",
      R"({ "surfgrad": 1, "displace": { "function": "fractal_sum", "frequency": 3, "height": 0.1 } })");
  EXPECT_EQ(bake(folder, {"--gltf", "out.glb", "-q"}).status, 0);
  EXPECT_EQ(run_program({"displace", "s.json", "-o", "mesh.glb", "-q"}, folder.path()).status, 0);
  const mesh::TriangleMesh with_map = io::read_model(folder.path() / "out.glb").meshes.at(0);
  const mesh::TriangleMesh displaced = io::read_model(folder.path() / "mesh.glb").meshes.at(0);
  ASSERT_EQ(with_map.triangles.size(), displaced.triangles.size());
  for (std::size_t t = 0; t < displaced.triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const vec3<float> a = with_map.positions[with_map.triangles[t][c]];
      const vec3<float> b = displaced.positions[displaced.triangles[t][c]];
      ASSERT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z) << t;
    }
}

TEST(BakeGltf, RefusesWhatItCannotHoldBeforeAnythingIsWritten) {
  struct Refusal {
    std::vector<std::string> options;
    int status;
    std::vector<const char*> says;
  };
  const Refusal refusals[] = {
      {{"--gltf", "a.glb", "--green", "down"}, 2, {"--gltf", "--green up"}},
      {{"--gltf", "a.glb", "--encoding", "rg"}, 2, {"--gltf", "--encoding rgb"}},
      {{"--gltf", "a.glb", "--space", "object"}, 2, {"--gltf", "--space tangent"}},
      {{"--gltf", ""}, 2, {"--gltf", "must not be empty"}},
      {{"--gltf", "a.gltf"}, 1, {"a.gltf", "expected .glb"}},
      {{"--gltf", "no/a.glb"}, 1, {"no"}},
      {{"--gltf", "folder.glb"}, 1, {"folder.glb"}},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.options));
    const Folder folder;
    write_scene(folder);
    std::filesystem::create_directory(folder.path() / "folder.glb");
    const Outcome run = bake(folder, refusal.options);
    EXPECT_EQ(run.status, refusal.status);
    for (const char* words : refusal.says) EXPECT_THAT(run.error, HasSubstr(words));
    EXPECT_THAT(folder.files(), ElementsAre("folder.glb", "m.obj", "s.json"));
  }
  const Folder folder;
  write_scene(folder);
  const Outcome exr = run_program({"bake", "s.json", "-o", "map.exr", "--gltf", "a.glb"}, folder.path());
  EXPECT_EQ(exr.status, 2);
  EXPECT_THAT(exr.error, HasSubstr("a .png"));
}

TEST(BakeGltf, ReplacesNoFileOfTheScene) {
  const Folder folder;
  write_scene(folder);
  EXPECT_EQ(run_program({"tangents", "m.obj", "-o", "m.glb", "-q"}, folder.path()).status, 0);
  std::string document = bumps;
  folder.write("s.json", document.replace(document.find("m.obj"), 5, "m.glb"));
  const std::string before = text_of(folder.path() / "m.glb");
  const Outcome run = bake(folder, {"--gltf", "./m.glb"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("m.glb: would replace a file of the scene; give --gltf another name"));
  EXPECT_EQ(text_of(folder.path() / "m.glb"), before);
  EXPECT_THAT(folder.files(), ElementsAre("m.glb", "m.obj", "s.json"));
}

} // namespace
} // namespace surfgrad
