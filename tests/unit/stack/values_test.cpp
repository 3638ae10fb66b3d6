#include "stack/stack.hpp"
#include "stack/uses.hpp"
#include "stack_text.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <locale>

namespace surfgrad::stack {
namespace {

using test::text_of;

Stack parse(std::string_view text) { return parse_stack(text, "stack.json"); }

NormalMapLayer only_normal_map(const Stack& stack) {
  EXPECT_EQ(stack.layers.size(), 1u);
  return std::get<NormalMapLayer>(stack.layers.at(0));
}

TEST(StackValues, smallest_document_has_the_defaults) {
  const Stack stack = parse(R"({"surfgrad": 1})");
  EXPECT_EQ(stack.file, "stack.json");
  EXPECT_FALSE(stack.mesh);
  EXPECT_FALSE(stack.back_faces);
  EXPECT_FALSE(stack.has_layers);
  EXPECT_TRUE(stack.layers.empty());
  EXPECT_TRUE(stack.materials.empty());
  EXPECT_EQ(stack.camera.yaw_deg, 30);
  EXPECT_EQ(stack.camera.pitch_deg, 15);
  EXPECT_EQ(stack.camera.zoom, 1);
  EXPECT_EQ(stack.camera.fov_deg, 35);
  EXPECT_FALSE(stack.camera.position);
  EXPECT_FALSE(stack.camera.target);
  EXPECT_FALSE(stack.lights.sun);
  EXPECT_EQ(Sun{}.direction.x, 0.4);
  EXPECT_EQ(Sun{}.direction.y, 0.6);
  EXPECT_EQ(Sun{}.direction.z, 0.7);
  EXPECT_EQ(Sun{}.strength, 3);
  EXPECT_EQ(stack.lights.sky, 1);
  EXPECT_FALSE(stack.lights.environment);
}

TEST(StackValues, smallest_normal_map_has_the_defaults) {
  const NormalMapLayer layer =
      only_normal_map(parse(R"({"surfgrad": 1, "layers": [{"type": "normal_map", "map": "n.png"}]})"));
  EXPECT_EQ(layer.map.file.path, "n.png");
  EXPECT_EQ(layer.map.uv, 0);
  EXPECT_EQ(layer.map.tile.x, 1);
  EXPECT_EQ(layer.map.tile.y, 1);
  EXPECT_EQ(layer.map.rotate_deg, 0);
  EXPECT_EQ(layer.map.offset.x, 0);
  EXPECT_EQ(layer.map.offset.y, 0);
  EXPECT_EQ(layer.map.wrap, Wrap::repeat);
  EXPECT_EQ(layer.map.filter, Filter::trilinear);
  EXPECT_EQ(layer.map.tiling, Tiling::plain);
  EXPECT_EQ(layer.map.hex_turn_deg, 180);
  EXPECT_EQ(layer.map.channels, Channels::automatic);
  EXPECT_EQ(layer.map.green, Green::up);
  EXPECT_EQ(layer.basis, Basis::mikktspace);
  EXPECT_EQ(layer.common.scale, 1);
  EXPECT_EQ(layer.common.opacity, 1);
  EXPECT_EQ(layer.common.blend, Blend::add);
  EXPECT_FALSE(layer.common.mask);
}

TEST(StackValues, smallest_maps_of_slopes_and_heights_have_the_defaults) {
  const Stack stack = parse(R"({"surfgrad": 1, "layers": [{"type": "derivative_map", "map": "d"},
      {"type": "height_map", "map": "h"}, {"type": "height_map", "map": "h", "mode": "scale_free"}]})");
  const auto& slopes = std::get<DerivativeMapLayer>(stack.layers[0]);
  EXPECT_EQ(slopes.map.file.path, "d");
  EXPECT_EQ(slopes.code.range, 1);
  EXPECT_EQ(slopes.code.neutral, NeutralCode::between);
  EXPECT_EQ(slopes.basis, Basis::mikktspace);
  const auto& heights = std::get<HeightMapLayer>(stack.layers[1]);
  EXPECT_EQ(heights.map.file.path, "h");
  EXPECT_EQ(heights.channel, MaskChannel::r);
  EXPECT_EQ(heights.mode, HeightMode::physical);
  EXPECT_EQ(heights.height, 1);
  EXPECT_EQ(heights.units, Units::scene);
  EXPECT_EQ(heights.taps, Taps::three);
  EXPECT_FALSE(heights.basis);
  EXPECT_FALSE(std::get<HeightMapLayer>(stack.layers[2]).basis);
}

