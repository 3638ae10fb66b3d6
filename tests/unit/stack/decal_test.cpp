// Decals as documents place them, and what they may not say.

#include "diagnostic/error.hpp"
#include "stack/uses.hpp"
#include "stack_text.hpp"

#include <gtest/gtest.h>

namespace surfgrad::stack {
namespace {

std::string document(const std::string& keys) {
  return "{ \"surfgrad\": 1, \"layers\": [ { \"type\": \"decal\", \"map\": \"d.png\",\n" + keys + " } ] }";
}
DecalLayer parse(const std::string& keys) {
  const Stack stack = parse_stack(document(keys), "stack.json");
  return std::get<DecalLayer>(stack.layers.at(0));
}

TEST(DecalDocument, the_smallest_is_one_upright_box) {
  const DecalLayer layer = parse("\"scale\": 2");
  EXPECT_EQ(layer.shape, DecalShape::box);
  EXPECT_EQ(layer.files.size(), 1u);
  EXPECT_EQ(layer.map.content, Content::normal);
  EXPECT_EQ(layer.map.wrap, Wrap::clamp);
  EXPECT_EQ(layer.space, Space::world);
  EXPECT_EQ(layer.falloff, 0.1);
  EXPECT_EQ(layer.gradient, ConeGradient::exact);
  EXPECT_EQ(layer.common.scale, 2);
  EXPECT_EQ(layer.blend, DecalBlend::add);
  ASSERT_EQ(layer.instances.size(), 1u);
  const DecalInstance& decal = layer.instances[0];
  EXPECT_EQ(decal.direction.y, -1);
  EXPECT_EQ(decal.size.z, 1);
  EXPECT_FALSE(decal.transform);
  EXPECT_FALSE(decal.scale) << "the layer's";
}

TEST(DecalDocument, every_key_arrives) {
  const Stack stack = parse_stack(R"({ "surfgrad": 1, "layers": [
    { "type": "decal", "shape": "wedge", "map": "w.png", "content": "height", "channel": "g",
      "height": 0.5, "tile": 2, "rotate": 10, "offset": [3, 4], "wrap": "repeat", "filter": "nearest",
      "space": "object", "falloff": 0.25, "gradient": "scale_free", "position": [1, 2, 3],
      "direction": [4, 5, 6], "roll": 7, "angle": 90, "depth": 8, "length": 0, "scale": -2,
      "opacity": 0.5, "blend": "mix", "mask": { "map": "k.png" } },
    { "type": "decal", "shape": "capsule", "map": ["a", "b", "c", "d", "e", "f"], "radius": 2,
      "transform": [2,0,0,0, 0,2,0,0, 0,0,2,0, 5,6,7,1], "length": 3,
      "instances": [ { "blend": "replace", "scale": 3, "opacity": 0 },
                     { "transform": [0,1,0,0, -1,0,0,0, 0,0,1,0, 1,1,1,1], "radius": 4 } ] } ] })",
                                  "stack.json");
  EXPECT_EQ(test::text_of(stack), R"(layers true
decal shape 4 space 0 falloff 0.25 gradient 1
w.png
tile 2 2 rotate 10 offset 3 4 wrap 0 filter 0 content 2 channels 0 green 0
range 1 neutral 0 channel 1 height 0.5
scale -2 opacity 0.5 blend 1
k.png uv 0 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2
channel 0
at 1 2 3 direction 4 5 6 roll 7
size 1 1 1 angle 90 depth 8 radius 0.5 length 0
scale -99 opacity -99 blend -99
decal shape 3 space 1 falloff 0.1 gradient 0
a
b
c
d
e
f
tile 1 1 rotate 0 offset 0 0 wrap 2 filter 2 content 0 channels 0 green 0
range 1 neutral 0 channel 0 height 1
scale 1 opacity 1 blend 0
at 0 0 0 direction 0 -1 0 roll 0
transform 2 0 0 0 0 2 0 0 0 0 2 0 5 6 7 1
size 1 1 1 angle 60 depth 1 radius 2 length 3
scale 3 opacity 0 blend 2
at 0 0 0 direction 0 -1 0 roll 0
transform 0 1 0 0 -1 0 0 0 0 0 1 0 1 1 1 1
size 1 1 1 angle 60 depth 1 radius 4 length 3
scale -99 opacity -99 blend -99
yaw 30 pitch 15 zoom 1 fov 35
sun 0.4 0.6 0.7
strength 3 sky 1
)");
}

