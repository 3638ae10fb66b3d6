// The values that a shader is to be given are those of the stack.

#include "stacks.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>

namespace surfgrad::shadergen::test {
namespace {

float number_at(const std::vector<std::byte>& data, std::size_t offset) {
  float value = 0;
  std::memcpy(&value, data.data() + offset, sizeof value);
  return value;
}

TEST(Values, ParametersLieWhereTheirOffsetsSay) {
  int seen = 0;
  for (const NamedStack& stack : every_kind()) {
    const Shader shader = generate(stack.layers, options_of(stack, Language::hlsl));
    EXPECT_EQ(shader.parameter_data.size() % 16, 0u);
    int end = 0;
    for (const Parameter& p : shader.parameters) {
      const int size = p.type == Parameter::Type::number ? 4 : p.type == Parameter::Type::vec2 ? 8 : 16;
      EXPECT_EQ(p.offset % size, 0) << p.name; // std140's alignment, and no vector crosses 16 bytes
      EXPECT_GE(p.offset, end) << p.name;
      end = p.offset + size;
      for (std::size_t i = 0; i < p.value.size(); ++i, ++seen)
        EXPECT_EQ(number_at(shader.parameter_data, static_cast<std::size_t>(p.offset) + 4 * i),
                  static_cast<float>(p.value[i]));
    }
  }
  EXPECT_GT(seen, 50);
}

TEST(Values, ThoseOfTheLayer) {
  const NamedStack stack = parsed("values", R"({ "surfgrad": 1, "layers": [
    { "type": "normal_map", "map": "a.png", "scale": -1.5, "opacity": 0.25, "tile": [4, -2], "rotate": 90,
      "offset": [0.5, 0.75] } ] })");
  const nlohmann::json json =
      nlohmann::json::parse(manifest(generate(stack.layers, options_of(stack, Language::glsl))));
  const auto value = [&](const std::string& name) {
    for (const auto& p : json["parameters"]["members"])
      if (p["name"] == name) return p["value"];
    return nlohmann::json();
  };
  EXPECT_EQ(value("layer0_scale"), -1.5);
  EXPECT_EQ(value("layer0_opacity"), 0.25);
  EXPECT_EQ(value("layer0_tile"), (nlohmann::json{4, -2}));
  EXPECT_EQ(value("layer0_rotation"), (nlohmann::json{0, 1})); // a whole quarter turn is exact
  EXPECT_EQ(value("layer0_offset"), (nlohmann::json{0.5, 0.75}));
}

TEST(Values, DecalsAreFiveVectorsEach) {
  const NamedStack stack = parsed("decals", R"({ "surfgrad": 1, "layers": [
    { "type": "decal", "map": "a.png", "scale": 2, "position": [1, 2, 3], "direction": [0, 0, -5],
      "size": [2, 4, 6], "blend": "mix", "opacity": 0.5 } ] })");
  const Shader shader = generate(stack.layers, options_of(stack, Language::glsl));
  ASSERT_EQ(shader.decal_data.size(), std::size_t{bytes_a_decal});
  // Position; s, t and outward; half the edges; with half length, scale, opacity, blend and side.
  const float expected[20] = {1, 2, 3, 0.5F, 1, 0, 0, 2, 0, 1, 0, 0.5F, 0, 0, 1, 1, 1, 2, 3, 1};
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(number_at(shader.decal_data, 4 * i), expected[i]) << i;
}

TEST(Values, TheFilesFactsDecideHowTheyAreDecoded) {
  const NamedStack stack = parsed("facts", R"({ "surfgrad": 1, "layers": [
    { "type": "normal_map", "map": "a.png" },
    { "type": "derivative_map", "map": "b.png", "neutral": "whole" } ] })");
  Options options = options_of(stack, Language::glsl);
  const auto has = [&](const char* text) {
    return generate(stack.layers, options).source.find(text) != std::string::npos;
  };
  EXPECT_TRUE(has(".xyz - 1.0"));
  EXPECT_TRUE(has("255.0, 128.0"));
  options.facts_of = [](const stack::FileName&) { return FileFacts{stack::Channels::xy, Codes::unorm16}; };
  EXPECT_FALSE(has(".xyz - 1.0"));
  EXPECT_TRUE(has(".xy - 1.0"));
  EXPECT_TRUE(has("65535.0, 32768.0"));
}

} // namespace
} // namespace surfgrad::shadergen::test
