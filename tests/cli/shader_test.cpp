// surfgrad shader, and the commands of its page.

#include "cli/program.hpp"
#include "support/file_size_limit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace surfgrad {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST(Shader, TheDemoInEveryLanguage) {
  for (const char* language : {"glsl", "hlsl", "wgsl", "godot"}) {
    const Folder folder;
    const Outcome run = run_program({"shader", "--lang", language, "-o", "demo.txt"}, folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.out, StartsWith("wrote demo.txt ("));
    EXPECT_THAT(run.error, IsEmpty());
    EXPECT_THAT(folder.files(), ElementsAre("demo.txt", "demo.txt.json"));
    EXPECT_THAT(text_of(folder.path() / "demo.txt"), HasSubstr("stack_normal("));
    const auto json = nlohmann::json::parse(text_of(folder.path() / "demo.txt.json"));
    EXPECT_EQ(json["language"], language);
    EXPECT_EQ(json["textures"].size(), 3u);
    EXPECT_EQ(json["textures"][0]["map"], "demo/plates");
  }
}

TEST(Shader, StandaloneIncludesNothing) {
  const Folder folder;
  for (const bool standalone : {false, true}) {
    std::vector<std::string> arguments{"shader", "--lang", "glsl", "-o", "a.glsl"};
    if (standalone) arguments.push_back("--standalone");
    EXPECT_EQ(run_program(arguments, folder.path()).status, 0);
    const std::string code = text_of(folder.path() / "a.glsl");
    EXPECT_EQ(code.find("#include \"surfgrad.glsl\"") == std::string::npos, standalone);
    EXPECT_EQ(code.find("\nvec3 surfgrad_resolve_normal(") != std::string::npos, standalone);
  }
}

TEST(Shader, NamesAndTheSummaryForMachines) {
  const Folder folder;
  const Outcome run =
      run_program({"shader", "--lang", "wgsl", "--name", "skin", "-o", "a.wgsl", "--json"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.error;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["function"], "skin_normal");
  EXPECT_EQ(json["bindings"], "a.wgsl.json");
  EXPECT_THAT(text_of(folder.path() / "a.wgsl"), HasSubstr("fn skin_normal(s: SkinSurface) -> SkinResult"));
  EXPECT_THAT(text_of(folder.path() / "a.wgsl"), Not(HasSubstr("stack_")));
}

TEST(Shader, TheOriginOfTextures) {
  const Folder folder;
  const auto flips = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"shader", "-o", "a"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(arguments, folder.path()).status, 0);
    return text_of(folder.path() / "a").find("stack_from_top(") != std::string::npos;
  };
  EXPECT_FALSE(flips({"--lang", "glsl"}));
  EXPECT_TRUE(flips({"--lang", "glsl", "--origin", "upper_left"}));
  EXPECT_TRUE(flips({"--lang", "hlsl"}));
  EXPECT_FALSE(flips({"--lang", "hlsl", "--origin", "lower_left"}));
}

TEST(Shader, RoughnessWhereAsked) {
  const Folder folder;
  for (const bool asked : {false, true}) {
    std::vector<std::string> arguments{"shader", "--lang", "godot", "-o", "a"};
    if (asked) arguments.push_back("--roughness");
    EXPECT_EQ(run_program(arguments, folder.path()).status, 0);
    EXPECT_EQ(text_of(folder.path() / "a").find("roughness") != std::string::npos, asked);
    EXPECT_EQ(text_of(folder.path() / "a.json").find("\"roughness\"") != std::string::npos, asked);
  }
}

