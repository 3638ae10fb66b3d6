// The code as it stands: SURFGRAD_UPDATE_GOLDEN=1 writes it anew, for a reader to look at the difference.

#include "stacks.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace surfgrad::shadergen::test {
namespace {

void expect_golden(const std::string& file, const std::string& text) {
  const std::string path = SURFGRAD_SOURCE_DIR "/tests/unit/shadergen/golden/" + file;
  if (std::getenv("SURFGRAD_UPDATE_GOLDEN") != nullptr) std::ofstream(path, std::ios::binary) << text;
  std::ifstream stream(path, std::ios::binary);
  const std::string golden{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  EXPECT_EQ(text, golden) << file << ": is this meant? Then run with SURFGRAD_UPDATE_GOLDEN=1";
}

std::string source(const NamedStack& stack, Language language) {
  return generate(stack.layers, options_of(stack, language)).source;
}

TEST(Golden, OneNormalMapInEveryLanguage) {
  expect_golden("bricks.glsl", source(one_normal_map(), Language::glsl));
  expect_golden("bricks.hlsl", source(one_normal_map(), Language::hlsl));
  expect_golden("bricks.wgsl", source(one_normal_map(), Language::wgsl));
  expect_golden("bricks.gdshaderinc", source(one_normal_map(), Language::godot));
}

TEST(Golden, TwoPasses) {
  expect_golden("torus.glsl", source(two_passes(), Language::glsl));
  expect_golden("torus.wgsl", source(two_passes(), Language::wgsl));
}

TEST(Golden, Roughness) {
  Options options = options_of(two_passes(), Language::hlsl);
  options.roughness = true;
  expect_golden("torus_roughness.hlsl", generate(two_passes().layers, options).source);
}

TEST(Golden, Bindings) {
  expect_golden("torus.hlsl.json",
                manifest(generate(two_passes().layers, options_of(two_passes(), Language::hlsl))));
}

TEST(Golden, ReliefAndDecals) {
  for (const NamedStack& stack : every_kind())
    if (stack.name == "decals" || stack.name == "relief")
      expect_golden(stack.name + ".hlsl", source(stack, Language::hlsl));
}

TEST(Golden, TheSameTwice) {
  for (const NamedStack& stack : every_kind())
    for (const Language language : every_language)
      EXPECT_EQ(source(stack, language), source(stack, language)) << stack.name;
}

} // namespace
} // namespace surfgrad::shadergen::test
