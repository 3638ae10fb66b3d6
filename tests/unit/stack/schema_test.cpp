#include "stack/format.hpp"
#include "stack/stack.hpp"
#include "stack_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace surfgrad::stack {
namespace {

using nlohmann::json;
using test::text_of;

std::string file_text(const char* name) {
  std::ifstream file(std::string(SURFGRAD_SOURCE_DIR "/docs/") + name);
  EXPECT_TRUE(file) << name;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

const json& schema() {
  static const json document = json::parse(file_text("stack.schema.json"));
  return document;
}

/// The schema of an object: the document's own, or a definition.
const json& object_schema(std::string_view name) {
  return name == Stack::format_name ? schema() : schema().at("definitions").at(std::string(name));
}

/// A schema with its references to simple values replaced and without what is for readers only.
/// References to objects and layers stay.
json rules_of(json value) {
  if (value.is_array())
    for (json& element : value) element = rules_of(element);
  if (!value.is_object()) return value;
  static const std::set<std::string> kept = {"#/definitions/mask",          "#/definitions/camera",
                                             "#/definitions/convention",    "#/definitions/lights",
                                             "#/definitions/sun",           "#/definitions/layers",
                                             "#/definitions/displace",      "#/definitions/displacement_map",
                                             "#/definitions/decal_instance"};
  if (value.contains("$ref") && kept.count(value["$ref"]) == 0)
    return rules_of(schema().at(json::json_pointer(value["$ref"].get<std::string>().substr(1))));
  value.erase("description");
  value.erase("default");
  for (json& member : value) member = rules_of(member);
  return value;
}

json range_schema(const char* type, const Range& range) {
  return {{"type", type},
          {range.excludes_least ? "exclusiveMinimum" : "minimum", range.least},
          {range.excludes_most ? "exclusiveMaximum" : "maximum", range.most}};
}

/// What the schema must say of a key that accepts this shape.
json expected_schema(const Shape& shape) {
  const json number = range_schema("number", {});
  const json positive = range_schema("number", {.least = 0, .excludes_least = true});
  const json nonzero = {{"allOf", {number, {{"not", {{"const", 0}}}}}}};
  const auto array = [](int size, const json& items) -> json {
    return {{"type", "array"}, {"minItems", size}, {"maxItems", size}, {"items", items}};
  };
  switch (shape.kind) {
  case Shape::Kind::number:
    return range_schema("number", shape.range);
  case Shape::Kind::integer:
    return range_schema("integer", shape.range);
  case Shape::Kind::truth:
    return {{"type", "boolean"}};
  case Shape::Kind::word:
    return {{"enum", shape.words}};
  case Shape::Kind::text:
    return {{"type", "string"}};
  case Shape::Kind::file:
    return {{"type", "string"}, {"minLength", 1}};
  case Shape::Kind::files: {
    const json file = {{"type", "string"}, {"minLength", 1}};
    json ways = {file};
    for (const int count : shape.counts) ways.push_back(array(count, file));
    return {{"anyOf", ways}};
  }
  case Shape::Kind::vector:
    return array(shape.components, number);
  case Shape::Kind::numbers:
    return {{"type", "array"}, {"items", number}};
  case Shape::Kind::tile:
    return {{"anyOf", {nonzero, array(2, nonzero)}}};
  case Shape::Kind::size:
    return {{"anyOf", {positive, array(3, positive)}}};
  case Shape::Kind::object:
    return {{"$ref", "#/definitions/" + std::string(shape.object)}};
  case Shape::Kind::objects:
    return {{"type", "array"}, {"items", {{"$ref", "#/definitions/" + std::string(shape.object)}}}};
  case Shape::Kind::layers:
    return {{"$ref", "#/definitions/layers"}};
  case Shape::Kind::materials:
    return {{"type", "object"}, {"additionalProperties", {{"$ref", "#/definitions/layers"}}}};
  }
  return {};
}

TEST(StackSchema, accepts_the_keys_words_and_ranges_of_the_parser) {
  for (const ObjectFormat& object : document_format()) {
    SCOPED_TRACE(std::string(object.name));
    const json& description = object_schema(object.name);
    EXPECT_EQ(description.at("type"), "object");
    EXPECT_EQ(description.at("additionalProperties"), false);
    std::set<std::string> keys, required;
    for (const KeyFormat& key : object.keys) {
      SCOPED_TRACE(std::string(key.key));
      EXPECT_TRUE(keys.insert(std::string(key.key)).second) << "listed twice";
      if (key.required) required.insert(std::string(key.key));
      ASSERT_TRUE(description.at("properties").contains(std::string(key.key)));
      EXPECT_EQ(rules_of(description["properties"][std::string(key.key)]), expected_schema(key.shape));
    }
    for (const auto& [key, value] : description["properties"].items())
      EXPECT_EQ(keys.count(key), 1u) << key << " is in the schema only";
    EXPECT_EQ(description.value("required", json::array()).get<std::set<std::string>>(), required);
  }
}

TEST(StackSchema, knows_the_objects_and_layer_kinds_of_the_parser) {
  std::set<std::string> objects, kinds;
  for (const ObjectFormat& object : document_format()) {
    objects.insert(std::string(object.name));
    if (object.is_layer) kinds.insert("#/definitions/" + std::string(object.name));
  }
  for (const ObjectFormat& object : document_format())
    for (const KeyFormat& key : object.keys) {
      if (key.shape.kind == Shape::Kind::object) {
        EXPECT_EQ(objects.count(std::string(key.shape.object)), 1u) << key.shape.object;
      }
    }
  std::set<std::string> listed;
  for (const json& kind : schema()["definitions"]["layer"]["oneOf"]) listed.insert(kind["$ref"]);
  EXPECT_EQ(listed, kinds);
  for (const auto& [name, definition] : schema()["definitions"].items()) {
    if (definition.value("type", "") == "object") {
      EXPECT_EQ(objects.count(name), 1u) << name;
    }
  }
}

/// The keys that apply to some contents of a projected map only.
const std::map<std::string, std::set<std::string>> keys_of_content = {
    {"normal", {"green", "tiling"}},
    {"derivative", {"green", "range", "neutral", "tiling"}},
    {"height", {"channel", "height", "tiling"}},
    {"object_normal", {"green"}}};

/// The contents of a layer kind; one of none for kinds without that key.
std::vector<std::string> contents_of(const ObjectFormat& object) {
  for (const KeyFormat& key : object.keys)
    if (key.key == "content") return {key.shape.words.begin(), key.shape.words.end()};
  return {""};
}

/// A layer's defaults without those that do not apply to the content.
json of_content(json defaults, const std::string& content) {
  if (content.empty()) return defaults;
  for (const auto& [other, keys] : keys_of_content)
    for (const std::string& key : keys)
      if (keys_of_content.at(content).count(key) == 0) defaults.erase(key);
  defaults["content"] = content;
  return defaults;
}

/// An object of the document with every default of the schema written out.
json with_defaults(const ObjectFormat& object) {
  json value = json::object();
  for (const KeyFormat& key : object.keys) {
    const json* description = &object_schema(object.name).at("properties").at(std::string(key.key));
    if (description->contains("$ref"))
      description = &schema().at(json::json_pointer((*description)["$ref"].get<std::string>().substr(1)));
    if (description->contains("default")) value[std::string(key.key)] = (*description)["default"];
  }
  return value;
}

TEST(StackSchema, defaults_are_those_of_the_parser) {
  json plain = {{"surfgrad", 1},
                {"camera", json::object()},
                {"lights", {{"sun", json::object()}}},
                {"displace", {{"map", {{"map", "h.png"}}}, {"height", 1}}}};
  json full = plain;
  for (const ObjectFormat& object : document_format()) {
    json defaults = with_defaults(object);
    EXPECT_TRUE(!defaults.empty() || object.name == "resolve" || object.name == Stack::format_name ||
                object.name == "sun" || object.name == "decal_instance")
        << object.name;
    if (object.name == "displace") // with the map that the document has, no function
      for (const char* odd :
           {"function", "basis", "worley", "octaves", "lacunarity", "gain", "power", "frequency", "offset"})
        defaults.erase(odd);
    if (object.name == "camera") full["camera"] = defaults;
    if (object.name == "lights") full["lights"].update(defaults);
    if (object.name == "displace") full["displace"].update(defaults);
    if (object.name == "displacement_map") full["displace"]["map"].update(defaults);
    if (object.name == "sun") full["lights"]["sun"] = defaults;
    if (object.name == "convention") {
      plain["layers"].push_back({{"type", "triplanar"}, {"map", "n.png"}});
      full["layers"].push_back({{"type", "triplanar"}, {"map", "n.png"}, {"convention", defaults}});
    }
    json layer = {{"type", object.is_layer ? std::string(object.name) : "normal_map"}};
    for (const KeyFormat& key : object.keys)
      if (key.required && (key.shape.kind == Shape::Kind::file || key.shape.kind == Shape::Kind::files))
        layer[std::string(key.key)] = "n.png";
    if (object.name == "planar") layer["axis"] = "z";
    json full_layer = layer;
    if (object.name == "mask") {
      layer["mask"] = {{"map", "k.png"}};
      full_layer["mask"] = layer["mask"];
      full_layer["mask"].update(defaults);
    } else if (object.is_layer) {
      if (object.name == "parallax") // opens a pass
        for (json* document : {&plain, &full}) (*document)["layers"].push_back({{"type", "resolve"}});
      if (object.name == "noise") { // the function for which every key has a meaning
        layer.update({{"function", "turbulence"}, {"basis", "worley"}});
        defaults.update({{"function", "turbulence"}, {"basis", "worley"}});
      }
      for (const std::string& content : contents_of(object)) {
        full_layer = layer;
        full_layer.update(of_content(defaults, content));
        if (!content.empty() && content != "normal") layer["content"] = content;
        plain["layers"].push_back(layer);
        full["layers"].push_back(full_layer);
      }
      continue;
    } else {
      continue;
    }
    plain["layers"].push_back(layer);
    full["layers"].push_back(full_layer);
  }
  EXPECT_EQ(text_of(parse_stack(full.dump(), "full")), text_of(parse_stack(plain.dump(), "plain")));
}

TEST(StackDocumentation, examples_parse) {
  const std::string page = file_text("stack-format.md");
  const std::string open = "```json\n";
  int examples = 0;
  for (std::size_t at = page.find(open); at != page.npos; at = page.find(open, at)) {
    at += open.size();
    const std::string example = page.substr(at, page.find("```", at) - at);
    EXPECT_NO_THROW(static_cast<void>(parse_stack(example, "stack-format.md"))) << example;
    ++examples;
  }
  EXPECT_EQ(examples, 8);
}

TEST(StackDocumentation, names_every_key_and_word) {
  const std::string page = file_text("stack-format.md");
  for (const ObjectFormat& object : document_format())
    for (const KeyFormat& key : object.keys) {
      EXPECT_NE(page.find(fmt::format("`{}`", key.key)), page.npos) << key.key;
      for (const std::string_view word : key.shape.words)
        EXPECT_NE(page.find(fmt::format("`{}`", word)), page.npos) << word;
    }
}

} // namespace
} // namespace surfgrad::stack