TEST(Shader, BindingsBeginWhereAsked) {
  const Folder folder;
  const Outcome run = run_program(
      {"shader", "--lang", "wgsl", "-o", "a.wgsl", "--first-binding", "7", "--group", "2"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(text_of(folder.path() / "a.wgsl"), HasSubstr("@group(2) @binding(7) var<uniform>"));
  const auto json = nlohmann::json::parse(text_of(folder.path() / "a.wgsl.json"));
  EXPECT_EQ(json["group"], 2);
  EXPECT_EQ(json["parameters"]["binding"], 7);
  EXPECT_EQ(json["textures"][0]["binding"], 8);
  EXPECT_EQ(json["textures"][0]["sampler_binding"], 11);
  for (const char* option : {"--first-binding", "--group"}) {
    EXPECT_EQ(run_program({"shader", "--lang", "wgsl", "-o", "a.wgsl", option, "-1"}, folder.path()).status,
              2);
    EXPECT_EQ(run_program({"shader", "--lang", "wgsl", "-o", "a.wgsl", option, "1000"}, folder.path()).status,
              2);
    const Outcome godot =
        run_program({"shader", "--lang", "godot", "-o", "a.gd", option, "1"}, folder.path());
    EXPECT_EQ(godot.status, 2);
    EXPECT_THAT(godot.error, HasSubstr("Godot numbers no bindings"));
  }
}

TEST(Shader, AMaterialIsChosenByName) {
  const Folder folder;
  folder.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl skin\nf 1/1 2/2 3/3\n"
                          "usemtl cloth\nf 1/1 3/3 2/2\n");
  folder.write("two.json", R"({ "surfgrad": 1, "mesh": "two.obj", "materials": {
    "skin": [ { "type": "noise", "frequency": 3 } ], "cloth": [ { "type": "noise", "function": "worley" } ] } })");
  const Outcome open = run_program({"shader", "two.json", "--lang", "glsl", "-o", "a.glsl"}, folder.path());
  EXPECT_EQ(open.status, 1);
  EXPECT_THAT(
      open.error,
      HasSubstr("two.json: has 2 materials with layers; choose one: --material \"skin\" or \"cloth\""));
  const Outcome wrong = run_program(
      {"shader", "two.json", "--lang", "glsl", "-o", "a.glsl", "--material", "hair"}, folder.path());
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.error, HasSubstr("has no material \"hair\""));
  EXPECT_THAT(folder.files(), ElementsAre("two.json", "two.obj"));
  const Outcome run = run_program(
      {"shader", "two.json", "--lang", "glsl", "-o", "a.glsl", "--material", "cloth"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(text_of(folder.path() / "a.glsl"), HasSubstr("surfgrad_worley("));
}

/// A stack of 66 decals in one layer.
void write_many_decals(const Folder& folder) {
  std::string layers;
  for (int i = 0; i < 66; ++i) layers += i > 0 ? ", {}" : "{}";
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("many.json", "{ \"surfgrad\": 1, \"mesh\": \"a.obj\", \"layers\": [\n"
                            "  { \"type\": \"decal\", \"map\": \"" SURFGRAD_SOURCE_DIR
                            "/docs/images/demo.png\",\n"
                            "    \"instances\": [" +
                                layers + "] } ] }");
}

TEST(Shader, WhatCannotBeSaidIsRefusedAndLeavesNoFile) {
  const Folder folder;
  write_many_decals(folder);
  for (const char* language : {"godot", "glsl_es"}) {
    const Outcome run =
        run_program({"shader", "many.json", "--lang", language, "-o", "a.txt"}, folder.path());
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.error,
                HasSubstr("many.json:2: layers[0]: brings the stack to 66 decals; a shader in this "
                          "language takes 64"));
    EXPECT_THAT(folder.files(), ElementsAre("a.obj", "many.json"));
  }
}

TEST(Shader, WhatOnlyOneGLSLTakesIsWarnedOf) {
  const Folder folder;
  write_many_decals(folder);
  const char* const warning =
      "many.json:2: layers[0]: brings the stack to 66 decals; the code compiles as GLSL "
      "450 alone, as ES takes 64";
  const Outcome run = run_program({"shader", "many.json", "--lang", "glsl", "-o", "a.glsl"}, folder.path());
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.error, HasSubstr(std::string("warning: ") + warning));
  const Outcome json =
      run_program({"shader", "many.json", "--lang", "glsl", "-o", "a.glsl", "--json", "-q"}, folder.path());
  EXPECT_EQ(json.error, "");
  EXPECT_EQ(nlohmann::json::parse(json.out)["warnings"], nlohmann::json::array({warning}));
  const Outcome hlsl =
      run_program({"shader", "many.json", "--lang", "hlsl", "-o", "a.hlsl", "--json"}, folder.path());
  EXPECT_EQ(hlsl.error, "");
  EXPECT_TRUE(nlohmann::json::parse(hlsl.out)["warnings"].empty());
}

