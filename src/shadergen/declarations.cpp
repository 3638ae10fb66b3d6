#include "shadergen/declarations.hpp"

#include "diagnostic/error.hpp"
#include "shadergen/parameters.hpp"
#include "shadergen/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace surfgrad::shadergen {
namespace {

constexpr int vec4s_a_decal = bytes_a_decal / 16;

/// Textures and samplers that share one state share a sampler.
auto state_of(const TextureBinding& t) {
  const bool mipmaps = t.filter != stack::Filter::nearest && t.filter != stack::Filter::bilinear;
  return std::tuple(t.kind == MapKind::cube, t.wrap_s, t.wrap_t, t.filter == stack::Filter::nearest, mipmaps,
                    t.anisotropy);
}

[[noreturn]] void refuse(const TextureBinding& texture, const Options& options, std::string problem,
                         std::string remedy) {
  throw InputError({.file = options.document,
                    .line = texture.files[0].line,
                    .place = texture.layers[0],
                    .problem = std::move(problem),
                    .remedy = std::move(remedy)});
}

std::string remark(const std::string& text) { return text.empty() ? "" : " // " + text; }

std::string member_lines(const Shader& shader) {
  std::string lines;
  for (const BlockMember& m : block_members(shader))
    lines += shader.language == Language::wgsl
                 ? fmt::format("  {}: {},{}\n", m.name, type_in(shader.language, m.type), remark(m.meaning))
                 : fmt::format("  {} {};{}\n", type_in(shader.language, m.type), m.name, remark(m.meaning));
  return lines;
}

std::string glsl(const Shader& shader, const Options& options) {
  std::string text;
  if (options.access == TextureAccess::exact) {
    if (!shader.parameters.empty())
      text += fmt::format(
          "layout(std140, set = 0, binding = {}) uniform StackParameters {{\n{}}} stack_parameters;\n\n",
          ExactLayout::parameters, member_lines(shader));
    if (shader.decal_count > 0)
      text += fmt::format("layout(std430, set = 0, binding = {}) readonly buffer StackDecals {{ vec4 "
                          "stack_decal_data[]; }};\n",
                          ExactLayout::decals);
    if (!shader.textures.empty())
      text += fmt::format(
          "layout(std430, set = 0, binding = {}) readonly buffer StackWords {{ uint stack_words[]; }};\n"
          "layout(std430, set = 0, binding = {}) readonly buffer StackMaps {{ uint stack_maps[]; }};\n\n",
          ExactLayout::words, ExactLayout::maps);
    for (const TextureBinding& t : shader.textures)
      if (t.sampled)
        text += fmt::format("layout(set = 0, binding = {}) uniform sampler2D {};\n",
                            ExactLayout::textures + t.binding, t.name);
  } else {
    text += "// OpenGL ES gives its bindings in the program; other numbers: define these before.\n"
            "#ifndef SURFGRAD_BINDING\n"
            "#ifdef GL_ES\n"
            "#define SURFGRAD_BINDING(n)\n"
            "#define SURFGRAD_TEXTURE(n) uniform highp\n"
            "#else\n"
            "#define SURFGRAD_BINDING(n) , binding = n\n"
            "#define SURFGRAD_TEXTURE(n) layout(binding = n) uniform\n"
            "#endif\n"
            "#endif\n\n";
    if (!shader.parameters.empty())
      text += fmt::format(
          "layout(std140 SURFGRAD_BINDING({})) uniform StackParameters {{\n{}}} stack_parameters;\n\n",
          shader.parameters_binding, member_lines(shader));
    if (shader.decal_count > 0 && shader.decals_in_block)
      text += fmt::format(
          "layout(std140 SURFGRAD_BINDING({})) uniform StackDecals {{ vec4 stack_decal_data[{}]; }};\n",
          shader.decals_binding, vec4s_a_decal * shader.decal_count);
    if (shader.decal_count > 0 && !shader.decals_in_block)
      text += fmt::format(
          "#ifdef GL_ES\n#error \"This stack has {} decals; GLSL ES takes {}.\"\n#endif\n"
          "layout(std430 SURFGRAD_BINDING({})) readonly buffer StackDecals {{ vec4 stack_decal_data[]; }};\n",
          shader.decal_count, most_decals_es, shader.decals_binding);
    for (const TextureBinding& t : shader.textures)
      text += fmt::format("SURFGRAD_TEXTURE({}) {} {};\n", t.binding,
                          t.kind == MapKind::cube ? "samplerCube" : "sampler2D", t.name);
  }
  if (shader.decal_count > 0) text += "vec4 stack_decals(int i) { return stack_decal_data[i]; }\n";
  return text + "\n";
}

std::string hlsl(const Shader& shader, std::string_view code) {
  std::string text;
  if (!shader.parameters.empty())
    text += fmt::format("struct StackParameters {{\n{}}};\n"
                        "cbuffer StackBlock : register(b{}) {{ StackParameters stack_parameters; }};\n\n",
                        member_lines(shader), shader.parameters_binding);
  if (shader.decal_count > 0)
    text += fmt::format("StructuredBuffer<float4> stack_decal_data : register(t{});\n"
                        "float4 stack_decals(int i) {{ return stack_decal_data[i]; }}\n",
                        shader.decals_binding);
  std::map<int, std::string> samplers;
  for (const TextureBinding& t : shader.textures) {
    text += fmt::format("{}<float4> {} : register(t{});\n",
                        t.kind == MapKind::cube ? "TextureCube" : "Texture2D", t.name, t.binding);
    samplers[t.sampler_binding] = t.sampler;
  }
  for (const auto& [binding, name] : samplers)
    text += fmt::format("SamplerState {} : register(s{});\n", name, binding);
  if (code.find("stack_texture_size(") != std::string_view::npos)
    text += "\nfloat2 stack_texture_size(Texture2D<float4> map) {\n"
            "  uint width, height;\n"
            "  map.GetDimensions(width, height);\n"
            "  return float2(width, height);\n"
            "}\n";
  return text + "\n";
}

std::string wgsl(const Shader& shader) {
  std::string text;
  if (!shader.parameters.empty())
    text += fmt::format("struct StackParameters {{\n{}}}\n"
                        "@group(0) @binding({}) var<uniform> stack_parameters: StackParameters;\n\n",
                        member_lines(shader), shader.parameters_binding);
  if (shader.decal_count > 0)
    text += fmt::format("@group(0) @binding({}) var<storage, read> stack_decal_data: array<vec4f>;\n"
                        "fn stack_decals(i: i32) -> vec4f {{ return stack_decal_data[i]; }}\n",
                        shader.decals_binding);
  std::map<int, std::string> samplers;
  for (const TextureBinding& t : shader.textures) {
    text += fmt::format("@group(0) @binding({}) var {}: texture_{}<f32>;\n", t.binding, t.name,
                        t.kind == MapKind::cube ? "cube" : "2d");
    samplers[t.sampler_binding] = t.sampler;
  }
  for (const auto& [binding, name] : samplers)
    text += fmt::format("@group(0) @binding({}) var {}: sampler;\n", binding, name);
  return text + "\n";
}

std::string godot_value(const Parameter& p) {
  std::string values;
  for (const double v : p.value) {
    std::string number = fmt::format("{}", v);
    if (number.find_first_of(".e") == std::string::npos) number += ".0";
    values += (values.empty() ? "" : ", ") + number;
  }
  switch (p.type) {
  case Parameter::Type::vec2:
    return "vec2(" + values + ")";
  case Parameter::Type::vec4:
    return "vec4(" + values + ")";
  case Parameter::Type::number:
    break;
  }
  return values;
}

std::string godot_hints(const TextureBinding& t) {
  const auto filter = [&]() -> std::string {
    if (t.filter == stack::Filter::nearest) return "filter_nearest";
    if (t.filter == stack::Filter::bilinear) return "filter_linear";
    return t.anisotropy > 1 ? "filter_linear_mipmap_anisotropic" : "filter_linear_mipmap";
  };
  return filter() + (t.wrap_s == stack::Wrap::repeat ? ", repeat_enable" : ", repeat_disable");
}

std::string godot(const Shader& shader) {
  std::string text;
  for (const Parameter& p : shader.parameters) {
    const char* type = p.type == Parameter::Type::vec2   ? "vec2"
                       : p.type == Parameter::Type::vec4 ? "vec4"
                                                         : "float";
    text += fmt::format("uniform {} stack_{} = {};{}\n", type, p.name, godot_value(p), remark(p.meaning));
  }
  if (shader.decal_count > 0)
    text += fmt::format("uniform vec4 stack_decal_data[{}];\n"
                        "vec4 stack_decals(int i) {{ return stack_decal_data[i]; }}\n",
                        vec4s_a_decal * shader.decal_count);
  for (const TextureBinding& t : shader.textures)
    text += fmt::format("uniform {} {} : {};\n", t.kind == MapKind::cube ? "samplerCube" : "sampler2D",
                        t.name, godot_hints(t));
  return text + "\n";
}

} // namespace