TEST(DecalDocument, an_instance_takes_from_the_layer_what_it_leaves_out) {
  // Wherever in the layer the instances stand.
  const DecalLayer layer =
      parse("\"instances\": [ {\"roll\": 5}, {\"size\": [1, 2, 3]} ], \"size\": 4, \"position\": [7, 8, 9]");
  ASSERT_EQ(layer.instances.size(), 2u);
  EXPECT_EQ(layer.instances[0].roll_deg, 5);
  EXPECT_EQ(layer.instances[0].size.y, 4);
  EXPECT_EQ(layer.instances[1].roll_deg, 0);
  EXPECT_EQ(layer.instances[1].size.y, 2);
  EXPECT_EQ(layer.instances[1].position.z, 9);
  EXPECT_TRUE(parse("\"instances\": []").instances.empty());
}

TEST(DecalDocument, names_its_files_but_no_texture_coordinate_of_its_own) {
  Layer layer = parse("\"shape\": \"box\", \"mask\": { \"map\": \"k.png\", \"uv\": 3 }");
  const std::vector<FileName*> files = files_of(layer);
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0]->path, "d.png");
  EXPECT_EQ(files[0]->key, "layers[0].map");
  const std::vector<TextureUse> textures = textures_of(layer);
  ASSERT_EQ(textures.size(), 1u);
  EXPECT_EQ(textures[0].texture->uv, 3);
}

struct Mistake {
  const char* name;
  std::string keys;
  const char* message; ///< after the file
};
void PrintTo(const Mistake& m, std::ostream* out) { *out << m.name; }

class DecalMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(DecalMistakes, name_the_line_the_key_and_the_remedy) {
  try {
    static_cast<void>(parse(GetParam().keys));
    FAIL() << "parsed: " << GetParam().keys;
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), "stack.json:2: layers[0]" + std::string(GetParam().message));
  }
}

