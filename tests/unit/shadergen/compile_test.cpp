// What is generated compiles: the stacks of every kind, of the examples and of the gallery, in every
// language. Many stacks stand in one shader under names of their own, as a program with many materials has
// them.

#include "gallery/figures.hpp"
#include "scene/scene.hpp"
#include "shaders/compilers.hpp"
#include "stacks.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>

namespace surfgrad::shadergen::test {
namespace {

using surfgrad::test::Verdict;

/// The stacks of the gallery that a shader can express.
std::vector<NamedStack> gallery_stacks() {
  std::vector<NamedStack> stacks;
  for (const gallery::Figure& figure : gallery::built_in_figures())
    for (const gallery::Panel& panel : figure.panels) {
      const scene::Scene scene = panel.scene();
      for (const scene::Material& material : scene.materials)
        stacks.push_back(
            {fmt::format("g{}", stacks.size()), material.layers, material.back_faces, scene.displace});
    }
  return stacks;
}

std::vector<NamedStack> example_stacks() {
  std::vector<NamedStack> stacks;
  for (const auto& entry : std::filesystem::directory_iterator(SURFGRAD_SOURCE_DIR "/examples/stacks")) {
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    stacks.push_back(parsed(fmt::format("e{}", stacks.size()), text));
  }
  return stacks;
}

/// Calls of every stack's functions, as the body of a fragment shader: `n` is its normal.
std::string calls(const std::vector<Shader>& shaders, const std::function<std::string(const Shader&)>& call) {
  std::string text;
  for (const Shader& shader : shaders) text += call(shader);
  return text;
}

std::vector<Shader> shaders_of(const std::vector<NamedStack>& stacks, Options options) {
  std::vector<Shader> shaders;
  for (const NamedStack& stack : stacks) {
    const Options own = options_of(stack, options.language);
    options.name = own.name;
    options.back_faces = own.back_faces;
    options.displace = own.displace;
    shaders.push_back(generate(stack.layers, options));
  }
  return shaders;
}

std::string without_includes(const std::string& code) {
  return std::regex_replace(code, std::regex("#include [^\n]*\n"), "");
}

std::string joined(const std::vector<Shader>& shaders) {
  std::string text;
  for (const Shader& shader : shaders) text += without_includes(shader.source);
  return text;
}

bool takes_derivatives(const Shader& shader) {
  return shader.source.find(shader.name + "_with_derivatives") != std::string::npos;
}

void expect_accepted(const Verdict& verdict, const std::string& what) {
  EXPECT_TRUE(verdict.accepted) << what << "\n" << verdict.messages.substr(0, 4000);
  EXPECT_EQ(verdict.messages, "") << what;
}

std::string main_of_glsl(const std::vector<Shader>& shaders, bool es) {
  const std::string body = calls(shaders, [](const Shader& s) {
    return "  { " + s.type_name + "Surface s; s.normal = n;" +
           (takes_derivatives(s) ? " s = " + s.name + "_with_derivatives(s);" : "") +
           " color.xyz += " + s.name + "_normal(s).normal; }\n";
  });
  return std::string(es ? "out vec4 color;\nin vec3 n;\n"
                        : "layout(location = 0) out vec4 color;\nlayout(location = 0) in vec3 n;\n") +
         "void main() {\n  color = vec4(0.0);\n" + body + "}\n";
}

/// Of two languages that share its text.
void expect_glsl(const std::vector<NamedStack>& stacks, Options options) {
  options.language = Language::glsl;
  const std::vector<Shader> shaders = shaders_of(stacks, options);
  const std::string code =
      "#define SURFGRAD_FRAGMENT\n" + surfgrad::test::library("surfgrad.glsl") + joined(shaders);
  expect_accepted(
      surfgrad::test::compile_glsl("#version 450\n" + code + main_of_glsl(shaders, false), "frag"), "450");
  expect_accepted(
      surfgrad::test::compile_glsl("#version 300 es\n" + code + main_of_glsl(shaders, true), "frag"), "ES");
}

void expect_hlsl(const std::vector<NamedStack>& stacks, Options options) {
  options.language = Language::hlsl;
  const std::vector<Shader> shaders = shaders_of(stacks, options);
  const std::string body = calls(shaders, [](const Shader& s) {
    return "  { " + s.type_name + "Surface s = (" + s.type_name + "Surface)0; s.normal = n;" +
           (takes_derivatives(s) ? " s = " + s.name + "_with_derivatives(s);" : "") + " sum += " + s.name +
           "_normal(s).normal; }\n";
  });
  expect_accepted(surfgrad::test::compile_hlsl("#define SURFGRAD_FRAGMENT\n" +
                                                   surfgrad::test::library("surfgrad.hlsl") +
                                                   joined(shaders) +
                                                   "float4 main(float3 n : NORMAL) : SV_Target {\n"
                                                   "  float3 sum = float3(0.0, 0.0, 0.0);\n" +
                                                   body + "  return float4(sum, 1.0);\n}\n",
                                               "frag"),
                  "HLSL");
}

void expect_wgsl(const std::vector<NamedStack>& stacks, Options options) {
  options.language = Language::wgsl;
  const std::vector<Shader> shaders = shaders_of(stacks, options);
  expect_accepted(surfgrad::test::compile_wgsl(surfgrad::test::library("surfgrad.wgsl") + joined(shaders)),
                  "WGSL");
}

/// A word of GLSL that Godot's shading language lacks, as a declaration or at all; empty where there is none.
std::string word_that_godot_lacks(const std::string& source) {
  const std::string code = std::regex_replace(source, std::regex("//[^\n]*"), "");
  static const std::regex words(
      "\\b(precision|precise|layout|buffer|binding|shared|attribute|subroutine|coherent|"
      "restrict|readonly|writeonly|dFdxFine|dFdyFine|gl_\\w+|double|dvec[234])\\b|"
      "#(version|extension)\\b|(^|\n)(in|out)\\b");
  std::smatch match;
  return std::regex_search(code, match, words) ? match.str() : "";
}

/// Godot's language is GLSL but for its uniforms: without their hints and values it is checked as that, once
/// it has none of the words that only GLSL has.
void expect_godot(const std::vector<NamedStack>& stacks, Options options) {
  options.language = Language::godot;
  for (const Shader& shader : shaders_of(stacks, options)) {
    EXPECT_EQ(word_that_godot_lacks(shader.source), "") << shader.name;
    expect_accepted(surfgrad::test::compile_glsl("#version 300 es\n" + as_glsl_es(shader.source) +
                                                     main_of_glsl({shader}, true),
                                                 "frag"),
                    "Godot " + shader.name);
  }
}

void expect_exact(const std::vector<NamedStack>& stacks, Options options = {}) {
  options.access = TextureAccess::exact;
  options.diagnostics = true;
  for (const Shader& shader : shaders_of(stacks, options)) {
    const std::string main = "layout(local_size_x = 1) in;\n"
                             "layout(std430, set = 0, binding = 60) buffer Out { vec4 color; };\n"
                             "void main() { " +
                             shader.type_name +
                             "Surface s; s.normal = vec3(1.0); color.xyz = " + shader.name +
                             "_normal(s).normal; }\n";
    expect_accepted(
        surfgrad::test::compile_glsl("#version 450\n" + exact_words(shader) + shader.source + main, "comp"),
        "exact " + shader.name);
  }
}

TEST(Compile, EveryKindWithTheLibrary) {
  for (const TextureOrigin origin : {TextureOrigin::lower_left, TextureOrigin::upper_left}) {
    const Options options{.origin = origin};
    expect_glsl(every_kind(), options);
    expect_hlsl(every_kind(), options);
    expect_wgsl(every_kind(), options);
  }
}

TEST(Compile, EveryKindInGodot) { expect_godot(every_kind(), {}); }

TEST(Compile, AsItStandsWithItsInclude) {
  const NamedStack stack = two_passes();
  const Shader glsl = generate(stack.layers, options_of(stack, Language::glsl));
  ASSERT_NE(glsl.source.find("#include \"surfgrad.glsl\""), std::string::npos);
  const std::string extension = "#extension GL_GOOGLE_include_directive : require\n";
  expect_accepted(surfgrad::test::compile_glsl_with_includes("#version 450\n#define SURFGRAD_FRAGMENT\n" +
                                                                 extension + glsl.source +
                                                                 main_of_glsl({glsl}, false),
                                                             "frag"),
                  "GLSL " + stack.name);
  const Shader hlsl = generate(stack.layers, options_of(stack, Language::hlsl));
  ASSERT_NE(hlsl.source.find("#include \"surfgrad.hlsl\""), std::string::npos);
  expect_accepted(
      surfgrad::test::compile_hlsl(
          hlsl.source + "float4 main() : SV_Target { return float4(0.0, 0.0, 0.0, 0.0); }\n", "frag"),
      "HLSL " + stack.name);
}

TEST(Compile, EveryKindWithRoughness) {
  const Options options{.roughness = true};
  expect_glsl(every_kind(), options);
  expect_hlsl(every_kind(), options);
  expect_wgsl(every_kind(), options);
  expect_godot(every_kind(), options);
}

TEST(Compile, EveryKindStandalone) {
  for (const NamedStack& stack : every_kind()) {
    Options options = options_of(stack, Language::glsl);
    options.standalone = true;
    const Shader glsl = generate(stack.layers, options);
    expect_accepted(surfgrad::test::compile_glsl("#version 450\n#define SURFGRAD_FRAGMENT\n" + glsl.source +
                                                     main_of_glsl({glsl}, false),
                                                 "frag"),
                    "GLSL " + stack.name);
    options.language = Language::hlsl;
    expect_accepted(
        surfgrad::test::compile_hlsl(generate(stack.layers, options).source +
                                         "float4 main() : SV_Target { return float4(0.0, 0.0, 0.0, 0.0); }\n",
                                     "frag"),
        "HLSL " + stack.name);
  }
}

TEST(Compile, EveryKindOutOfBuffers) { expect_exact(every_kind()); }
TEST(Compile, EveryKindWithTexturesBesideBuffers) {
  Options options;
  options.samples = [](const MapSite&, const TextureBinding&) { return true; };
  expect_exact(every_kind(), options);
}

TEST(Compile, TheGalleryAndTheExamplesInEveryLanguage) {
  std::vector<NamedStack> stacks = gallery_stacks();
  EXPECT_GT(stacks.size(), 30u);
  const std::vector<NamedStack> examples = example_stacks();
  EXPECT_FALSE(examples.empty());
  stacks.insert(stacks.end(), examples.begin(), examples.end());
  expect_glsl(stacks, {});
  expect_hlsl(stacks, {});
  expect_wgsl(stacks, {});
  expect_godot(stacks, {});
}

TEST(Compile, WhatDependsOnTheCompilerIsSaidOnceAndUnderItsCondition) {
  for (const NamedStack& stack : every_kind()) {
    Options options = options_of(stack, Language::glsl);
    options.standalone = true;
    const std::string source = generate(stack.layers, options).source;
    const std::size_t first = source.find("precision highp float;");
    EXPECT_EQ(source.find("#ifdef GL_ES\nprecision highp float;"), first - 13) << stack.name;
    EXPECT_EQ(source.find("precision highp float;", first + 1), std::string::npos) << stack.name;
  }
}

} // namespace
} // namespace surfgrad::shadergen::test