TEST(StackValues, every_key_of_slopes_and_heights_arrives) {
  EXPECT_EQ(text_of(parse(R"({"surfgrad": 1, "layers": [
      {"type": "derivative_map", "map": "d", "uv": 2, "range": 2.5, "neutral": "whole", "green": "down",
       "basis": "derived", "scale": 3},
      {"type": "height_map", "map": "h", "uv": 3, "channel": "b", "height": -0.25, "units": "object",
       "taps": "one", "opacity": 0.5},
      {"type": "height_map", "map": "h", "mode": "scale_free", "taps": "bicubic", "basis": "mikktspace"}]})")),
            text_of(parse(R"({"surfgrad": 1, "layers": []})"))
                .replace(12, 0, R"(derivative_map basis 1 range 2.5 neutral 1
scale 3 opacity 1 blend 0
d uv 2 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2
green 1
height_map channel 2 mode 0 height -0.25 units 1 taps 0 basis -1
scale 1 opacity 0.5 blend 0
h uv 3 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2
height_map channel 0 mode 1 height 1 units 0 taps 2 basis 0
scale 1 opacity 1 blend 0
h uv 0 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2
)"));
}

TEST(StackValues, only_layers_that_use_the_vertex_frame_ask_for_it) {
  const Stack stack = parse(R"({"surfgrad": 1, "layers": [{"type": "derivative_map", "map": "d"},
      {"type": "derivative_map", "map": "d", "basis": "derived"}, {"type": "height_map", "map": "h"},
      {"type": "height_map", "map": "h", "mode": "scale_free"},
      {"type": "height_map", "map": "h", "mode": "scale_free", "basis": "mikktspace"}]})");
  const bool wanted[] = {true, false, false, false, true};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(textures_of(stack.layers[i])[0].vertex_frame, wanted[i]) << i;
}

TEST(StackValues, the_smallest_parallax_has_the_defaults) {
  const Stack stack = parse(R"({"surfgrad": 1, "layers": [{"type": "parallax", "map": "h"}]})");
  const auto& layer = std::get<ParallaxLayer>(stack.layers[0]);
  EXPECT_EQ(layer.map.file.path, "h");
  EXPECT_EQ(layer.channel, MaskChannel::r);
  EXPECT_EQ(layer.method, ParallaxMethod::occlusion);
  EXPECT_EQ(layer.height, 0.05);
  EXPECT_EQ(layer.level, 0);
  EXPECT_FALSE(layer.limit_offset);
  EXPECT_EQ(layer.lod, ParallaxLod::base);
  EXPECT_EQ(layer.normal, ParallaxNormal::height);
  EXPECT_TRUE(layer.curvature);
  EXPECT_EQ(layer.facing, Facing::keep);
  EXPECT_FALSE(layer.self_shadow);
}

TEST(StackValues, every_key_of_parallax_arrives) {
  EXPECT_EQ(
      text_of(parse(R"({"surfgrad": 1, "layers": [{"type": "parallax", "map": "h", "uv": 1,
      "channel": "g", "method": "offset", "height": 0.5, "level": 0.25, "limit_offset": true,
      "lod": "displaced", "normal": "none", "curvature": false, "facing": "reflect", "self_shadow": true,
      "filter": "bilinear", "scale": -1, "opacity": 0.5, "blend": "mix"}]})")),
      text_of(parse(R"({"surfgrad": 1, "layers": []})"))
          .replace(
              12, 0,
              R"(parallax channel 1 method 0 height 0.5 level 0.25 limit true lod 1 normal 1 curvature false facing 1 shadow true
scale -1 opacity 0.5 blend 1
h uv 1 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 1
)"));
}