const Mistake mistakes[] = {
    {"unknown_shape", R"("shape": "ball")",
     ".shape: is \"ball\"; expected one of: box, cone, sphere, capsule, wedge"},
    {"zero_size", R"("size": [1, 0, 1])", ".size[1]: is 0; expected a number greater than 0"},
    {"negative_size", R"("size": -1)", ".size: is -1; expected a number greater than 0"},
    {"size_of_two", R"("size": [1, 2])",
     ".size: is an array of 2; expected a number or an array of 3 numbers, all of them greater than 0"},
    {"zero_radius", R"("shape": "sphere", "radius": 0)", ".radius: is 0; expected a number greater than 0"},
    {"straight_angle", R"("shape": "cone", "angle": 180)",
     ".angle: is 180; expected a number greater than 0 and less than 180"},
    {"size_of_a_sphere", R"("shape": "sphere", "size": 1)",
     ".size: does not apply to a sphere; leave it out, or give \"shape\": \"box\""},
    {"angle_of_an_instance", R"("instances": [ {"angle": 10} ])",
     ".instances[0].angle: does not apply to a box; leave it out, or give \"shape\": \"cone\" or \"wedge\""},
    {"tile_of_a_cube_map", R"("shape": "capsule", "tile": 2)",
     ".tile: does not apply to a capsule; leave it out, or give \"shape\": \"box\" or \"cone\" or \"wedge\""},
    {"no_direction", R"("direction": [0, 0, 0])",
     ".direction: is the zero vector; expected the direction in which the decal projects"},
    {"no_direction_of_an_instance", R"("instances": [ {}, {"direction": [0, 0, 0]} ])",
     ".instances[1].direction: is the zero vector; expected the direction in which the decal projects"},
    {"singular_transform", R"("transform": [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1])",
     ".transform: is singular: its columns span no space; expected three columns that are perpendicular and "
     "not zero"},
    {"parallel_columns", R"("transform": [1,0,0,0, 2,0,0,0, 0,0,1,0, 0,0,0,1])",
     ".transform: is singular: its columns span no space; expected three columns that are perpendicular and "
     "not zero"},
    {"singular_transform_of_an_instance",
     R"("instances": [ {"transform": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1]} ])",
     ".instances[0].transform: is singular: its columns span no space; expected three columns that are "
     "perpendicular and not zero"},
    {"shearing_transform", R"("transform": [1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1])",
     ".transform: shears: its columns are not perpendicular; expected a rotation, a translation and a scale"},
    {"projective_transform", R"("transform": [1,0,0,0, 0,1,0,0, 0,0,1,1, 0,0,0,1])",
     ".transform: is not affine: its last row is not 0 0 0 1; expected 16 numbers, column by column, each "
     "fourth of them 0, 0, 0 and 1"},
    {"uneven_scale_of_a_cone", R"("shape": "cone", "transform": [1,0,0,0, 0,2,0,0, 0,0,1,0, 0,0,0,1])",
     ".transform: scales a cone unevenly; expected columns of one length, or \"shape\": \"box\""},
    {"transform_and_position", R"("transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "position": [0, 0, 0])",
     ".position: is given beside a \"transform\"; give one of them"},
    {"roll_beside_the_layers_transform",
     R"("transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "instances": [ {"roll": 3} ])",
     ".instances[0].roll: is given beside the layer's \"transform\"; give the instance a \"transform\" of "
     "its own, "
     "or place the layer without one"},
    {"transform_of_twelve", R"("transform": [1,0,0, 0,1,0, 0,0,1, 0,0,0])",
     ".transform: is an array of 12; expected an array of 16 numbers"},
    {"falloff", R"("falloff": 1.5)", ".falloff: is 1.5; expected a number from 0 to 1"},
    {"blend", R"("blend": "over")", ".blend: is \"over\"; expected one of: add, mix, replace"},
    {"instances_not_a_list", R"("instances": {})", ".instances: is an object; expected an array"},
    {"unknown_key_of_an_instance", R"("instances": [ {"positon": [0, 0, 0]} ])",
     ".instances[0]: unknown key \"positon\"; did you mean \"position\"? expected one of: position, "
     "direction, roll, transform, size, angle, depth, radius, length, scale, opacity, blend"},
    {"height_of_a_normal_map", R"("height": 2)",
     ".height: does not apply to this content; leave it out, or give \"content\": \"height\""},
};

std::string name_of(const testing::TestParamInfo<Mistake>& mistake) { return mistake.param.name; }

INSTANTIATE_TEST_SUITE_P(decal, DecalMistakes, testing::ValuesIn(mistakes), name_of);

TEST(DecalFiles, say_how_many_a_shape_takes) {
  const auto message = [](const std::string& keys) -> std::string {
    try {
      static_cast<void>(
          parse_stack("{ \"surfgrad\": 1, \"layers\": [ { \"type\": \"decal\"" + keys + " } ] }", "s.json"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "parsed";
  };
  EXPECT_EQ(message(""), "s.json:1: layers[0]: lacks \"map\"; expected \"map\": a file name or an array of 6 "
                         "file names");
  EXPECT_EQ(message(R"(, "map": ["a", "b"])"),
            "s.json:1: layers[0].map: is an array of 2; expected a file name or an array of 6 file names");
  EXPECT_EQ(message(R"(, "map": ["a", "b", "c", "d", "e", 6])"),
            "s.json:1: layers[0].map[5]: is 6; expected a file name");
  EXPECT_EQ(message(R"(, "map": ["a", "b", "c", "d", "e", "f"])"),
            "s.json:1: layers[0].map: is an array of 6 files; a box takes one image; the faces of a cube are "
            "for a sphere or capsule");
  EXPECT_EQ(message(R"(, "shape": "sphere", "map": ["a", "b", "c", "d", "e", "f"])"), "parsed");
}

} // namespace
} // namespace surfgrad::stack
