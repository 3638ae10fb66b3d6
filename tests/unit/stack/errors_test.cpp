#include "diagnostic/error.hpp"
#include "stack/stack.hpp"

#include <gtest/gtest.h>

namespace surfgrad::stack {
namespace {

struct Case {
  const char* name;
  std::string text;
  int line;
  const char* place;
  const char* problem;
  std::string remedy;
};

const std::string kind_words = "normal_map, derivative_map, height_map, object_normal_map, noise, planar, "
                               "triplanar, decal, parallax, resolve";

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class StackErrors : public testing::TestWithParam<Case> {};

TEST_P(StackErrors, name_the_line_the_key_and_the_remedy) {
  const Case& c = GetParam();
  try {
    static_cast<void>(parse_stack(c.text, "dir/stack.json"));
    FAIL() << "parsed: " << c.text;
  } catch (const InputError& error) {
    const Fault& fault = error.fault();
    EXPECT_EQ(fault.file, "dir/stack.json");
    EXPECT_EQ(fault.line, c.line) << error.what();
    EXPECT_EQ(fault.place, c.place) << error.what();
    EXPECT_EQ(fault.problem, c.problem) << error.what();
    EXPECT_EQ(fault.remedy, c.remedy) << error.what();
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
  }
}

std::string in_layer(const std::string& keys) {
  return "{ \"surfgrad\": 1,\n  \"layers\": [\n    { \"type\": \"normal_map\",\n      \"map\": \"n.png\",\n" +
         keys + "\n} ] }";
}
std::string in_mask(const std::string& keys) {
  return in_layer("\"mask\": { \"map\": \"k.png\",\n" + keys + "}");
}
std::string in_document(const std::string& keys) { return "{ \"surfgrad\": 1,\n" + keys + "\n}"; }

std::string in_heights(const std::string& keys) {
  return in_document("\"layers\": [ {\"type\": \"height_map\", \"map\": \"h\",\n" + keys + "} ]");
}

std::string in_parallax(const std::string& keys) {
  return in_document("\"layers\": [ {\"type\": \"parallax\", \"map\": \"h\",\n" + keys + "} ]");
}

constexpr const char* layer_keys = "expected one of: type, map, uv, tile, rotate, offset, wrap, filter, "
                                   "anisotropy, tiling, hex_turn, green, "
                                   "channels, basis, scale, mask, opacity, blend";

const Case not_json[] = {
    {"empty_file", "", 1, "", "is not valid JSON: unexpected end of input",
     "expected '[', '{', or a literal"},
    {"end_inside_object", "{ \"surfgrad\": 1,\n \"camera\": {\n", 2, "camera",
     "is not valid JSON: unexpected end of input", "expected string literal"},
    {"missing_comma", "{ \"surfgrad\": 1\n  \"mesh\": \"a\" }", 2, "",
     "is not valid JSON: unexpected string literal", "expected ',' or '}'"},
    {"missing_comma_in_array", "{ \"surfgrad\": 1,\n\"layers\": [ {\n}\n{} ] }", 4, "layers[1]",
     "is not valid JSON: unexpected '{'", "expected ',' or ']'"},
    {"trailing_comma", "{ \"surfgrad\": 1,\n}", 2, "", "is not valid JSON: unexpected '}'",
     "expected string literal"},
    {"missing_colon", "{ \"surfgrad\"\n 1 }", 2, "surfgrad", "is not valid JSON: unexpected number literal",
     "expected ':'"},
    {"text_after_the_end", "{ \"surfgrad\": 1 }\n{}", 2, "", "is not valid JSON: unexpected '{'",
     "expected end of input"},
    {"line_comment", "{ \"surfgrad\": 1, // one\n \"mesh\": \"a\" }", 1, "",
     "is not valid JSON: invalid literal: \"/\"", "JSON has no comments: remove it"},
    {"block_comment", "{ \"surfgrad\": 1,\n\"camera\": { \"yaw\": /* 3 */ 4 } }", 2, "camera.yaw",
     "is not valid JSON: invalid literal: \"/\"", "JSON has no comments: remove it"},
    {"nan", in_layer("\"scale\": NaN"), 5, "layers[0].scale", "is not valid JSON: invalid literal: \"NaN\"",
     "expected a value: a string in double quotes, a number, true, false, {...} or [...]"},
    {"broken_literal", "{ \"surfgrad\": 1, \"mesh\": tru\n}", 1, "mesh",
     "is not valid JSON: invalid literal: \"tru\"",
     "expected a value: a string in double quotes, a number, true, false, {...} or [...]"},
    {"bare_key", "{ surfgrad: 1 }", 1, "", "is not valid JSON: invalid literal: \"surfgrad\"",
     "expected string literal"},
    {"single_quotes", "{ 'surfgrad': 1 }", 1, "", "is not valid JSON: invalid literal: \"'\"",
     "expected string literal"},
    {"bad_number", in_layer("\"scale\": 1."), 5, "layers[0].scale",
     "is not valid JSON: invalid number: \"1.<U+000A>\"", "expected digit after '.'"},
    {"string_over_a_line_end", "{ \"surfgrad\": 1,\n\"mesh\": \"a\nb\" }", 2, "mesh",
     "is not valid JSON: invalid string: control character U+000A (LF) must be escaped to \\u000A or \\n: "
     "\"\"a<U+000A>\"",
     ""},
    {"invalid_utf8_in_a_string", "{ \"surfgrad\": 1,\n\"mesh\": \"a\xff\" }", 2, "mesh",
     "is not valid JSON: invalid string: ill-formed UTF-8 byte: \"\"a?\"", "expected UTF-8"},
    {"overlong_utf8", in_document("\"mesh\": \"\xc0\xaf\""), 2, "mesh",
     "is not valid JSON: invalid string: ill-formed UTF-8 byte: \"\"?\"", "expected UTF-8"},
    {"utf16", std::string("\xff\xfe{\0\n\0", 6), 1, "", "is not text: it holds a zero byte",
     "expected a JSON document in UTF-8"},
    {"text_after_a_zero_byte", std::string("{ \"surfgrad\": 1 }\n\0 garbage", 27), 2, "",
     "is not text: it holds a zero byte", "expected a JSON document in UTF-8"},
    {"half_a_byte_order_mark", "\xEF{}", 1, "",
     "is not valid JSON: invalid BOM; must be 0xEF 0xBB 0xBF if given: \"?{\"", "expected UTF-8"},
    {"number_beyond_double", in_layer("\"scale\": 1e999"), 5, "layers[0].scale", "is too large: \"1e999\"",
     "expected a number of magnitude 1e12 or less"},
    {"repeated_key", in_layer("\"scale\": 1,\n\"uv\": 0,\n\"scale\": 2"), 7, "layers[0]",
     "repeats the key \"scale\"", "keep one; the first is on line 5"},
    {"repeated_key_by_escape", "{ \"surfgrad\": 1,\n\"mesh\": \"a\",\n\"m\\u0065sh\": \"b\" }", 3, "",
     "repeats the key \"mesh\"", "keep one; the first is on line 2"},
    {"crlf_lines", "{ \"surfgrad\": 1,\r\n\r\n \"camera\":\r\n5 }", 4, "camera", "is 5",
     "expected an object"},
};

const Case wrong_document[] = {
    {"top_level_array", "\n[]", 2, "", "is an array of 0", "expected an object"},
    {"top_level_number", "1", 1, "", "is 1", "expected an object"},
    {"no_version", "{\n\"mesh\": \"a\" }", 1, "", "lacks \"surfgrad\", the version of the format",
     "expected \"surfgrad\": 1"},
    {"newer_version", "{ \"newkey\": {},\n\"surfgrad\": 2 }", 2, "surfgrad",
     "is 2: the document was written by a newer surfgrad", "this one reads version 1"},
    {"version_zero", "{ \"surfgrad\": 0 }", 1, "surfgrad", "is 0", "expected the version of the format, 1"},
    {"version_string", "{ \"surfgrad\": \"1\" }", 1, "surfgrad", "is a string", "expected a number"},
    {"unknown_top_key", in_document("\"layer\": []"), 2, "", "unknown key \"layer\"",
     "did you mean \"layers\"? expected one of: surfgrad, $schema, mesh, morph, displace, back_faces, "
     "layers, "
     "materials, camera, lights"},
    {"layers_not_an_array", in_document("\"layers\": {}"), 2, "layers", "is an object", "expected an array"},
    {"layer_not_an_object", in_document("\"layers\": [\n\"normal_map\" ]"), 3, "layers[0]", "is a string",
     "expected an object"},
    {"no_layer_type", in_document("\"layers\": [ {\"map\": \"a\"} ]"), 2, "layers[0]", "lacks \"type\"",
     "expected \"type\": one of: " + kind_words},
    {"unknown_layer_type", in_document("\"layers\": [ {\n\"type\": \"normalmap\"} ]"), 3, "layers[0].type",
     "is \"normalmap\"", "did you mean \"normal_map\"? expected one of: " + kind_words},
    {"layer_type_number", in_document("\"layers\": [ {\"type\": 3} ]"), 2, "layers[0].type", "is 3",
     "expected one of: " + kind_words},
    {"materials_not_an_object", in_document("\"materials\": []"), 2, "materials", "is an array of 0",
     "expected an object"},
    {"material_not_an_array", in_document("\"materials\": {\n\"skin\": {} }"), 3, "materials.skin",
     "is an object", "expected an array"},
    {"layer_of_a_quoted_material",
     in_document("\"materials\": { \"a.b\": [ {\"type\": \"resolve\"}, null ] }"), 2, "materials[\"a.b\"][1]",
     "is null", "expected an object"},
    {"mesh_number", in_document("\"mesh\": 5"), 2, "mesh", "is 5", "expected a file name"},
    {"empty_mesh", in_document("\"mesh\": \"\""), 2, "mesh", "is empty", "expected a file name"},
    {"zero_in_a_file_name", in_document("\"mesh\": \"a\\u0000b\""), 2, "mesh", "holds a zero character",
     "expected a file name"},
    {"back_faces_word", in_document("\"back_faces\": \"culled\""), 2, "back_faces", "is \"culled\"",
     "did you mean \"cull\"? expected one of: same, mirror, flip, cull"},
    {"schema_not_a_string", in_document("\"$schema\": false"), 2, "$schema", "is false", "expected a string"},
};

const Case wrong_layer[] = {
    {"no_map", in_document("\"layers\": [\n{\"type\": \"normal_map\"} ]"), 3, "layers[0]", "lacks \"map\"",
     "expected \"map\": a file name"},
    {"no_mask_map", in_layer("\"mask\":\n{}"), 6, "layers[0].mask", "lacks \"map\"",
     "expected \"map\": a file name"},
    {"scale_string", in_layer("\"scale\": \"1\""), 5, "layers[0].scale", "is a string", "expected a number"},
    {"scale_null", in_layer("\"scale\": null"), 5, "layers[0].scale", "is null", "expected a number"},
    {"scale_too_large", in_layer("\"scale\": -1e13"), 5, "layers[0].scale", "is -10000000000000",
     "expected a number of magnitude 1000000000000 or less"},
    {"value_on_its_own_line", in_layer("\"scale\":\n\n\"x\"\n"), 7, "layers[0].scale", "is a string",
     "expected a number"},
    {"number_before_a_line_end", in_layer("\"opacity\": 2\n"), 5, "layers[0].opacity", "is 2",
     "expected a number from 0 to 1"},
    {"negative_opacity", in_layer("\"opacity\": -0.1"), 5, "layers[0].opacity", "is -0.1",
     "expected a number from 0 to 1"},
    {"uv_too_high", in_layer("\"uv\": 8"), 5, "layers[0].uv", "is 8", "expected a whole number from 0 to 7"},
    {"uv_negative", in_layer("\"uv\": -1"), 5, "layers[0].uv", "is -1",
     "expected a whole number from 0 to 7"},
    {"uv_fraction", in_layer("\"uv\": 0.5"), 5, "layers[0].uv", "is 0.5",
     "expected a whole number from 0 to 7"},
    {"uv_bool", in_layer("\"uv\": true"), 5, "layers[0].uv", "is true",
     "expected a whole number from 0 to 7"},
    {"tile_zero", in_layer("\"tile\": 0"), 5, "layers[0].tile", "is 0", "expected a number other than zero"},
    {"tile_part_zero", in_layer("\"tile\": [1,\n-0.0]"), 6, "layers[0].tile[1]", "is -0",
     "expected a number other than zero"},
    {"tile_of_three", in_layer("\"tile\": [1, 2, 3]"), 5, "layers[0].tile", "is an array of 3",
     "expected a number or an array of 2 numbers, none of them zero"},
    {"tile_word", in_layer("\"tile\": [1, \"2\"]"), 5, "layers[0].tile[1]", "is a string",
     "expected a number"},
    {"rotate_array", in_layer("\"rotate\": [30]"), 5, "layers[0].rotate", "is an array of 1",
     "expected a number"},
    {"offset_number", in_layer("\"offset\": 1"), 5, "layers[0].offset", "is 1",
     "expected an array of 2 numbers"},
    {"offset_of_one", in_layer("\"offset\": [1]"), 5, "layers[0].offset", "is an array of 1",
     "expected an array of 2 numbers"},
    {"wrap_word", in_layer("\"wrap\": \"tile\""), 5, "layers[0].wrap", "is \"tile\"",
     "expected one of: repeat, mirror, clamp"},
    {"tiling_word", in_layer("\"tiling\": \"hexagon\""), 5, "layers[0].tiling", "is \"hexagon\"",
     "expected one of: plain, hex"},
    {"hex_tiles_of_a_clamped_map", in_layer("\"tiling\": \"hex\",\n\"wrap\": \"clamp\""), 6, "layers[0].wrap",
     "hex tiling needs a map that repeats", "expected \"wrap\": \"repeat\", or no \"tiling\""},
    {"hex_tiles_of_a_mirrored_mask", in_mask("\"wrap\": \"mirror\", \"tiling\": \"hex\""), 6,
     "layers[0].mask.wrap", "hex tiling needs a map that repeats",
     "expected \"wrap\": \"repeat\", or no \"tiling\""},
    {"turn_of_plain_tiles", in_layer("\"hex_turn\": 0"), 5, "layers[0].hex_turn",
     "does not apply to plain tiling", "leave it out, or give \"tiling\": \"hex\""},
    {"turn_beyond_half", in_layer("\"tiling\": \"hex\", \"hex_turn\": 181"), 5, "layers[0].hex_turn",
     "is 181", "expected a number from 0 to 180"},
    {"hex_tiles_of_a_decal_that_clamps_by_default",
     in_document("\"layers\": [ {\"type\": \"decal\", \"map\": \"a\",\n\"tiling\": \"hex\"} ]"), 3,
     "layers[0].tiling", "hex tiling needs a map that repeats",
     "expected \"wrap\": \"repeat\", or no \"tiling\""},
    {"hex_tiles_of_whole_normals",
     in_document("\"layers\": [ {\"type\": \"object_normal_map\", \"map\": \"a\",\n\"tiling\": \"hex\"} ]"),
     3, "layers[0].tiling", "is \"hex\", but whole normals do not turn with the tiles of a map",
     "leave it out"},
    {"filter_word", in_layer("\"filter\": \"linear\""), 5, "layers[0].filter", "is \"linear\"",
     "did you mean \"bilinear\"? expected one of: nearest, bilinear, trilinear, anisotropic, normal"},
    {"anisotropy_of_another_filter", in_layer("\"filter\": \"trilinear\",\n\"anisotropy\": 4"), 6,
     "layers[0].anisotropy", "does not apply to this filter",
     "leave it out, or give \"filter\": \"anisotropic\""},
    {"anisotropy_beyond_16", in_layer("\"filter\": \"anisotropic\",\n\"anisotropy\": 17"), 6,
     "layers[0].anisotropy", "is 17", "expected a whole number from 1 to 16"},
    {"anisotropy_of_half_probes", in_layer("\"filter\": \"anisotropic\",\n\"anisotropy\": 2.5"), 6,
     "layers[0].anisotropy", "is 2.5", "expected a whole number from 1 to 16"},
    {"normal_filter_of_a_mask", in_mask("\"filter\": \"normal\""), 6, "layers[0].mask.filter",
     "is \"normal\", but this is a mask", "expected one of: nearest, bilinear, trilinear, anisotropic"},
    {"normal_filter_of_slopes",
     in_document("\"layers\": [ {\"type\": \"derivative_map\", \"map\": \"a\",\n\"filter\": \"normal\"} ]"),
     3, "layers[0].filter", "is \"normal\", but this is a map of slopes",
     "expected one of: nearest, bilinear, trilinear, anisotropic"},
    {"normal_filter_of_heights",
     in_document("\"layers\": [ {\"type\": \"height_map\", \"map\": \"a\",\n\"filter\": \"normal\"} ]"), 3,
     "layers[0].filter", "is \"normal\", but this is a map of heights",
     "expected one of: nearest, bilinear, trilinear, anisotropic"},
    {"normal_filter_of_whole_normals",
     in_document(
         "\"layers\": [ {\"type\": \"object_normal_map\", \"map\": \"a\",\n\"filter\": \"normal\"} ]"),
     3, "layers[0].filter",
     "is \"normal\", but this is a map of whole normals, which are filtered as they are",
     "expected one of: nearest, bilinear, trilinear, anisotropic"},
    {"normal_filter_of_projected_heights",
     in_document("\"layers\": [ {\"type\": \"planar\", \"map\": \"a\", \"axis\": \"x\", \"content\": "
                 "\"height\",\n\"filter\": \"normal\"} ]"),
     3, "layers[0].filter", "is \"normal\", but this is no map of tangent-space normals",
     "expected one of: nearest, bilinear, trilinear, anisotropic"},
    {"channels_word", in_layer("\"channels\": \"rgb\""), 5, "layers[0].channels", "is \"rgb\"",
     "expected one of: xyz, xy"},
    {"green_case", in_layer("\"green\": \"Up\""), 5, "layers[0].green", "is \"Up\"",
     "did you mean \"up\"? expected one of: up, down"},
    {"basis_word", in_layer("\"basis\": \"mikktspce\""), 5, "layers[0].basis", "is \"mikktspce\"",
     "did you mean \"mikktspace\"? expected one of: mikktspace, derived"},
    {"blend_word", in_layer("\"blend\": \"replace\""), 5, "layers[0].blend", "is \"replace\"",
     "expected one of: add, mix"},
    {"mask_string", in_layer("\"mask\": \"mask.png\""), 5, "layers[0].mask", "is a string",
     "expected an object"},
    {"mask_channel", in_mask("\"channel\": \"x\""), 6, "layers[0].mask.channel", "is \"x\"",
     "expected one of: r, g, b, a"},
    {"mask_green", in_mask("\"green\": \"up\""), 6, "layers[0].mask", "unknown key \"green\"",
     "expected one of: map, uv, tile, rotate, offset, wrap, filter, anisotropy, tiling, hex_turn, channel"},
    {"mask_key_slip", in_mask("\"chanel\": \"r\""), 6, "layers[0].mask", "unknown key \"chanel\"",
     "did you mean \"channel\"? expected one of: map, uv, tile, rotate, offset, wrap, filter, anisotropy, "
     "tiling, "
     "hex_turn, channel"},
    {"space_of_a_tangent_map", in_layer("\"space\": \"object\""), 5, "layers[0]", "unknown key \"space\"",
     layer_keys},
    {"unknown_key_without_a_near_one", in_layer("\"strength\": 1"), 5, "layers[0]",
     "unknown key \"strength\"", layer_keys},
    {"unknown_key_line_is_the_keys", in_layer("\"zz\"\n:\n1"), 5, "layers[0]", "unknown key \"zz\"",
     layer_keys},
    {"long_key_is_cut", in_layer("\"" + std::string(59, 'x') + "\xc3\xa9" + std::string(500, 'y') + "\": 1"),
     5, "layers[0]", "unknown key \"xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...\"",
     layer_keys},
    {"basis_of_an_object_map",
     in_document(
         "\"layers\": [ {\"type\": \"object_normal_map\", \"map\": \"a\",\n\"basis\": \"derived\"} ]"),
     3, "layers[0]", "unknown key \"basis\"",
     "expected one of: type, map, uv, tile, rotate, offset, wrap, filter, anisotropy, tiling, hex_turn, "
     "green, space, "
     "scale, "
     "mask, "
     "opacity, blend"},
    {"space_word",
     in_document(
         "\"layers\": [ {\"type\": \"object_normal_map\", \"map\": \"a\",\n\"space\": \"tangent\"} ]"),
     3, "layers[0].space", "is \"tangent\"", "expected one of: object, world"},
    {"derivative_range_zero",
     in_document("\"layers\": [ {\"type\": \"derivative_map\", \"map\": \"a\",\n\"range\": 0} ]"), 3,
     "layers[0].range", "is 0", "expected a number greater than 0"},
    {"derivative_neutral_word",
     in_document("\"layers\": [ {\"type\": \"derivative_map\", \"map\": \"a\",\n\"neutral\": 128} ]"), 3,
     "layers[0].neutral", "is 128", "expected one of: between, whole"},
    {"channels_of_a_derivative_map",
     in_document("\"layers\": [ {\"type\": \"derivative_map\", \"map\": \"a\",\n\"channels\": \"xy\"} ]"), 3,
     "layers[0]", "unknown key \"channels\"",
     "expected one of: type, map, uv, tile, rotate, offset, wrap, filter, anisotropy, tiling, hex_turn, "
     "green, range, "
     "neutral, basis, "
     "scale, mask, opacity, blend"},
    {"height_without_a_map", in_document("\"layers\": [\n{\"type\": \"height_map\"} ]"), 3, "layers[0]",
     "lacks \"map\"", "expected \"map\": a file name"},
    {"height_word", in_heights("\"height\": \"tall\""), 3, "layers[0].height", "is a string",
     "expected a number"},
    {"height_mode_word", in_heights("\"mode\": \"scale-free\""), 3, "layers[0].mode", "is \"scale-free\"",
     "did you mean \"scale_free\"? expected one of: physical, scale_free"},
    {"height_units_word", in_heights("\"units\": \"world\""), 3, "layers[0].units", "is \"world\"",
     "expected one of: scene, object"},
    {"height_taps_number", in_heights("\"taps\": 3"), 3, "layers[0].taps", "is 3",
     "expected one of: one, three, bicubic"},
    {"height_green", in_heights("\"green\": \"up\""), 3, "layers[0]", "unknown key \"green\"",
     "expected one of: type, map, uv, tile, rotate, offset, wrap, filter, anisotropy, tiling, hex_turn, "
     "channel, mode, "
     "height, units, "
     "taps, basis, scale, mask, opacity, blend"},
    {"basis_of_a_physical_height", in_heights("\"basis\": \"derived\""), 3, "layers[0].basis",
     "does not apply to this mode", "leave it out, or give \"mode\": \"scale_free\""},
    {"units_of_a_scale_free_height", in_heights("\"mode\": \"scale_free\",\n\"units\": \"scene\""), 4,
     "layers[0].units", "does not apply to this mode", "leave it out, or give \"mode\": \"physical\""},
    {"taps_of_a_scale_free_height", in_heights("\"taps\": \"three\",\n\"mode\": \"scale_free\""), 3,
     "layers[0].taps", "does not apply to this mode",
     "leave it out, or give \"mode\": \"physical\" or \"taps\": \"bicubic\""},
    {"parallax_after_another_layer", in_layer("\"uv\": 0 },\n{ \"type\": \"parallax\", \"map\": \"h\""), 6,
     "layers[1]", "\"parallax\" follows another layer in its pass",
     "put it first in the list, or a layer { \"type\": \"resolve\" } right before it"},
    {"parallax_after_parallax_in_a_material",
     in_document("\"materials\": { \"skin\": [\n{ \"type\": \"parallax\", \"map\": \"h\" },\n"
                 "{ \"type\": \"parallax\", \"map\": \"h\" } ] }"),
     4, "materials.skin[1]", "\"parallax\" follows another layer in its pass",
     "put it first in the list, or a layer { \"type\": \"resolve\" } right before it"},
    {"parallax_height_zero", in_parallax("\"height\": 0"), 3, "layers[0].height", "is 0",
     "expected a number greater than 0"},
    {"parallax_level", in_parallax("\"level\": 1.5"), 3, "layers[0].level", "is 1.5",
     "expected a number from 0 to 1"},
    {"parallax_method_word", in_parallax("\"method\": \"occlusions\""), 3, "layers[0].method",
     "is \"occlusions\"", "did you mean \"occlusion\"? expected one of: offset, occlusion"},
    {"parallax_truth_as_a_number", in_parallax("\"self_shadow\": 1"), 3, "layers[0].self_shadow", "is 1",
     "expected true or false"},
    {"parallax_truth_as_a_word", in_parallax("\"curvature\": \"yes\""), 3, "layers[0].curvature",
     "is a string", "expected true or false"},
    {"parallax_limit_of_occlusion", in_parallax("\"limit_offset\": true"), 3, "layers[0].limit_offset",
     "does not apply to this method", "leave it out, or give \"method\": \"offset\""},
    {"parallax_nearest", in_parallax("\"filter\": \"nearest\""), 3, "layers[0].filter",
     "does not apply to heights that are seen from the side", "expected one of: bilinear, trilinear"},
    {"parallax_anisotropic", in_parallax("\"filter\": \"anisotropic\""), 3, "layers[0].filter",
     "does not apply to heights that are seen from the side", "expected one of: bilinear, trilinear"},
    {"resolve_with_a_scale", in_document("\"layers\": [ {\"type\": \"resolve\",\n\"scale\": 1} ]"), 3,
     "layers[0]", "unknown key \"scale\"", "expected one of: type"},
};

const Case wrong_view[] = {
    {"camera_array", in_document("\"camera\": []"), 2, "camera", "is an array of 0", "expected an object"},
    {"fov_zero", in_document("\"camera\": {\"fov\": 0}"), 2, "camera.fov", "is 0",
     "expected a number greater than 0 and less than 180"},
    {"fov_half_turn", in_document("\"camera\": {\"fov\": 180}"), 2, "camera.fov", "is 180",
     "expected a number greater than 0 and less than 180"},
    {"zoom_zero", in_document("\"camera\": {\"zoom\": 0}"), 2, "camera.zoom", "is 0",
     "expected a number greater than 0"},
    {"pitch_over_the_pole", in_document("\"camera\": {\"pitch\": 90.5}"), 2, "camera.pitch", "is 90.5",
     "expected a number from -90 to 90"},
    {"position_alone", in_document("\"camera\":\n{\"position\": [0, 0, 1]}"), 3, "camera",
     "has a \"position\" but no \"target\"",
     "give \"position\" and \"target\", or \"yaw\", \"pitch\" and \"zoom\""},
    {"target_alone", in_document("\"camera\": {\"target\": [0, 0, 1]}"), 2, "camera",
     "has a \"target\" but no \"position\"",
     "give \"position\" and \"target\", or \"yaw\", \"pitch\" and \"zoom\""},
    {"position_and_yaw", in_document("\"camera\": {\"position\": [0,0,1], \"target\": [0,0,0], \"yaw\": 1}"),
     2, "camera", "has a \"position\" and \"yaw\"",
     "give \"position\" and \"target\", or \"yaw\", \"pitch\" and \"zoom\""},
    {"position_is_target", in_document("\"camera\": {\"position\": [1,2,3], \"target\": [1,2,3]}"), 2,
     "camera", "\"position\" and \"target\" are the same point", "expected two points"},
    {"position_of_two", in_document("\"camera\": {\"position\": [1,2]}"), 2, "camera.position",
     "is an array of 2", "expected an array of 3 numbers"},
    {"lights_key", in_document("\"lights\": {\"moon\": 1}"), 2, "lights", "unknown key \"moon\"",
     "expected one of: sun, sky, environment"},
    {"sky_negative", in_document("\"lights\": {\"sky\": -1}"), 2, "lights.sky", "is -1",
     "expected a number at least 0"},
    {"sun_strength", in_document("\"lights\": {\"sun\": {\n\"strength\": -1}}"), 3, "lights.sun.strength",
     "is -1", "expected a number at least 0"},
    {"sun_direction_zero", in_document("\"lights\": {\"sun\": {\n\"direction\": [0, 0, 0]}}"), 3,
     "lights.sun.direction", "is the zero vector", "expected the direction of the sun"},
    {"empty_environment", in_document("\"lights\": {\"environment\": \"\"}"), 2, "lights.environment",
     "is empty", "expected a file name"},
};

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(not_json, StackErrors, testing::ValuesIn(not_json), name_of);
INSTANTIATE_TEST_SUITE_P(document, StackErrors, testing::ValuesIn(wrong_document), name_of);
INSTANTIATE_TEST_SUITE_P(layer, StackErrors, testing::ValuesIn(wrong_layer), name_of);
INSTANTIATE_TEST_SUITE_P(view, StackErrors, testing::ValuesIn(wrong_view), name_of);

TEST(StackErrorMessage, is_one_line_that_names_file_line_key_and_remedy) {
  try {
    static_cast<void>(parse_stack(in_mask("\"chan\\nel\": \"r\""), "dir/stack.json"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "dir/stack.json:6: layers[0].mask: unknown key \"chan?el\"; did you mean "
                               "\"channel\"? expected one of: map, uv, tile, rotate, offset, wrap, filter, "
                               "anisotropy, tiling, hex_turn, channel");
  }
}

} // namespace
} // namespace surfgrad::stack
