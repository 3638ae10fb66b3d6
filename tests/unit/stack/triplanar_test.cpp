#include "diagnostic/error.hpp"
#include "stack/uses.hpp"
#include "stack_text.hpp"

#include <gtest/gtest.h>

namespace surfgrad::stack {
namespace {

Stack parse(const std::string& keys) {
  return parse_stack(R"({"surfgrad": 1, "layers": [{"type": "triplanar", )" + keys + "}]}", "stack.json");
}

std::string text_of_layer(const std::string& keys) {
  test::StackText out;
  out.layers(parse(keys).layers);
  return out.text;
}

/// `key: problem; remedy` of a layer that is not accepted.
std::string fault_of(const std::string& keys) {
  try {
    static_cast<void>(parse(keys));
  } catch (const InputError& error) {
    return error.fault().place + ": " + error.fault().problem + "; " + error.fault().remedy;
  }
  return "accepted";
}

TEST(StackTriplanar, has_defaults) {
  EXPECT_EQ(text_of_layer(R"("map": "a.png")"),
            "triplanar sharpness 3 space 0 content 0\n"
            "map a.png\n"
            "convention 1 0 0\n" // right-handed
            "scale 1 opacity 1 blend 0\n"
            "tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2\n"
            "channels 0 green 0 range 1 neutral 0 height_channel 0 height 1\n");
}

TEST(StackTriplanar, takes_every_key) {
  EXPECT_EQ(text_of_layer(R"("map": ["a.png", "b.png", "c.png"], "sharpness": 0.5, "space": "world",
      "convention": {"handedness": "left", "origin": "upper_left", "planes": "golubev"},
      "content": "object_normal", "green": "down", "tile": [2, -3], "rotate": 5, "offset": [6, 7],
      "wrap": "clamp", "filter": "nearest", "scale": 8, "opacity": 0.5, "blend": "mix")"),
            "triplanar sharpness 0.5 space 1 content 3\n"
            "map a.png\nmap b.png\nmap c.png\n"
            "convention 0 1 1\n"
            "scale 8 opacity 0.5 blend 1\n"
            "tile 2 -3 rotate 5 offset 6 7 wrap 2 filter 0\n"
            "channels 0 green 1 range 1 neutral 0 height_channel 0 height 1\n");
}

TEST(StackTriplanar, names_what_is_wrong) {
  const std::string files = "; expected a file name or an array of 3 file names";
  EXPECT_EQ(fault_of(R"("map": 3)"), "layers[0].map: is 3" + files);
  EXPECT_EQ(fault_of(R"("map": [])"), "layers[0].map: is an array of 0" + files);
  EXPECT_EQ(fault_of(R"("map": ["a.png", "b.png"])"), "layers[0].map: is an array of 2" + files);
  EXPECT_EQ(fault_of(R"("map": ["a.png", 1, "b.png"])"), "layers[0].map[1]: is 1; expected a file name");
  EXPECT_EQ(fault_of(R"("map": ["a.png", "b.png", ""])"), "layers[0].map[2]: is empty; expected a file name");
  EXPECT_EQ(fault_of(R"("sharpness": 3)"), "layers[0]: lacks \"map\"; expected \"map\": " + files.substr(11));
  EXPECT_EQ(fault_of(R"("map": "a.png", "sharpness": 0)"),
            "layers[0].sharpness: is 0; expected a number greater than 0");
  EXPECT_EQ(fault_of(R"("map": "a.png", "convention": {"handed": "left"})"),
            "layers[0].convention: unknown key \"handed\"; expected one of: handedness, origin, planes");
  EXPECT_EQ(fault_of(R"("map": "a.png", "convention": {"planes": "golubyev"})"),
            "layers[0].convention.planes: is \"golubyev\"; did you mean \"golubev\"? expected one of: "
            "mikkelsen, golubev");
  EXPECT_EQ(fault_of(R"("map": "a.png", "content": "height", "green": "down")"),
            "layers[0].green: does not apply to this content; leave it out, or give \"content\": \"normal\" "
            "or \"derivative\" or \"object_normal\"");
  EXPECT_EQ(fault_of(R"("map": "a.png", "content": "object_normal", "channels": "xy")"),
            "layers[0].channels: does not apply to this content; leave it out, or give \"content\": "
            "\"normal\"");
}

TEST(StackTriplanar, reads_every_file_and_no_texture_coordinate) {
  Layer layer = parse(R"("map": ["a.png", "b.png", "c.png"])").layers[0];
  const std::vector<FileName*> files = files_of(layer);
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[1]->path, "b.png");
  EXPECT_EQ(files[2]->key, "layers[0].map[2]");
  EXPECT_TRUE(textures_of(layer).empty());
}

} // namespace
} // namespace surfgrad::stack
