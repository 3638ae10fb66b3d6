#include "shadergen/shadergen.hpp"
#include "stack/words.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstring>

namespace surfgrad::shadergen {
namespace {

using Json = nlohmann::ordered_json;

template <class Enum>
std::string word_of(Enum value) {
  for (const auto& word : stack::words_of<Enum>)
    if (word.value == value) return std::string(word.text);
  return {};
}

const char* language_word(Language language) {
  switch (language) {
  case Language::hlsl:
    return "hlsl";
  case Language::wgsl:
    return "wgsl";
  case Language::godot:
    return "godot";
  case Language::glsl:
    break;
  }
  return "glsl";
}

const char* kind_word(MapKind kind) {
  switch (kind) {
  case MapKind::slopes:
  case MapKind::normals:
    return "tangent-space normal: code 0 to 1 means -1 to 1";
  case MapKind::derivatives:
    return "slopes along s (red) and t (green), -range to range";
  case MapKind::heights:
  case MapKind::height_slopes:
  case MapKind::relief:
    return "height";
  case MapKind::directions:
  case MapKind::cube:
    return "direction: code 0 to 1 means -1 to 1";
  case MapKind::weights:
    break;
  }
  return "weight, 0 to 1";
}

Json texture_of(const TextureBinding& t, Language language) {
  Json files = Json::array();
  for (const stack::FileName& file : t.files) files.push_back(file.path.generic_string());
  Json json{{"name", t.name}, {"binding", t.binding}};
  if (language == Language::hlsl || language == Language::wgsl) {
    json["sampler"] = t.sampler;
    json["sampler_binding"] = t.sampler_binding;
  }
  json["map"] = files.size() == 1 ? files[0] : files;
  json["dimension"] = t.kind == MapKind::cube ? "cube" : "2d";
  json["texel"] = kind_word(t.kind);
  json["color_space"] = "linear";
  json["layers"] = t.layers;
  if (t.uv >= 0) json["uv"] = t.uv;
  json["wrap"] = {word_of(t.wrap_s), word_of(t.wrap_t)};
  json["filter"] = word_of(t.filter);
  if (t.anisotropy > 1) json["anisotropy"] = t.anisotropy;
  switch (t.kind) {
  case MapKind::slopes:
  case MapKind::normals:
    json["channels"] = t.channels == stack::Channels::automatic ? "automatic" : word_of(t.channels);
    json["green"] = word_of(t.green);
    break;
  case MapKind::derivatives:
    json["channels"] = "xy";
    json["green"] = word_of(t.green);
    json["range"] = t.code.range;
    json["neutral"] = word_of(t.code.neutral);
    break;
  case MapKind::directions:
    json["green"] = word_of(t.green);
    break;
  case MapKind::heights:
  case MapKind::height_slopes:
  case MapKind::weights:
  case MapKind::relief:
    json["channel"] = word_of(t.channel);
    break;
  case MapKind::cube:
    break;
  }
  return json;
}

const char* type_word(Parameter::Type type) {
  switch (type) {
  case Parameter::Type::vec2:
    return "vec2";
  case Parameter::Type::vec4:
    return "vec4";
  case Parameter::Type::number:
    break;
  }
  return "float";
}

} // namespace

std::string manifest(const Shader& shader) {
  Json json{{"surfgrad_shader", 1},
            {"language", language_word(shader.language)},
            {"function", shader.name + "_normal"}};
  if (shader.language != Language::godot) json["group"] = shader.group;
  if (shader.displaces) json["vertex_function"] = shader.name + "_displaced";
  json["surface"] = Json::array();
  for (const SurfaceMember& m : shader.surface) {
    Json member{{"name", m.name}, {"type", m.type}};
    if (m.uv >= 0) member["uv"] = m.uv;
    json["surface"].push_back(std::move(member));
  }
  Json parameters = Json::array();
  for (const Parameter& p : shader.parameters) {
    const Json value = p.value.size() == 1 ? Json(p.value[0]) : Json(p.value);
    parameters.push_back({{"name", p.name},
                          {"type", type_word(p.type)},
                          {"offset", p.offset},
                          {"value", value},
                          {"meaning", p.meaning}});
  }
  json["parameters"] = {{"binding", shader.parameters_binding},
                        {"bytes", shader.parameter_data.size()},
                        {"members", std::move(parameters)}};
  json["textures"] = Json::array();
  for (const TextureBinding& t : shader.textures) json["textures"].push_back(texture_of(t, shader.language));
  if (shader.decal_count > 0) {
    Json values = Json::array();
    for (std::size_t i = 0; i < shader.decal_data.size(); i += sizeof(float)) {
      float value = 0;
      std::memcpy(&value, shader.decal_data.data() + i, sizeof value);
      values.push_back(value);
    }
    json["decals"] = {{"binding", shader.decals_binding},
                      {"in", shader.decals_in_block ? "uniforms" : "storage buffer"},
                      {"count", shader.decal_count},
                      {"vec4s_each", bytes_a_decal / 16},
                      {"data", std::move(values)}};
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace surfgrad::shadergen