TEST(StackValues, parallax_opens_any_pass) {
  const char* list = R"([{"type": "parallax", "map": "h"}, {"type": "normal_map", "map": "n"},
      {"type": "resolve"}, {"type": "parallax", "map": "h"}])";
  const Stack stack =
      parse(fmt::format(R"({{"surfgrad": 1, "layers": {}, "materials": {{"skin": {}}}}})", list, list));
  EXPECT_EQ(stack.layers.size(), 4u);
  EXPECT_EQ(stack.materials.at("skin").layers.size(), 4u);
}

constexpr std::string_view every_key = R"({
  "$schema": "stack.schema.json",
  "surfgrad": 1,
  "mesh": "m.glb",
  "back_faces": "flip",
  "layers": [
    { "type": "normal_map", "map": "a.png", "uv": 3, "tile": [8, -2.5], "rotate": 30, "offset": [0.25, -4],
      "wrap": "mirror", "filter": "nearest", "channels": "xy", "green": "down", "basis": "derived",
      "scale": -1.5, "opacity": 0.5, "blend": "mix",
      "mask": { "map": "k.png", "uv": 7, "tile": 2, "rotate": -90, "offset": [1, 2], "wrap": "clamp",
                "filter": "bilinear", "channel": "a" } },
    { "type": "resolve" },
    { "type": "object_normal_map", "map": "sub/b.exr", "uv": 1, "tile": [1, 2], "rotate": 1e1,
      "offset": [0, 1], "wrap": "clamp", "filter": "bilinear", "green": "down",
      "space": "world", "scale": 2, "opacity": 0, "blend": "mix", "mask": { "map": "q.png", "tiling": "hex", "hex_turn": 12.5, "filter": "anisotropic", "anisotropy": 16 } }, { "type": "normal_map", "map": "a.png", "filter": "normal", "mask": { "map": "k.png", "filter": "anisotropic" } }
  ],
  "materials": { "skin": [ { "type": "resolve" } ], "Cloth.001": [], "\u00e9toile": [] },
  "camera": { "yaw": -200, "pitch": -90, "zoom": 0.5, "fov": 179.5 },
  "lights": { "sun": { "direction": [1, -2, 3], "strength": 0 }, "sky": 0.25, "environment": "e.hdr" }
})";

TEST(StackValues, every_key_arrives) {
  const Stack stack = parse(every_key);
  EXPECT_EQ(text_of(stack), R"(mesh m.glb
back_faces 2
layers true
normal_map basis 1 channels 2
scale -1.5 opacity 0.5 blend 1
k.png uv 7 tile 2 2 rotate -90 offset 1 2 wrap 2 filter 1
channel 3
a.png uv 3 tile 8 -2.5 rotate 30 offset 0.25 -4 wrap 1 filter 0
green 1
resolve
object_normal_map space 1
scale 2 opacity 0 blend 1
q.png uv 0 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 3 anisotropy 16 hex turn 12.5
channel 0
sub/b.exr uv 1 tile 1 2 rotate 10 offset 0 1 wrap 2 filter 1
green 1
normal_map basis 0 channels 0
scale 1 opacity 1 blend 0
k.png uv 0 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 3 anisotropy 8
channel 0
a.png uv 0 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 4
green 0
material Cloth.001
material skin
resolve
material étoile
yaw -200 pitch -90 zoom 0.5 fov 179.5
sun 1 -2 3
strength 0 sky 0.25
environment e.hdr
)");
}

TEST(StackValues, every_named_thing_knows_its_line_and_key) {
  const Stack stack = parse(every_key);
  EXPECT_EQ(stack.mesh->line, 4);
  EXPECT_EQ(stack.mesh->key, "mesh");
  const auto& first = std::get<NormalMapLayer>(stack.layers[0]);
  EXPECT_EQ(first.common.line, 7);
  EXPECT_EQ(first.common.key, "layers[0]");
  EXPECT_EQ(first.map.file.line, 7);
  EXPECT_EQ(first.map.file.key, "layers[0].map");
  EXPECT_EQ(first.map.uv_line, 7);
  EXPECT_EQ(first.common.mask->file.line, 10);
  EXPECT_EQ(first.common.mask->file.key, "layers[0].mask.map");
  const auto& resolve = std::get<ResolveLayer>(stack.layers[1]);
  EXPECT_EQ(resolve.line, 12);
  EXPECT_EQ(resolve.key, "layers[1]");
  const auto& third = std::get<ObjectNormalMapLayer>(stack.layers[2]);
  EXPECT_EQ(third.common.mask->uv_line, 15) << "without a uv key: the mask's line";
  EXPECT_EQ(stack.materials.at("skin").line, 17);
  EXPECT_EQ(stack.materials.at("skin").key, "materials.skin");
  EXPECT_EQ(std::get<ResolveLayer>(stack.materials.at("skin").layers[0]).key, "materials.skin[0]");
  EXPECT_EQ(stack.materials.at("Cloth.001").key, R"(materials["Cloth.001"])");
  EXPECT_EQ(stack.lights.environment->line, 19);
  EXPECT_EQ(stack.lights.environment->key, "lights.environment");
}

