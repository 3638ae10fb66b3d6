// Nothing stands in the code that the stack does not need, and nothing is computed twice.

#include "stacks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace surfgrad::shadergen::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Words of code, comments left out.
std::map<std::string, int> words_of(const std::string& code) {
  const std::string bare = std::regex_replace(code, std::regex("//[^\n]*"), "");
  std::map<std::string, int> counts;
  const std::regex word("[A-Za-z_][A-Za-z0-9_]*");
  for (std::sregex_iterator i(bare.begin(), bare.end(), word), end; i != end; ++i) ++counts[i->str()];
  return counts;
}

/// Names that a text declares at its outermost level.
std::set<std::string> declared(const std::string& code) {
  std::set<std::string> names;
  const std::regex function(
      "(?:^|\n)(?:fn )?(?:[A-Za-z][A-Za-z0-9_]* )?([A-Za-z_][A-Za-z0-9_]*)\\([^;{]*\\{");
  const std::regex other("(?:^|\n)(?:struct|const (?:float|int)|static const (?:float|int)|const) "
                         "([A-Za-z_][A-Za-z0-9_]*)");
  for (const std::regex& pattern : {function, other})
    for (std::sregex_iterator i(code.begin(), code.end(), pattern), end; i != end; ++i) names.insert((*i)[1]);
  return names;
}

std::string standalone(const NamedStack& stack, Language language) {
  Options options = options_of(stack, language);
  options.standalone = true;
  return generate(stack.layers, options).source;
}

TEST(Minimality, EveryDeclarationIsUsed) {
  int seen = 0;
  for (const NamedStack& stack : every_kind())
    for (const Language language : every_language) {
      const std::string code = standalone(stack, language);
      const auto counts = words_of(code);
      // What the program calls.
      const std::set<std::string> given{stack.name + "_normal", stack.name + "_displaced",
                                        stack.name + "_with_derivatives"};
      for (const std::string& name : declared(code)) {
        ++seen;
        EXPECT_GE(counts.at(name), given.contains(name) ? 1 : 2)
            << stack.name << ": " << name << " is not used";
      }
    }
  EXPECT_GT(seen, 500);
}

TEST(Minimality, EveryLocalIsUsed) {
  int seen = 0;
  const std::regex function("\n[A-Za-z0-9_]+ ([a-z0-9A-Z_]+)\\([^;]*?\\) \\{\n([^]*?)\n\\}\n");
  const std::regex local("\n? +[A-Za-z0-9]+ ([a-zA-Z0-9_]+) =");
  for (const NamedStack& stack : every_kind())
    for (const bool roughness : {false, true}) {
      Options options = options_of(stack, Language::glsl);
      options.roughness = roughness;
      const std::string code = generate(stack.layers, options).source;
      for (std::sregex_iterator f(code.begin(), code.end(), function), end; f != end; ++f) {
        const std::string body = (*f)[2];
        const auto counts = words_of(body);
        for (std::sregex_iterator i(body.begin(), body.end(), local); i != end; ++i, ++seen)
          EXPECT_GE(counts.at((*i)[1]), 2)
              << stack.name << ", " << (*f)[1] << ": " << (*i)[1] << " is not used";
      }
    }
  EXPECT_GT(seen, 300);
}

TEST(Minimality, DecalsCarryWhatTheirBlendsNeed) {
  const auto words = [](const char* instances) {
    const NamedStack stack =
        parsed("d", std::string(R"({ "surfgrad": 1, "layers": [ { "type": "decal", "map": "a.png",
      "instances": )") + instances +
                        " } ] }");
    const std::string code = generate(stack.layers, options_of(stack, Language::glsl)).source;
    const std::size_t begin = code.find("vec3 d_layer0_decals(");
    return words_of(code.substr(begin, code.find("\n}\n", begin) - begin));
  };
  const auto carried = [&](const char* instances) {
    std::string list;
    const auto counts = words(instances);
    for (const char* name : {"factor", "keep", "result", "waiting"})
      list += counts.contains(name) ? std::string(name) + " " : "";
    return list;
  };
  EXPECT_EQ(carried(R"([ { "blend": "add" } ])"), "waiting ");
  EXPECT_EQ(carried(R"([ { "blend": "mix" } ])"), "factor keep waiting ");
  EXPECT_EQ(carried(R"([ { "blend": "replace" } ])"), "result ");
  EXPECT_EQ(carried(R"([ { "blend": "replace" }, { "blend": "add" } ])"), "result waiting ");
  EXPECT_EQ(carried(R"([ { "blend": "replace" }, { "blend": "mix" } ])"), "factor keep result waiting ");
}

TEST(Minimality, ARayThatIsStoppedGoesNoFurther) {
  for (const NamedStack& stack : every_kind()) {
    if (stack.name != "relief") continue;
    for (const Language language : every_language)
      EXPECT_THAT(generate(stack.layers, options_of(stack, language)).source,
                  HasSubstr("sun = 0.0;\n      break;"));
  }
}

