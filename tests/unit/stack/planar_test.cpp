#include "diagnostic/error.hpp"
#include "stack/uses.hpp"
#include "stack_text.hpp"

#include <gtest/gtest.h>

namespace surfgrad::stack {
namespace {

using test::text_of;

Stack parse(const std::string& layer) {
  return parse_stack(R"({"surfgrad": 1, "layers": [)" + layer + "]}", "stack.json");
}

std::string text_of_layer(const std::string& layer) {
  test::StackText out;
  out.layers(parse(layer).layers);
  return out.text;
}

/// `key: problem; remedy` of a layer that is not accepted.
std::string fault_of(const std::string& layer) {
  try {
    static_cast<void>(parse(layer));
  } catch (const InputError& error) {
    return error.fault().place + ": " + error.fault().problem + "; " + error.fault().remedy;
  }
  return "accepted";
}

TEST(StackPlanar, has_defaults) {
  EXPECT_EQ(text_of_layer(R"({"type": "planar", "map": "a.png", "axis": "y"})"),
            "planar a.png axis 1 space 0 content 0\n"
            "scale 1 opacity 1 blend 0\n"
            "tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2\n"
            "channels 0 green 0 range 1 neutral 0 height_channel 0 height 1\n");
}

TEST(StackPlanar, takes_every_key) {
  EXPECT_EQ(text_of_layer(R"({"type": "planar", "map": "a.png", "axis": "z", "space": "world",
      "content": "derivative", "range": 4, "neutral": "whole", "green": "down", "tile": [2, -3],
      "rotate": 5, "offset": [6, 7], "wrap": "clamp", "filter": "nearest",
      "scale": 8, "opacity": 0.5, "blend": "mix"})"),
            "planar a.png axis 2 space 1 content 1\n"
            "scale 8 opacity 0.5 blend 1\n"
            "tile 2 -3 rotate 5 offset 6 7 wrap 2 filter 0\n"
            "channels 0 green 1 range 4 neutral 1 height_channel 0 height 1\n");
  EXPECT_EQ(text_of_layer(R"({"type": "planar", "map": "a.png", "axis": "x",
      "content": "height", "channel": "a", "height": -0.25})"),
            "planar a.png axis 0 space 0 content 2\n"
            "scale 1 opacity 1 blend 0\n"
            "tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2\n"
            "channels 0 green 0 range 1 neutral 0 height_channel 3 height -0.25\n");
}

TEST(StackPlanar, names_what_is_wrong) {
  const std::string start = R"({"type": "planar", "map": "a.png", )";
  EXPECT_EQ(fault_of(R"({"type": "planar", "map": "a.png"})"),
            "layers[0]: lacks \"axis\"; expected \"axis\": one of: x, y, z");
  EXPECT_EQ(fault_of(start + R"("axis": "up"})"), "layers[0].axis: is \"up\"; expected one of: x, y, z");
  EXPECT_EQ(fault_of(start + R"("axis": "x", "range": 2})"),
            "layers[0].range: does not apply to this content; leave it out, or give \"content\": "
            "\"derivative\"");
  EXPECT_EQ(fault_of(start + R"("axis": "x", "content": "object_normal"})"),
            "layers[0].content: is \"object_normal\"; expected one of: normal, derivative, height");
  EXPECT_EQ(fault_of(start + R"("axis": "x", "content": "derivative", "range": 0})"),
            "layers[0].range: is 0; expected a number greater than 0");
  EXPECT_EQ(
      fault_of(start + R"("axis": "x", "uv": 1})"),
      "layers[0]: unknown key \"uv\"; expected one of: type, map, axis, space, content, tile, rotate, "
      "offset, "
      "wrap, filter, anisotropy, tiling, hex_turn, channels, green, range, neutral, channel, height, scale, "
      "mask, opacity, blend");
}

TEST(StackPlanar, reads_one_file_and_no_texture_coordinate_but_its_masks) {
  Layer layer = parse(R"({"type": "planar", "map": "a.png", "axis": "x", "mask": {"map": "k.png", "uv": 2}})")
                    .layers[0];
  const std::vector<FileName*> files = files_of(layer);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0]->path, "a.png");
  EXPECT_EQ(files[0]->key, "layers[0].map");
  EXPECT_EQ(files[1]->path, "k.png");
  const std::vector<TextureUse> textures = textures_of(layer);
  ASSERT_EQ(textures.size(), 1u);
  EXPECT_EQ(textures[0].texture->uv, 2);
}

} // namespace
} // namespace surfgrad::stack
