// What a language cannot express is refused, with the layer's name and the reason.

#include "diagnostic/error.hpp"
#include "stacks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace surfgrad::shadergen::test {
namespace {

using testing::HasSubstr;

std::string refusal(const NamedStack& stack, Language language) {
  try {
    static_cast<void>(generate(stack.layers, options_of(stack, language)));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

NamedStack with_maps(int count) {
  std::string layers;
  for (int i = 0; i < count; ++i)
    layers += (i > 0 ? ",\n" : "") + std::string(R"({ "type": "normal_map", "map": ")") + std::to_string(i) +
              ".png\" }";
  return parsed("many", "{ \"surfgrad\": 1, \"layers\": [\n" + layers + "] }");
}

NamedStack with_decals(int count) {
  NamedStack stack = parsed("many", R"({ "surfgrad": 1, "layers": [
    { "type": "noise" },
    { "type": "decal", "map": "a.png" } ] })");
  std::get<stack::DecalLayer>(stack.layers[1]).instances.resize(static_cast<std::size_t>(count));
  return stack;
}

TEST(Limits, Textures) {
  EXPECT_EQ(refusal(with_maps(16), Language::glsl), "accepted");
  EXPECT_THAT(refusal(with_maps(17), Language::glsl),
              HasSubstr("many.json:18: layers[16]: brings the stack to more than 16 textures"));
  EXPECT_THAT(refusal(with_maps(17), Language::wgsl), HasSubstr("layers[16]"));
  EXPECT_EQ(refusal(with_maps(128), Language::hlsl), "accepted");
  EXPECT_THAT(refusal(with_maps(129), Language::hlsl), HasSubstr("layers[128]"));
}

TEST(Limits, Decals) {
  for (const Language language : {Language::glsl, Language::hlsl, Language::wgsl}) {
    EXPECT_EQ(refusal(with_decals(4096), language), "accepted");
    EXPECT_THAT(
        refusal(with_decals(4097), language),
        HasSubstr(
            "many.json:3: layers[1]: brings the stack to 4097 decals; a shader in this language takes 4096"));
  }
  EXPECT_EQ(refusal(with_decals(64), Language::godot), "accepted");
  EXPECT_THAT(refusal(with_decals(65), Language::godot), HasSubstr("takes 64"));
}

TEST(Limits, WhatOnlyDesktopGLSLTakesNamesTheLayerThatGoesBeyond) {
  NamedStack stack = with_decals(64);
  const auto beyond = [&](Language language, bool es) {
    Options options = options_of(stack, language);
    options.es = es;
    return generate(stack.layers, options).beyond_es;
  };
  for (const Language language : every_language) EXPECT_EQ(beyond(language, false), "");
  EXPECT_EQ(beyond(Language::glsl, true), "");
  stack = parsed("two", R"({ "surfgrad": 1, "layers": [
    { "type": "decal", "map": "a.png" },
    { "type": "decal", "map": "a.png" },
    { "type": "decal", "map": "a.png" } ] })");
  std::get<stack::DecalLayer>(stack.layers[1]).instances.resize(64);
  EXPECT_EQ(
      beyond(Language::glsl, false),
      "two.json:3: layers[1]: brings the stack to 65 decals; the code compiles as GLSL 450 alone, as ES "
      "takes 64");
  EXPECT_EQ(beyond(Language::hlsl, false), "");
  EXPECT_EQ(beyond(Language::hlsl, true), "");
  try {
    static_cast<void>(beyond(Language::glsl, true));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("two.json:3: layers[1]: brings the stack to 65 decals"));
  }
}

TEST(Limits, MoreDecalsThanOpenGLESTakesAreAnErrorThereAlone) {
  const auto source = [](int count) {
    return generate(with_decals(count).layers, options_of(with_decals(count), Language::glsl)).source;
  };
  EXPECT_THAT(source(65), HasSubstr("#ifdef GL_ES\n#error \"This stack has 65 decals; GLSL ES takes 64.\""));
  EXPECT_THAT(source(64), testing::Not(HasSubstr("#error")));
}

TEST(Limits, AFunctionOfTheProgramsOwn) {
  NamedStack stack = parsed("own", R"({ "surfgrad": 1, "layers": [ { "type": "noise" } ] })");
  std::get<stack::NoiseLayer>(stack.layers[0]).custom.emplace([](vec3<double> p) {
    return Noise<double>{p.x, {1, 0, 0}};
  });
  for (const Language language : every_language)
    EXPECT_THAT(refusal(stack, language), HasSubstr("layers[0]: is a function of the program's own"));
}

TEST(Limits, WrapsThatGodotLacks) {
  const NamedStack stack = parsed(
      "mirror",
      R"({ "surfgrad": 1, "layers": [ { "type": "normal_map", "map": "a.png", "wrap": "mirror" } ] })");
  EXPECT_THAT(refusal(stack, Language::godot), HasSubstr(R"(layers[0]: has "wrap": "mirror")"));
  EXPECT_EQ(refusal(stack, Language::glsl), "accepted");
}

TEST(Limits, NamesOfFilesStayWithinTheirComments) {
  const NamedStack stack =
      parsed("odd", R"({ "surfgrad": 1, "layers": [ { "type": "normal_map", "map": "new\nline.png\\" } ] })");
  const std::string source = generate(stack.layers, options_of(stack, Language::glsl)).source;
  EXPECT_THAT(source, HasSubstr("new?line.png?\n"));
}

TEST(Limits, ADeviceTakesMoreDecalsThanALanguage) {
  const NamedStack stack = with_decals(4097);
  Options options = options_of(stack, Language::glsl);
  options.access = TextureAccess::exact;
  EXPECT_EQ(generate(stack.layers, options).decal_count, 4097);
}

TEST(Limits, Names) {
  EXPECT_TRUE(is_name("skin2"));
  for (const char* name : {"", "surfgrad", "gl", "Skin", "2skin", "skin_2", "skin.2", "h\xc3\xa4ut"})
    EXPECT_FALSE(is_name(name)) << name;
  EXPECT_THROW(static_cast<void>(generate({}, {.name = "No"})), std::invalid_argument);
}

} // namespace
} // namespace surfgrad::shadergen::test
