// Several exports stand in one program: their names, library functions and bindings do not meet.

#include "diagnostic/error.hpp"
#include "shaders/compilers.hpp"
#include "stacks.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>
#include <set>
#include <stdexcept>

namespace surfgrad::shadergen::test {
namespace {

using surfgrad::test::Verdict;
using testing::HasSubstr;

/// Two materials that share many functions of the library, and have some that the other lacks.
std::vector<Shader> two_exports(Language language, bool standalone, int first_binding, int group) {
  std::vector<Shader> shaders;
  for (const NamedStack& stack : every_kind()) {
    if (stack.name != "torus" && stack.name != "decals") continue;
    Options options = options_of(stack, language);
    options.standalone = standalone;
    if (!shaders.empty()) {
      options.first_binding = first_binding;
      options.group = group;
    }
    shaders.push_back(generate(stack.layers, options));
  }
  return shaders;
}

std::string joined(const std::vector<Shader>& shaders) {
  return std::regex_replace(shaders[0].source + shaders[1].source, std::regex("#include [^\n]*\n"), "");
}

std::string fragment_of_glsl(const std::vector<Shader>& shaders) {
  std::string calls;
  for (const Shader& s : shaders)
    calls += fmt::format("  {{ {}Surface s; s.normal = n; color.xyz += {}_normal(s).normal; }}\n",
                         s.type_name, s.name);
  return "layout(location = 0) out vec4 color;\nin vec3 n;\nvoid main() {\n  color = vec4(0.0);\n" + calls +
         "}\n";
}

std::string fragment_of_hlsl(const std::vector<Shader>& shaders) {
  std::string calls;
  for (const Shader& s : shaders)
    calls += fmt::format("  {{ {0}Surface s = ({0}Surface)0; s.normal = n; sum += {1}_normal(s).normal; }}\n",
                         s.type_name, s.name);
  return "float4 main(float3 n : NORMAL) : SV_Target {\n  float3 sum = float3(0.0, 0.0, 0.0);\n" + calls +
         "  return float4(sum, 1.0);\n}\n";
}

void expect_accepted(const Verdict& verdict, const std::string& what) {
  EXPECT_TRUE(verdict.accepted) << what << "\n" << verdict.messages.substr(0, 4000);
  EXPECT_EQ(verdict.messages, "") << what;
}

void expect_glsl(const std::vector<Shader>& shaders, const std::string& before, const std::string& what) {
  const std::string code = before + joined(shaders) + fragment_of_glsl(shaders);
  const std::string desktop =
      std::regex_replace(code, std::regex("\nin vec3 n;"), "\nlayout(location = 0) in vec3 n;");
  expect_accepted(surfgrad::test::compile_glsl("#version 450\n" + desktop, "frag"), what + ", 450");
  expect_accepted(surfgrad::test::compile_glsl("#version 300 es\n" + code, "frag"), what + ", ES");
}

TEST(Joined, StandaloneExportsShareTheirFunctions) {
  expect_glsl(two_exports(Language::glsl, true, 10, 0), "", "GLSL");
  const std::vector<Shader> hlsl = two_exports(Language::hlsl, true, 6, 0);
  expect_accepted(surfgrad::test::compile_hlsl(joined(hlsl) + fragment_of_hlsl(hlsl), "frag"), "HLSL");
  const std::vector<Shader> godot = two_exports(Language::godot, true, 0, 0);
  expect_accepted(surfgrad::test::compile_glsl(
                      "#version 300 es\n" + as_glsl_es(joined(godot)) + fragment_of_glsl(godot), "frag"),
                  "Godot");
}

TEST(Joined, StandaloneExportsStandAfterTheLibrary) {
  expect_glsl(two_exports(Language::glsl, true, 10, 0), surfgrad::test::library("surfgrad.glsl"), "GLSL");
  const std::vector<Shader> hlsl = two_exports(Language::hlsl, true, 6, 0);
  expect_accepted(surfgrad::test::compile_hlsl(surfgrad::test::library("surfgrad.hlsl") + joined(hlsl) +
                                                   fragment_of_hlsl(hlsl),
                                               "frag"),
                  "HLSL");
}

TEST(Joined, ExportsInGroupsOfTheirOwn) {
  expect_glsl(two_exports(Language::glsl, false, 0, 1), surfgrad::test::library("surfgrad.glsl"), "GLSL");
  const std::vector<Shader> hlsl = two_exports(Language::hlsl, false, 0, 1);
  expect_accepted(surfgrad::test::compile_hlsl(surfgrad::test::library("surfgrad.hlsl") + joined(hlsl) +
                                                   fragment_of_hlsl(hlsl),
                                               "frag"),
                  "HLSL");
  for (const int group : {0, 1}) {
    const std::vector<Shader> wgsl = two_exports(Language::wgsl, false, group == 0 ? 20 : 0, group);
    std::string calls;
    for (const Shader& s : wgsl)
      calls += fmt::format("  var s{0}: {1}Surface;\n  s{0}.normal = n;\n  sum += {0}_normal(s{0}).normal;\n",
                           s.name, s.type_name);
    expect_accepted(
        surfgrad::test::compile_wgsl(
            surfgrad::test::library("surfgrad.wgsl") + joined(wgsl) +
            "@fragment fn main(@location(0) n: vec3f) -> @location(0) vec4f {\n  var sum = vec3f();\n" +
            calls + "  return vec4f(sum, 1.0);\n}\n"),
        fmt::format("WGSL, group {}", group));
  }
}

/// Where the code itself puts what is bound: register, or group and number.
std::multiset<std::string> places_in(const Shader& shader) {
  const std::regex place(shader.language == Language::hlsl ? "register\\(([^)]*)\\)"
                         : shader.language == Language::wgsl
                             ? "@group\\((\\d+)\\) @binding\\((\\d+)\\)"
                             : "SURFGRAD_(?:BINDING|TEXTURE)(?:_IN)?\\((\\d[^)]*)\\)");
  std::multiset<std::string> places;
  for (std::sregex_iterator i(shader.source.begin(), shader.source.end(), place), end; i != end; ++i)
    places.insert((*i)[1].str() + (i->size() > 2 ? "," + (*i)[2].str() : ""));
  return places;
}

/// The same by what the program is told.
std::multiset<std::string> places_told(const Shader& shader) {
  const auto json = nlohmann::json::parse(manifest(shader));
  const int group = json["group"];
  std::multiset<std::string> places;
  const auto tell = [&](const char* kind, int number) {
    if (shader.language == Language::hlsl)
      places.insert(fmt::format("{}{}", kind, number) + (group > 0 ? fmt::format(", space{}", group) : ""));
    else if (shader.language == Language::wgsl)
      places.insert(fmt::format("{},{}", group, number));
    else
      places.insert((group > 0 ? fmt::format("{}, ", group) : "") + std::to_string(number));
  };
  tell("b", json["parameters"]["binding"]);
  if (json.contains("decals")) tell("t", json["decals"]["binding"]);
  std::set<int> samplers;
  for (const auto& texture : json["textures"]) {
    tell("t", texture["binding"]);
    if (texture.contains("sampler_binding")) samplers.insert(int{texture["sampler_binding"]});
  }
  for (const int sampler : samplers) tell("s", sampler);
  return places;
}

TEST(Joined, NothingIsBoundWhereSomethingElseIs) {
  for (const Language language : {Language::glsl, Language::hlsl, Language::wgsl})
    for (const int group : {0, 2}) {
      const std::vector<Shader> shaders =
          two_exports(language, false, language == Language::hlsl ? 6 : 20, group);
      std::multiset<std::string> all;
      for (const Shader& shader : shaders) {
        EXPECT_EQ(places_in(shader), places_told(shader)) << shader.name;
        for (const std::string& place : places_in(shader)) all.insert(place);
      }
      EXPECT_GT(all.size(), 8u);
      EXPECT_EQ(all.size(), std::set<std::string>(all.begin(), all.end()).size());
      EXPECT_EQ(shaders[1].group, group);
      EXPECT_EQ(shaders[1].parameters_binding, language == Language::hlsl ? 6 : 20);
    }
}

TEST(Joined, RegistersEndWhereShaderModel5DoesButInASpace) {
  const auto refusal = [](int first, int group) -> std::string {
    const NamedStack stack = two_passes();
    Options options = options_of(stack, Language::hlsl);
    options.first_binding = first;
    options.group = group;
    try {
      static_cast<void>(generate(stack.layers, options));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(13, 0), "accepted");
  EXPECT_THAT(refusal(14, 0), HasSubstr("register b14; shader model 5.0 has b0 to b13"));
  EXPECT_EQ(refusal(900, 1), "accepted");
  EXPECT_THROW(static_cast<void>(generate({}, {.first_binding = -1})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(generate({}, {.group = -1})), std::invalid_argument);
}

TEST(Joined, TheBufferOfDecalsTakesARegisterFromTheTextures) {
  const auto with_maps = [](int count) {
    std::string layers = R"({ "type": "decal", "map": "a.png" })";
    for (int i = 1; i < count; ++i)
      layers += fmt::format(",\n{{ \"type\": \"normal_map\", \"map\": \"{}.png\" }}", i);
    return parsed("many", "{ \"surfgrad\": 1, \"layers\": [\n" + layers + "] }");
  };
  const NamedStack fits = with_maps(127), many = with_maps(128);
  static_cast<void>(generate(fits.layers, options_of(fits, Language::hlsl)));
  try {
    static_cast<void>(generate(many.layers, options_of(many, Language::hlsl)));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("many.json:129: layers[127]: has a texture at register t128"));
  }
}

} // namespace
} // namespace surfgrad::shadergen::test
