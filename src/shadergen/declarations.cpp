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

std::string glsl_bindings(const Shader& shader) {
  std::string text = "// OpenGL ES gives its bindings in the program; other numbers: define these before.\n"
                     "#ifndef SURFGRAD_BINDING\n"
                     "#ifdef GL_ES\n"
                     "#define SURFGRAD_BINDING(n)\n"
                     "#define SURFGRAD_TEXTURE(n) uniform highp\n"
                     "#else\n"
                     "#define SURFGRAD_BINDING(n) , binding = n\n"
                     "#define SURFGRAD_TEXTURE(n) layout(binding = n) uniform\n"
                     "#endif\n"
                     "#endif\n\n";
  const auto number = [&](int binding) {
    return shader.group > 0 ? fmt::format("SURFGRAD_BINDING_IN({}, {})", shader.group, binding)
                            : fmt::format("SURFGRAD_BINDING({})", binding);
  };
  const auto texture = [&](int binding) {
    return shader.group > 0 ? fmt::format("SURFGRAD_TEXTURE_IN({}, {})", shader.group, binding)
                            : fmt::format("SURFGRAD_TEXTURE({})", binding);
  };
  if (shader.group > 0)
    text += "// Only Vulkan has sets.\n"
            "#ifndef SURFGRAD_BINDING_IN\n"
            "#ifdef VULKAN\n"
            "#define SURFGRAD_BINDING_IN(g, n) , set = g, binding = n\n"
            "#define SURFGRAD_TEXTURE_IN(g, n) layout(set = g, binding = n) uniform\n"
            "#else\n"
            "#define SURFGRAD_BINDING_IN(g, n) SURFGRAD_BINDING(n)\n"
            "#define SURFGRAD_TEXTURE_IN(g, n) SURFGRAD_TEXTURE(n)\n"
            "#endif\n"
            "#endif\n\n";
  if (!shader.parameters.empty())
    text += fmt::format("layout(std140 {}) uniform StackParameters {{\n{}}} stack_parameters;\n\n",
                        number(shader.parameters_binding), member_lines(shader));
  if (shader.decal_count > 0 && shader.decals_in_block)
    text += fmt::format("layout(std140 {}) uniform StackDecals {{ vec4 stack_decal_data[{}]; }};\n",
                        number(shader.decals_binding), vec4s_a_decal * shader.decal_count);
  if (shader.decal_count > 0 && !shader.decals_in_block)
    text += fmt::format("#ifdef GL_ES\n#error \"This stack has {} decals; GLSL ES takes {}.\"\n#endif\n"
                        "layout(std430 {}) readonly buffer StackDecals {{ vec4 stack_decal_data[]; }};\n",
                        shader.decal_count, most_decals_es, number(shader.decals_binding));
  for (const TextureBinding& t : shader.textures)
    text += fmt::format("{} {} {};\n", texture(t.binding),
                        t.kind == MapKind::cube ? "samplerCube" : "sampler2D", t.name);
  return text;
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
      text += fmt::format("layout(std430, set = 0, binding = {}) readonly buffer StackMaps {{ uint "
                          "stack_maps[]; }};\n\n",
                          ExactLayout::maps);
    for (const TextureBinding& t : shader.textures)
      if (t.sampled)
        text += fmt::format("layout(set = 0, binding = {}) uniform sampler2D {};\n",
                            ExactLayout::textures + t.binding, t.name);
  } else {
    text += glsl_bindings(shader);
  }
  if (shader.decal_count > 0) text += "vec4 stack_decals(int i) { return stack_decal_data[i]; }\n";
  return text + "\n";
}

