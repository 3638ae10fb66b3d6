/// The snippets of docs/shaders.md and the example shaders compile: readers paste them.

#include "shaders/compilers.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::test {
namespace {

struct Snippet {
  std::string section;
  std::string language; ///< as after the fence
  std::string text;
};

/// The code blocks of the document, line by line; what includes or imports the library is left out.
std::vector<Snippet> snippets() {
  std::ifstream file(SURFGRAD_SOURCE_DIR "/docs/shaders.md");
  std::vector<Snippet> found;
  std::string section;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) {
      if (!inside) found.push_back({section, line.substr(3), ""});
      inside = !inside;
    } else if (inside) {
      if (!line.starts_with("#include") && !line.starts_with("#import")) found.back().text += line + "\n";
    } else if (line.starts_with("## ")) {
      section = line.substr(3);
    }
  }
  return found;
}

/// What a snippet stands in: what its engine, or the reader's own shader, has before it and after it.
struct Surroundings {
  std::string before, after;
};

// The names that the first two sections use.
const std::string glsl_inputs = R"(
layout(binding = 0) uniform sampler2D map;
layout(binding = 1) uniform sampler2D detail_map;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 st;
layout(location = 4) in vec2 detail_st;
layout(location = 0) out vec4 colour;
void main() {
)";
const std::string hlsl_inputs = R"(
[[vk::binding(0)]] Texture2D map;
[[vk::binding(1)]] SamplerState linear_wrap;
float4 main(float3 normal : NORMAL, float4 tangent : TANGENT, float2 st : TEXCOORD0) : SV_Target {
)";
const std::string wgsl_inputs = R"(
@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var linear_wrap: sampler;
@fragment fn main(@location(0) normal: vec3f, @location(1) tangent: vec4f, @location(2) st: vec2f,
                  @location(3) dst: vec2f, @location(4) lod: f32) -> @location(0) vec4f {
)";
const std::string godot_builtins = R"(
in vec3 VERTEX;
in vec3 TANGENT;
in vec3 BINORMAL;
in vec2 UV;
in vec2 UV2;
out vec3 NORMAL;
)";
const std::string three_chunks = R"(
uniform sampler2D normalMap;
uniform sampler2D detailMap;
uniform vec2 normalScale;
in vec2 vNormalMapUv;
in vec3 vViewPosition;
in vec3 vNormal;
out vec4 colour;
#define texture2D texture
void main() {
vec3 normal = normalize(vNormal);
)";
const std::string unreal_inputs = R"(
float3 custom_node(float3 Position, float3 Normal, float3 Tangent, float3 Bitangent, float3 Base, float3 Detail,
                   float2 DetailUV) {
)";
const std::string engine_main = R"(
float4 main(float3 a : TEXCOORD0, float2 st : TEXCOORD1) : SV_Target {
  float3 n;
)";

/// By section, language and number among its own.
const std::map<std::string, Surroundings> surroundings{
    {"Three lines glsl 1", {glsl_inputs, "colour = vec4(n, 1.0);\n}\n"}},
    {"Three lines hlsl 1", {hlsl_inputs, "return float4(n, 1.0);\n}\n"}},
    {"Three lines wgsl 1", {wgsl_inputs, "return vec4f(n, 1.0);\n}\n"}},
    {"From one map to many glsl 1", {glsl_inputs, "colour = vec4(n, 1.0);\n}\n"}},
    {"From one map to many wgsl 1",
     {wgsl_inputs, "return vec4f(hit.texture_coordinate, hit.height, 1.0);\n}\n"}},
    {"Unity hlsl 1",
     {"", engine_main + "SurfgradDetail_float(a, a, a, a, a, a, st, 1.0, n);\nreturn float4(n, 1.0);\n}\n"}},
    {"Unreal hlsl 1",
     {unreal_inputs,
      "}\n" + engine_main + "n = custom_node(a, a, a, a, a, a, st);\nreturn float4(n, 1.0);\n}\n"}},
    {"Godot glsl 1", {godot_builtins, "void main() {\nfragment();\n}\n"}},
    {"three.js glsl 1", {three_chunks, "colour = vec4(normal, 1.0);\n}\n"}},
    {"Bevy wgsl 1",
     {"struct VertexOutput {\n  @location(0) world_position: vec4f,\n  @location(1) world_normal: vec3f,\n"
      "  @location(2) uv: vec2f,\n}\n",
      "@fragment fn main(in: VertexOutput, @builtin(front_facing) front: bool) -> @location(0) vec4f {\n"
      "  return vec4f(bumped_normal(in, front), 1.0);\n}\n"}},
};

/// Godot's own words that GLSL does not have, as what they mean.
std::string from_godot(std::string text) {
  for (const auto& [word, meaning] : {std::pair<std::string, std::string>{"shader_type spatial;", ""},
                                      {" : hint_normal", ""},
                                      {"#define SURFGRAD_GODOT\n", ""}})
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word))
      text.replace(at, word.size(), meaning);
  return text;
}

Verdict compile(const Snippet& snippet, const Surroundings& around) {
  const std::string& section = snippet.section;
  const std::string text = around.before + snippet.text + around.after;
  if (snippet.language == "wgsl") return compile_wgsl(library("surfgrad.wgsl") + text);
  if (snippet.language == "hlsl") return compile_hlsl(library("surfgrad.hlsl") + text, "frag");
  if (section == "Godot")
    return compile_glsl(
        "#version 300 es\nprecision highp float;\nprecision highp int;\n#define SURFGRAD_GODOT\n" +
            library("surfgrad.glsl") + from_godot(text),
        "frag");
  if (section == "three.js")
    return compile_glsl("#version 300 es\n" + library("surfgrad.glsl") + text, "frag");
  return compile_glsl("#version 450\n#define SURFGRAD_FRAGMENT\n" + library("surfgrad.glsl") + text, "frag");
}

TEST(ShaderDocument, EverySnippetCompiles) {
  std::map<std::string, int> numbers;
  std::size_t compiled = 0;
  for (const Snippet& snippet : snippets()) {
    if (snippet.language == "js") continue; // what three.js' programs say around the chunk
    const std::string kind = snippet.section + " " + snippet.language;
    const std::string name = kind + " " + std::to_string(++numbers[kind]);
    SCOPED_TRACE(name);
    const auto around = surroundings.find(name);
    ASSERT_NE(around, surroundings.end()) << "no surroundings to compile it in";
    const Verdict verdict = compile(snippet, around->second);
    EXPECT_TRUE(verdict.accepted) << verdict.messages;
    EXPECT_EQ(verdict.messages, "");
    ++compiled;
  }
  EXPECT_EQ(compiled, surroundings.size());
}

TEST(ShaderExamples, DisplaceAndBumpCompile) {
  for (const std::string stage : {"vert", "frag"}) {
    const Verdict verdict = compile_glsl_file("examples/displace_bump." + stage, stage);
    EXPECT_TRUE(verdict.accepted) << verdict.messages;
    EXPECT_EQ(verdict.messages, "");
  }
}

} // namespace
} // namespace surfgrad::test