TEST(Minimality, OneNormalMapTakesOneTextureAndHardlyAnyCode) {
  for (const Language language : every_language) {
    const std::string code = standalone(one_normal_map(), language);
    for (const char* other : {"noise", "Noise", "perlin", "decal", "Decal", "hex", "parallax", "triplanar",
                              "Frame", "dp_dx", "object_", "world_from"})
      EXPECT_THAT(code, Not(HasSubstr(other)));
    // Decoding and the resolve with their helpers and comments, guards aside: 106. The smallest noise is as
    // long again.
    const std::string bare = std::regex_replace(code, std::regex("#[^\n]*\n"), "");
    EXPECT_LT(std::count(bare.begin(), bare.end(), '\n'), 120);
  }
  const Shader shader = generate(one_normal_map().layers, options_of(one_normal_map(), Language::glsl));
  EXPECT_EQ(shader.textures.size(), 1u);
  EXPECT_EQ(shader.parameters.size(), 2u);                // scale and opacity
  EXPECT_THAT(shader.source, Not(HasSubstr("(vec2 v)"))); // of two overloads the one that is called
}

TEST(Minimality, RoughnessIsThereOnlyWhereAsked) {
  for (const NamedStack& stack : every_kind())
    for (const Language language : every_language) {
      Options options = options_of(stack, language);
      for (const char* word : {"roughness", "variance", "minified"})
        EXPECT_THAT(generate(stack.layers, options).source, Not(HasSubstr(word))) << stack.name;
      options.roughness = true;
      EXPECT_THAT(generate(stack.layers, options).source, HasSubstr("result.roughness = ")) << stack.name;
    }
}

TEST(Minimality, NothingIsComputedTwice) {
  for (const NamedStack& stack : every_kind()) {
    const std::string code = generate(stack.layers, options_of(stack, Language::glsl)).source;
    const std::size_t begin = code.find("Result " + stack.name + "_normal(");
    ASSERT_NE(begin, std::string::npos);
    const std::string body = code.substr(begin, code.find("\n}\n", begin) - begin);
    std::map<std::string, std::string> names; // expression -> the value that has it
    const std::regex value("\n  [A-Za-z0-9]+ ([a-z0-9_]+) = ([^;]*);");
    for (std::sregex_iterator i(body.begin(), body.end(), value), end; i != end; ++i) {
      const auto [place, is_new] = names.emplace((*i)[2], (*i)[1]);
      EXPECT_TRUE(is_new) << stack.name << ": " << (*i)[1] << " and " << place->second << " are both "
                          << (*i)[2];
    }
  }
}

TEST(Minimality, SlopesInOneFrameAreSummedBeforeTheyBecomeVectors) {
  const NamedStack stack = parsed("three", R"({ "surfgrad": 1, "layers": [
    { "type": "normal_map", "map": "a.png", "basis": "derived" },
    { "type": "normal_map", "map": "b.png", "basis": "derived", "scale": 0.5 },
    { "type": "derivative_map", "map": "c.png", "basis": "derived" } ] })");
  const auto counts = words_of(generate(stack.layers, options_of(stack, Language::glsl)).source);
  EXPECT_EQ(counts.at("surfgrad_from_tbn"), 1);
  EXPECT_EQ(counts.at("surfgrad_tangent_basis"), 1);
  EXPECT_EQ(counts.at("surfgrad_resolve_normal"), 1);
}

TEST(Minimality, OneFileReadAlikeIsOneTexture) {
  const NamedStack stack = parsed("same", R"({ "surfgrad": 1, "layers": [
    { "type": "normal_map", "map": "a.png", "mask": { "map": "m.png" } },
    { "type": "normal_map", "map": "a.png", "tile": 4, "mask": { "map": "m.png" } },
    { "type": "normal_map", "map": "a.png", "wrap": "clamp" } ] })");
  const Shader shader = generate(stack.layers, options_of(stack, Language::glsl));
  EXPECT_EQ(shader.textures.size(), 3u);                              // the map in two ways, and the mask
  EXPECT_EQ(words_of(shader.source).at("same_layer0_mask_value"), 2); // defined, and called once for both
}

TEST(Minimality, ExactAccessReadsTexturesOnlyWhereItIsAsked) {
  Options options;
  options.access = TextureAccess::exact;
  options.diagnostics = true;
  std::size_t sampled = 0;
  for (const NamedStack& stack : every_kind()) {
    options.samples = {};
    const std::string exact = generate(stack.layers, options).source;
    for (const char* word : {"sampler2D", "textureLod", "texelFetch", "stack_unit(", "stack_in_period("})
      EXPECT_EQ(exact.find(word), std::string::npos) << word << " in " << stack.name;
    options.samples = [](const MapSite&, const TextureBinding&) { return false; };
    EXPECT_EQ(generate(stack.layers, options).source, exact) << stack.name;
    options.samples = [](const MapSite&, const TextureBinding&) { return true; };
    for (const TextureBinding& t : generate(stack.layers, options).textures) {
      if (!t.sampled) continue;
      ++sampled;
      EXPECT_EQ(t.anisotropy, 1) << t.name;
      EXPECT_TRUE(t.kind != MapKind::normals && t.kind != MapKind::heights && t.kind != MapKind::relief &&
                  t.kind != MapKind::cube)
          << t.name;
    }
  }
  EXPECT_GT(sampled, 10u);
}

} // namespace
} // namespace surfgrad::shadergen::test