TEST(StackValues, crlf_and_byte_order_mark_change_nothing) {
  std::string dos = "\xEF\xBB\xBF";
  for (const char c : every_key) {
    if (c == '\n') dos += '\r';
    dos += c;
  }
  const Stack stack = parse(dos);
  EXPECT_EQ(text_of(stack), text_of(parse(every_key)));
  EXPECT_EQ(stack.lights.environment->line, 19);
}

TEST(StackValues, camera_takes_a_position_and_a_target) {
  const Stack stack =
      parse(R"({"surfgrad": 1, "camera": {"position": [1, 2, 3], "target": [4, 5, 6], "fov": 20}})");
  EXPECT_EQ(stack.camera.position->z, 3);
  EXPECT_EQ(stack.camera.target->x, 4);
  EXPECT_EQ(stack.camera.fov_deg, 20);
}

TEST(StackValues, an_empty_layer_list_differs_from_none) {
  EXPECT_TRUE(parse(R"({"surfgrad": 1, "layers": []})").has_layers);
  EXPECT_FALSE(parse(R"({"surfgrad": 1, "materials": {"a": []}})").has_layers);
}

TEST(StackValues, whole_numbers_may_be_written_in_any_form) {
  EXPECT_EQ(only_normal_map(parse(R"({"surfgrad": 1.0, "layers":
      [{"type": "normal_map", "map": "n", "uv": 20e-1}]})"))
                .map.uv,
            2);
}

TEST(StackValues, numbers_below_the_smallest_double_are_zero) {
  EXPECT_EQ(parse(R"({"surfgrad": 1, "lights": {"sky": 1e-999}})").lights.sky, 0);
  EXPECT_EQ(parse(R"({"surfgrad": 1, "lights": {"sky": 4.9e-324}})").lights.sky, 4.9e-324);
}

/// Decimal comma and grouping in C++ streams.
struct CommaNumbers : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\1"; }
};

TEST(StackValues, numbers_do_not_depend_on_the_locale) {
  const std::locale old = std::locale::global(std::locale(std::locale::classic(), new CommaNumbers));
  const std::string old_c = std::setlocale(LC_NUMERIC, nullptr);
  const char* comma = nullptr;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "nl_NL.UTF-8", "pl_PL.UTF-8"})
    if (comma == nullptr) comma = std::setlocale(LC_NUMERIC, name);
  std::printf("C locale with a decimal comma: %s\n", comma != nullptr ? comma : "none installed");

  const Stack stack = parse(R"({"surfgrad": 1, "camera": {"fov": 1.5, "yaw": 12345.75, "zoom": 25e-1}})");
  std::string message;
  try {
    static_cast<void>(parse(R"({"surfgrad": 1, "camera": {"fov": -1234.5}})"));
  } catch (const std::exception& error) {
    message = error.what();
  }

  std::setlocale(LC_NUMERIC, old_c.c_str());
  std::locale::global(old);
  EXPECT_EQ(stack.camera.fov_deg, 1.5);
  EXPECT_EQ(stack.camera.yaw_deg, 12345.75);
  EXPECT_EQ(stack.camera.zoom, 2.5);
  EXPECT_EQ(message,
            "stack.json:1: camera.fov: is -1234.5; expected a number greater than 0 and less than 180");
}

} // namespace
} // namespace surfgrad::stack
