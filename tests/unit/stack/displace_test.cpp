// The keys that change the mesh: displace and morph.

#include "diagnostic/error.hpp"
#include "stack_text.hpp"

#include <gtest/gtest.h>

namespace surfgrad::stack {
namespace {

/// The keys stand on line 3.
Stack parsed(const std::string& keys) {
  return parse_stack("{ \"surfgrad\": 1,\n\"displace\":\n{ " + keys + " } }", "stack.json");
}

TEST(StackDisplace, SmallestBlocksHaveTheDefaults) {
  const Displace function = *parsed(R"("function": "simplex", "height": 2)").displace;
  EXPECT_EQ(function.noise.function, NoiseKind::simplex);
  EXPECT_EQ(function.noise.frequency, 1);
  EXPECT_FALSE(function.map);
  EXPECT_EQ(function.height, 2);
  EXPECT_EQ(function.level, 0);
  EXPECT_EQ(function.subdivide, 0);
  EXPECT_EQ(function.edges, Edges::straight);
  EXPECT_EQ(function.line, 3);
  EXPECT_EQ(function.subdivide_line, 3);
  const Displace map = *parsed(R"("map": { "map": "h.png" }, "height": -1)").displace;
  EXPECT_EQ(map.map->file.path, "h.png");
  EXPECT_EQ(map.map->file.key, "displace.map.map");
  EXPECT_EQ(map.map->channel, MaskChannel::r);
  EXPECT_FALSE(parse_stack("{ \"surfgrad\": 1 }", "stack.json").displace);
}

TEST(StackDisplace, EveryKeyArrives) {
  EXPECT_NE(test::text_of(parsed(R"("function": "ridged", "basis": "worley", "worley": "f2_minus_f1",
    "octaves": 2, "lacunarity": 3, "gain": 0.25, "power": 2, "frequency": 8, "offset": [1, 2, 3],
    "height": -0.5, "level": 0.75, "subdivide": 6, "edges": "curved")"))
                .find(R"(noise 5 2 1 octaves 2 3 0.25 power 2 frequency 8 offset 1 2 3
displace height -0.5 level 0.75 subdivide 6 edges 1
)"),
            std::string::npos);
  EXPECT_NE(test::text_of(parsed(R"("height": 1, "map": { "map": "h.exr", "uv": 1, "tile": [2, -3],
    "rotate": 30, "offset": [0.5, 0], "wrap": "mirror", "channel": "a" })"))
                .find("h.exr uv 1 tile 2 -3 rotate 30 offset 0.5 0 wrap 1 filter 2\nchannel 3\n"),
            std::string::npos);
}

TEST(StackMorph, WeightsArriveInOrder) {
  const Stack stack = parse_stack("{ \"surfgrad\": 1,\n\"morph\": [0.5, -2] }", "stack.json");
  EXPECT_EQ(stack.morph.weights, (std::vector<double>{0.5, -2}));
  EXPECT_EQ(stack.morph.line, 2);
}

struct Wrong {
  std::string text;
  std::string message;
};

void expect_messages(std::initializer_list<Wrong> cases, std::string (*document)(const std::string&)) {
  for (const Wrong& wrong : cases) try {
      (void)parse_stack(document(wrong.text), "s.json");
      ADD_FAILURE() << "accepted: " << wrong.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), wrong.message);
    }
}

TEST(StackDisplace, BadValuesSayWhatWouldBeRight) {
  expect_messages(
      {{R"("height": 1)",
        R"(s.json:2: displace: lacks "function" or "map"; expected "function": "perlin" or another one, or "map": { "map": a height map })"},
       {R"("height": 1, "function": "perlin", "map": { "map": "h.png" })",
        R"(s.json:2: displace: has a "function" and a "map"; keep one: a mesh is displaced once)"},
       {R"("function": "perlin")", R"(s.json:2: displace: lacks "height"; expected "height": a number)"},
       {R"("height": 1, "map": { "map": "h.png" }, "octaves": 2)",
        R"(s.json:2: displace.octaves: does not apply to a map; leave it out, or give a "function")"},
       {R"("height": 1, "function": "perlin", "frequency": 0)",
        "s.json:2: displace.frequency: is 0; expected a number greater than 0"},
       {R"("height": 1, "function": "perlin", "subdivide": 7)",
        "s.json:2: displace.subdivide: is 7; expected a whole number from 0 to 6"},
       {R"("height": 1, "function": "perlin", "edges": "smooth")",
        R"(s.json:2: displace.edges: is "smooth"; expected one of: straight, curved)"},
       {R"("height": 1, "map": "h.png")", "s.json:2: displace.map: is a string; expected an object"},
       {R"("height": 1, "map": { "map": "h.png", "filter": "nearest" })",
        R"(s.json:2: displace.map: unknown key "filter"; expected one of: map, uv, tile, rotate, offset, wrap, channel)"}},
      [](const std::string& keys) { return "{ \"surfgrad\": 1,\n\"displace\": { " + keys + " } }"; });
}

TEST(StackMorph, BadValuesSayWhatWouldBeRight) {
  expect_messages({{"1", "s.json:2: morph: is 1; expected an array of numbers"},
                   {"[0, \"x\"]", "s.json:2: morph[1]: is a string; expected a number"}},
                  [](const std::string& value) { return "{ \"surfgrad\": 1,\n\"morph\": " + value + " }"; });
}

} // namespace
} // namespace surfgrad::stack
