// surfgrad tangents: what it writes and says, and how it refuses.

#include "cli/program.hpp"
#include "io/model_file.hpp"
#include "mesh/mikktspace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

namespace surfgrad {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two quads that share an edge; the texture of the second is mirrored.
constexpr const char* mirrored = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0.5\n"
                                 "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
                                 "f 1/1 2/2 5/4 4/3\nf 2/2 3/1 6/3 5/4\n";

std::vector<std::array<std::uint32_t, 4>> tangents_in(const std::filesystem::path& file) {
  const io::Model model = io::read_model(file);
  std::vector<std::array<std::uint32_t, 4>> all;
  for (const mesh::TriangleMesh& mesh : model.meshes)
    for (const vec4<float>& t : mesh.tangent_spaces.at(0).corners)
      all.push_back(std::bit_cast<std::array<std::uint32_t, 4>>(t));
  return all;
}

TEST(TangentsCommand, HelpSaysWhatIsKept) {
  const Folder folder;
  const Outcome help = run_program({"tangents", "--help"}, folder.path());
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, HasSubstr("all else is kept"));
  EXPECT_THAT(help.out, HasSubstr("Examples:"));
}

TEST(TangentsCommand, WritesTangentsThatReadBackAsTheyAreMade) {
  const Folder folder;
  folder.write("m.obj", mirrored);
  const Outcome first = run_program({"tangents", "m.obj", "-o", "a.glb"}, folder.path());
  EXPECT_EQ(first.status, 0) << first.error;
  EXPECT_EQ(first.out, "wrote a.glb (tangents of 1 mesh, 4 triangles, 8 vertices, 2 of them split)\n");
  EXPECT_THAT(first.error, IsEmpty());
  const io::Model model = io::read_model(folder.path() / "a.glb");
  std::vector<std::array<std::uint32_t, 4>> expected;
  for (const vec4<float>& t : mesh::generate_tangents(model.meshes.at(0), 0).corners)
    expected.push_back(std::bit_cast<std::array<std::uint32_t, 4>>(t));
  EXPECT_EQ(tangents_in(folder.path() / "a.glb"), expected);

  // Again, in place: they are replaced by the same, and the vertices that were split stay.
  const std::string before = text_of(folder.path() / "a.glb");
  const Outcome second = run_program({"tangents", "a.glb", "-o", "a.glb", "--json"}, folder.path());
  EXPECT_EQ(second.status, 0) << second.error;
  EXPECT_THAT(second.out, HasSubstr("\"replaced\":1"));
  EXPECT_THAT(second.out, HasSubstr("\"split_vertices\":0"));
  EXPECT_THAT(second.out, HasSubstr("\"vertices\":8"));
  EXPECT_EQ(std::count(second.out.begin(), second.out.end(), '\n'), 1);
  EXPECT_EQ(tangents_in(folder.path() / "a.glb"), expected);
  EXPECT_EQ(text_of(folder.path() / "a.glb").size(), before.size());
}

TEST(TangentsCommand, DoesNotDependOnThreadsAndIsQuiet) {
  const Folder folder;
  EXPECT_EQ(run_program({"displace", "-o", "demo.glb", "-q"}, folder.path()).status, 0);
  for (const char* threads : {"1", "2"}) {
    const Outcome run =
        run_program({"tangents", "demo.glb", "-o", std::string(threads) + ".glb", "-q", "--threads", threads},
                    folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.out, IsEmpty());
    EXPECT_THAT(run.error, IsEmpty());
  }
  EXPECT_EQ(text_of(folder.path() / "1.glb"), text_of(folder.path() / "2.glb"));
}

TEST(TangentsCommand, BadInputIsRefusedInOneLineAndNothingIsWritten) {
  struct Refusal {
    std::vector<std::string> arguments;
    int status;
    std::vector<const char*> says;
  };
  const Refusal refusals[] = {
      {{"tangents", "m.obj", "-o", "a.glb", "--uv", "1"},
       1,
       {"m.obj", "meshes[0].primitives[0]", "no UV set 1", "set 0 only"}},
      {{"tangents", "bare.obj", "-o", "a.glb"}, 1, {"bare.obj", "no mesh has the UV set", "unwrap"}},
      {{"tangents", "gone.glb", "-o", "a.glb"}, 1, {"gone.glb"}},
      {{"tangents", "m.obj", "-o", "a.gltf"}, 1, {"a.gltf", "expected .glb"}},
      {{"tangents", "m.obj", "-o", "no/a.glb"}, 1, {"no"}},
      {{"tangents", "m.obj", "-o", "a.glb", "--uv", "-1"}, 2, {"--uv"}},
      {{"tangents", "m.obj"}, 2, {"--output"}},
      {{"tangents", "-o", "a.glb"}, 2, {"MODEL"}},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(testing::PrintToString(refusal.arguments));
    const Folder folder;
    folder.write("m.obj", mirrored);
    folder.write("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Outcome run = run_program(refusal.arguments, folder.path());
    EXPECT_EQ(run.status, refusal.status);
    for (const char* words : refusal.says) EXPECT_THAT(run.error, HasSubstr(words));
    if (refusal.status == 1) {
      EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1);
    }
    EXPECT_THAT(folder.files(), ElementsAre("bare.obj", "m.obj"));
  }
}

} // namespace
} // namespace surfgrad