int most_textures(Language language) { return language == Language::hlsl ? 128 : 16; }

void number_bindings(Shader& shader, const Options& options) {
  if (options.access == TextureAccess::exact) {
    shader.parameters_binding = ExactLayout::parameters;
    shader.decals_binding = ExactLayout::decals;
    return;
  }
  const int most = most_textures(shader.language);
  const auto count = static_cast<int>(shader.textures.size());
  if (count > most)
    refuse(shader.textures[static_cast<std::size_t>(most)], options,
           fmt::format("brings the stack to more than {} textures", most),
           "a shader in this language takes no more; use fewer maps, or bake some layers");
  shader.decals_in_block = shader.language == Language::godot ||
                           (shader.language == Language::glsl && shader.decal_count <= most_decals_es);
  const bool one_namespace = shader.language == Language::glsl || shader.language == Language::wgsl;
  int next = one_namespace && !shader.parameters.empty() ? 1 : 0;
  if (shader.decal_count > 0) shader.decals_binding = next++;
  std::map<decltype(state_of(TextureBinding{})), int> samplers;
  const bool separate = shader.language == Language::hlsl || shader.language == Language::wgsl;
  for (TextureBinding& t : shader.textures) {
    t.binding = next++;
    if (!separate) continue;
    const int number = samplers.try_emplace(state_of(t), static_cast<int>(samplers.size())).first->second;
    constexpr int most_samplers = 16;
    if (number == most_samplers)
      refuse(t, options,
             fmt::format("brings the stack to more than {} kinds of wrapping and filtering", most_samplers),
             "a shader in this language takes no more");
    t.sampler = fmt::format("stack_sampler{}", number);
    t.sampler_binding = number;
  }
  if (shader.language == Language::wgsl)
    for (TextureBinding& t : shader.textures) t.sampler_binding += next;
  if (shader.language == Language::godot)
    for (const TextureBinding& t : shader.textures) {
      const bool mirrored = t.wrap_s == stack::Wrap::mirror || t.wrap_t == stack::Wrap::mirror;
      if (mirrored || (t.wrap_s != t.wrap_t))
        refuse(t, options, mirrored ? "has \"wrap\": \"mirror\"" : "wraps differently along s and t",
               "Godot repeats or clamps textures, along both axes alike");
    }
}

std::string declarations(const Shader& shader, const Options& options, std::string_view code) {
  switch (shader.language) {
  case Language::hlsl:
    return hlsl(shader, code);
  case Language::wgsl:
    return wgsl(shader);
  case Language::godot:
    return godot(shader);
  case Language::glsl:
    break;
  }
  return glsl(shader, options);
}

} // namespace surfgrad::shadergen
