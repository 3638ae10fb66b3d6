// surfgrad displace: what it writes and says, and how it refuses.

#include "cli/program.hpp"
#include "io/image_file.hpp"
#include "io/model_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace surfgrad {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string document(const std::string& block) {
  return "{ \"surfgrad\": 1,\n  \"displace\": " + block + " }\n";
}

TEST(DisplaceCommand, HelpTeachesTheBlock) {
  const Folder folder;
  const Outcome help = run_program({"displace", "--help"}, folder.path());
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, HasSubstr("\"displace\": { \"function\""));
  EXPECT_THAT(help.out, HasSubstr("Examples:"));
}

TEST(DisplaceCommand, WritesTheDemoInBothFormsAndSaysWhatItDid) {
  const Folder folder;
  for (const char* name : {"a.glb", "a.gltf"}) {
    const Outcome run = run_program({"displace", "-o", name}, folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.out,
                HasSubstr(std::string("wrote ") + name + " (8385 vertices, 16384 triangles, heights"));
    EXPECT_THAT(run.error, IsEmpty());
    const io::Model model = io::read_model(folder.path() / name);
    EXPECT_EQ(model.meshes.at(0).positions.size(), 8385u);
    EXPECT_EQ(model.materials.at(0).name, "demo");
    EXPECT_TRUE(model.materials[0].double_sided);
  }
}

TEST(DisplaceCommand, DocumentsDecideAndThreadsDoNot) {
  const Folder folder;
  folder.write("s.json",
               document(R"({ "function": "perlin", "height": 0.2, "subdivide": 1, "edges": "curved" })"));
  const std::vector<std::string> on_one{"displace", "s.json", "-o",        "one.glb",
                                        "--json",   "-q",     "--threads", "1"};
  const std::vector<std::string> on_all{"displace", "s.json", "-o", "all.glb", "--json", "-q"};
  for (const auto& arguments : {on_one, on_all}) {
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.out, HasSubstr("\"triangles\":65536"));
    EXPECT_THAT(run.out, HasSubstr("\"parted_places\":0"));
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1);
  }
  const auto one = io::read_model(folder.path() / "one.glb").meshes.at(0).positions;
  const auto all = io::read_model(folder.path() / "all.glb").meshes.at(0).positions;
  EXPECT_TRUE(std::ranges::equal(one, all, [](auto a, auto b) { return max_abs(a - b) == 0; }));
}

TEST(DisplaceCommand, AMapMovesTheMeshToo) {
  const Folder folder;
  image::Image white = image::make_image(4, 4, 1, image::Depth::unorm8);
  for (float& texel : white.texels.floats()) texel = 1;
  io::write_image(folder.path() / "h.png", white, image::Depth::unorm8);
  folder.write("s.json", document(R"({ "map": { "map": "h.png" }, "level": 0.5, "height": 0.1 })"));
  const Outcome run = run_program({"displace", "s.json", "-o", "a.glb"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("heights from 0.05 to 0.05"));
}

struct Refusal {
  const char* name;
  const char* block;
  std::vector<const char*> says;
};

TEST(DisplaceCommand, BadBlocksAreRefusedInOneLineAndNothingIsWritten) {
  const Refusal refusals[] = {
      {"too_high", R"({ "function": "perlin", "height": 1, "subdivide": 7 })", {"s.json:2", "from 0 to 6"}},
      {"too_many",
       R"({ "function": "perlin", "height": 1, "subdivide": 6 })",
       {"s.json:2: displace.subdivide", "67108864", "expected 5 at most"}},
      {"both",
       R"({ "function": "perlin", "map": { "map": "h.png" }, "height": 1 })",
       {"s.json:2: displace", "keep one"}},
      {"neither", R"({ "height": 1 })", {"s.json:2: displace", "lacks \"function\" or \"map\""}},
      {"no_height", R"({ "function": "perlin" })", {"s.json:2: displace", "lacks \"height\""}},
      {"zero_frequency",
       R"({ "function": "perlin", "height": 1, "frequency": 0 })",
       {"s.json:2: displace.frequency", "greater than 0"}},
      {"no_such_map",
       R"({ "map": { "map": "h.png" }, "height": 1 })",
       {"h.png", "s.json:2: displace.map.map"}},
      {"uv_set",
       R"({ "map": { "map": "g.png", "uv": 5 }, "height": 1 })",
       {"s.json:2: displace.map.uv", "UV set 5"}},
      {"morph",
       R"({ "function": "perlin", "height": 1 }, "morph": [1])",
       {"s.json:2: morph", "no morph targets"}},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.name);
    const Folder folder;
    folder.write("s.json", document(refusal.block));
    io::write_image(folder.path() / "g.png", image::make_image(2, 2, 1, image::Depth::unorm8),
                    image::Depth::unorm8);
    const Outcome run = run_program({"displace", "s.json", "-o", "a.glb"}, folder.path());
    EXPECT_EQ(run.status, 1);
    for (const char* words : refusal.says) EXPECT_THAT(run.error, HasSubstr(words));
    EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1);
    EXPECT_THAT(folder.files(), ElementsAre("g.png", "s.json"));
  }
}

TEST(DisplaceCommand, ScenesThatSayNothingAreToldWhatToAdd) {
  const Folder folder;
  folder.write("s.json", "{ \"surfgrad\": 1 }");
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome bare = run_program({"displace", "s.json", "-o", "a.glb"}, folder.path());
  EXPECT_EQ(bare.status, 1);
  EXPECT_THAT(bare.error, HasSubstr("s.json: has no \"displace\"; add e.g. \"displace\": { \"function\""));
  const Outcome model = run_program({"displace", "m.obj", "-o", "a.glb"}, folder.path());
  EXPECT_EQ(model.status, 1);
  EXPECT_THAT(model.error, HasSubstr("\"mesh\": \"m.obj\", \"displace\""));
}

TEST(DisplaceCommand, OutputsAreCheckedBeforeTheScene) {
  const Folder folder;
  const Outcome none = run_program({"displace", "gone.json"}, folder.path());
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.error, HasSubstr("--output"));
  const Outcome extension = run_program({"displace", "gone.json", "-o", "a.obj"}, folder.path());
  EXPECT_EQ(extension.status, 1);
  EXPECT_THAT(extension.error, HasSubstr("a.obj"));
  EXPECT_THAT(extension.error, HasSubstr(".glb"));
  const Outcome place = run_program({"displace", "gone.json", "-o", "no/a.glb"}, folder.path());
  EXPECT_NE(place.status, 0);
  EXPECT_THAT(place.error, HasSubstr("no"));
  const Outcome scene = run_program({"displace", "gone.json", "-o", "a.glb"}, folder.path());
  EXPECT_EQ(scene.status, 1);
  EXPECT_THAT(scene.error, HasSubstr("gone.json"));
  EXPECT_THAT(folder.files(), IsEmpty());
}

} // namespace
} // namespace surfgrad