std::string hlsl(const Shader& shader, std::string_view code) {
  std::string text;
  const auto at = [&](char kind, int number) {
    return shader.group > 0 ? fmt::format("register({}{}, space{})", kind, number, shader.group)
                            : fmt::format("register({}{})", kind, number);
  };
  if (!shader.parameters.empty())
    text += fmt::format("struct StackParameters {{\n{}}};\n"
                        "cbuffer StackBlock : {} {{ StackParameters stack_parameters; }};\n\n",
                        member_lines(shader), at('b', shader.parameters_binding));
  if (shader.decal_count > 0)
    text += fmt::format("StructuredBuffer<float4> stack_decal_data : {};\n"
                        "float4 stack_decals(int i) {{ return stack_decal_data[i]; }}\n",
                        at('t', shader.decals_binding));
  std::map<int, std::string> samplers;
  for (const TextureBinding& t : shader.textures) {
    text += fmt::format("{}<float4> {} : {};\n", t.kind == MapKind::cube ? "TextureCube" : "Texture2D",
                        t.name, at('t', t.binding));
    samplers[t.sampler_binding] = t.sampler;
  }
  for (const auto& [binding, name] : samplers)
    text += fmt::format("SamplerState {} : {};\n", name, at('s', binding));
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
  const auto at = [&](int binding) { return fmt::format("@group({}) @binding({})", shader.group, binding); };
  if (!shader.parameters.empty())
    text += fmt::format("struct StackParameters {{\n{}}}\n"
                        "{} var<uniform> stack_parameters: StackParameters;\n\n",
                        member_lines(shader), at(shader.parameters_binding));
  if (shader.decal_count > 0)
    text += fmt::format("{} var<storage, read> stack_decal_data: array<vec4f>;\n"
                        "fn stack_decals(i: i32) -> vec4f {{ return stack_decal_data[i]; }}\n",
                        at(shader.decals_binding));
  std::map<int, std::string> samplers;
  for (const TextureBinding& t : shader.textures) {
    text += fmt::format("{} var {}: texture_{}<f32>;\n", at(t.binding), t.name,
                        t.kind == MapKind::cube ? "cube" : "2d");
    samplers[t.sampler_binding] = t.sampler;
  }
  for (const auto& [binding, name] : samplers)
    text += fmt::format("{} var {}: sampler;\n", at(binding), name);
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

/// Registers of shader model 5.0 end; in a space of its own, which is 5.1's, a stack has any number.
void check_registers(const Shader& shader, const Options& options) {
  constexpr int buffers = 14, textures = 128, samplers = 16; // D3D11_COMMONSHADER_*_COUNT
  if (shader.language != Language::hlsl || shader.group > 0) return;
  const std::string remedy = "give a lower --first-binding, or a space by --group 1";
  const auto check = [&](const char* what, char kind, int number, int count) {
    if (number >= count)
      throw InputError({.file = options.document,
                        .problem = fmt::format("{} would be register {}{}; shader model 5.0 has {}0 to {}{}",
                                               what, kind, number, kind, kind, count - 1),
                        .remedy = remedy});
  };
  if (!shader.parameters.empty()) check("the block of parameters", 'b', shader.parameters_binding, buffers);
  if (shader.decal_count > 0) check("the buffer of decals", 't', shader.decals_binding, textures);
  for (const TextureBinding& t : shader.textures) {
    if (t.binding >= textures)
      refuse(
          t, options,
          fmt::format("has a texture at register t{}; shader model 5.0 ends at t{}", t.binding, textures - 1),
          remedy);
    if (t.sampler_binding >= samplers)
      refuse(t, options,
             fmt::format("has a sampler at register s{}; shader model 5.0 ends at s{}", t.sampler_binding,
                         samplers - 1),
             remedy);
  }
}

} // namespace

int most_textures(Language language) { return language == Language::hlsl ? 128 : 16; }

std::string exact_words(const Shader& shader, const std::vector<int>& blocks) {
  if (shader.textures.empty()) return {};
  const auto named = [&](const std::string& code) { return renamed(code, shader.name, shader.type_name); };
  const std::string declaration =
      fmt::format("layout(std430, set = 0, binding = {}) readonly buffer StackWords ", ExactLayout::words);
  const int last = blocks.empty() ? 0 : *std::max_element(blocks.begin(), blocks.end());
  if (last == 0)
    return named(declaration + "{ uint stack_words[]; };\n"
                               "int stack_block_of(int map) { return 0; }\n"
                               "uint stack_word(int block, uint at) { return stack_words[at]; }\n");
  // Not every device takes an index into an array of buffers that is no constant. What is one after functions
  // have been inlined leaves one of the reads.
  std::string chosen, reads;
  for (std::size_t map = 0; map < blocks.size(); ++map)
    if (blocks[map] > 0) chosen += fmt::format("  if (map == {}) block = {};\n", map, blocks[map]);
  for (int k = 0; k <= last; ++k)
    reads +=
        fmt::format("  {}word = stack_words[{}].words[at];\n",
                    k == last ? "else " : fmt::format("{}if (block == {}) ", k > 0 ? "else " : "", k), k);
  return named(declaration + fmt::format("{{ uint words[]; }} stack_words[{}];\n"
                                         "int stack_block_of(int map) {{\n"
                                         "  int block = 0;\n{}"
                                         "  return block;\n"
                                         "}}\n"
                                         "uint stack_word(int block, uint at) {{\n"
                                         "  uint word;\n{}"
                                         "  return word;\n"
                                         "}}\n",
                                         last + 1, chosen, reads));
}

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
  if (shader.language != Language::godot) shader.group = options.group;
  shader.parameters_binding = options.first_binding;
  int next = options.first_binding + (one_namespace && !shader.parameters.empty() ? 1 : 0);
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
    t.sampler_binding = number + (shader.language == Language::hlsl ? options.first_binding : 0);
  }
  if (shader.language == Language::wgsl)
    for (TextureBinding& t : shader.textures) t.sampler_binding += next;
  check_registers(shader, options);
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