TEST(Shader, BothFilesAreReplacedOrNone) {
  const Folder folder;
  ASSERT_EQ(run_program({"shader", "--lang", "hlsl", "-o", "a"}, folder.path()).status, 0);
  const auto size = [&](const char* file) { return std::filesystem::file_size(folder.path() / file); };
  const std::uintmax_t code = size("a"), bindings = size("a.json");
  ASSERT_NE(code, bindings);
  // Room for one of the two, whichever is written first; for neither; and for both.
  const auto run_with_room_for = [&](std::uintmax_t bytes) {
    folder.write("a", "old code");
    folder.write("a.json", "old bindings");
    const test::FileSizeLimit limit(bytes);
    return run_program({"shader", "--lang", "hlsl", "-o", "a", "-q"}, folder.path());
  };
  for (const std::uintmax_t room : {(code + bindings) / 2, std::uintmax_t{100}}) {
    const Outcome run = run_with_room_for(room);
    EXPECT_EQ(run.status, 3) << run.error;
    EXPECT_THAT(run.error, HasSubstr("write"));
    EXPECT_EQ(text_of(folder.path() / "a"), "old code");
    EXPECT_EQ(text_of(folder.path() / "a.json"), "old bindings");
    EXPECT_THAT(folder.files(), ElementsAre("a", "a.json"));
  }
  EXPECT_EQ(run_with_room_for(2 * (code + bindings)).status, 0);
  EXPECT_EQ(size("a"), code);
  EXPECT_EQ(size("a.json"), bindings);
}

TEST(Shader, NoInputIsReplacedAndNoFolder) {
  const Folder folder;
  const std::string stack =
      R"({ "surfgrad": 1, "mesh": "a.obj", "layers": [ { "type": "normal_map", "map": "n.png" } ] })";
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  folder.write("n.png", text_of(SURFGRAD_SOURCE_DIR "/docs/images/demo.png"));
  folder.write("rock.json", stack);
  std::filesystem::create_directory(folder.path() / "sub");
  std::filesystem::create_directory(folder.path() / "b.json");
  const std::vector<std::string> before = folder.files();
  const auto refusal = [&](const char* output) {
    const Outcome run = run_program({"shader", "rock.json", "--lang", "glsl", "-o", output}, folder.path());
    EXPECT_EQ(run.status, 1) << output;
    return run.error;
  };
  EXPECT_THAT(refusal("rock"),
              HasSubstr("rock.json: would replace a file of the scene; give -o another name"));
  EXPECT_THAT(refusal("sub/../rock.json"), HasSubstr("would replace a file of the scene"));
  EXPECT_THAT(refusal("n.png"), HasSubstr("n.png: would replace a file of the scene"));
  EXPECT_THAT(refusal("a.obj"), HasSubstr("a.obj: would replace a file of the scene"));
  EXPECT_THAT(refusal("sub"), HasSubstr("sub: is a folder"));
  EXPECT_THAT(refusal("b"), HasSubstr("b.json: is a folder"));
  const Outcome dash = run_program({"shader", "rock.json", "--lang", "glsl", "-o", "-"}, folder.path());
  EXPECT_EQ(dash.status, 2);
  EXPECT_THAT(dash.error, HasSubstr("two files are written"));
  EXPECT_EQ(folder.files(), before);
  EXPECT_EQ(text_of(folder.path() / "rock.json"), stack);
}

TEST(Shader, UsageMistakes) {
  const Folder folder;
  EXPECT_EQ(run_program({"shader", "-o", "a.glsl"}, folder.path()).status, 2);
  for (const char* word : {"cg", "0", "GLSL", ""}) {
    const Outcome language = run_program({"shader", "--lang", word, "-o", "a.cg"}, folder.path());
    EXPECT_EQ(language.status, 2) << word;
    EXPECT_THAT(language.error,
                HasSubstr(std::string(word) + "\" is none of glsl, glsl_es, godot, hlsl, wgsl"));
  }
  const Outcome name =
      run_program({"shader", "--lang", "glsl", "--name", "My_Skin", "-o", "a"}, folder.path());
  EXPECT_EQ(name.status, 2);
  EXPECT_THAT(name.error, HasSubstr("is not a lower-case letter followed by letters and digits"));
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(Shader, ThePagesCommandsWork) {
  const Folder folder;
  EXPECT_GE(run_commands_of("docs/shader-export.md", folder), 4);
}

} // namespace
} // namespace surfgrad
