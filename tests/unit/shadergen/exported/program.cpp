#include "exported/program.hpp"

#include "exported/sample.hpp"
#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>

namespace surfgrad::shadergen::test {
namespace {

/// A value of a type as it is read from the buffer, `count` floats from `first` on.
std::string reading(Language language, const std::string& type, int first, int count) {
  const auto one = [&](int k) { return fmt::format("data_in[base + {}]", first + k); };
  if (type == "bool") return one(0) + " > 0.5";
  if (count == 1) return one(0);
  // HLSL's constructors of matrices take rows, the buffer has columns.
  const int side = language != Language::hlsl ? 0 : count == 9 ? 3 : count == 16 ? 4 : 0;
  std::vector<std::string> values;
  for (int k = 0; k < count; ++k) values.push_back(one(side > 0 ? k % side * side + k / side : k));
  return fmt::format("{}({})", type, fmt::join(values, ", "));
}

/// The whole text: `body` computes the results from what lies in data_in from `base` on.
std::string around(const Shader& shader, const Program& program, const std::string& body,
                   const std::vector<std::string>& results) {
  std::string writes;
  for (std::size_t k = 0; k < results.size(); ++k)
    writes += fmt::format("  data_out[{} * i + {}] = {};\n", program.outputs, k, results[k]);
  switch (shader.language) {
  case Language::wgsl:
    return shader.source +
           fmt::format("@group(0) @binding({}) var<storage, read> data_in: array<f32>;\n"
                       "@group(0) @binding({}) var<storage, read_write> data_out: array<f32>;\n"
                       "@compute @workgroup_size({}) fn main(@builtin(global_invocation_id) id: vec3u) {{\n"
                       "  let i = i32(id.x);\n  let base = i * {};\n{}{}}}\n",
                       Program::input_binding, Program::output_binding, Program::group, program.inputs, body,
                       writes);
  case Language::hlsl:
    return shader.source + fmt::format("StructuredBuffer<float> data_in : register(t{});\n"
                                       "RWStructuredBuffer<float> data_out : register(u{});\n"
                                       "[numthreads({}, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {{\n"
                                       "  int i = int(id.x);\n  int base = i * {};\n{}{}}}\n",
                                       Program::input_binding - hlsl_texture_shift,
                                       Program::output_binding - hlsl_texture_shift, Program::group,
                                       program.inputs, body, writes);
  case Language::glsl:
  case Language::godot:
    break;
  }
  return "#version 450\n" + shader.source +
         fmt::format("layout(local_size_x = {}) in;\n"
                     "layout(std430, binding = {}) readonly buffer In {{ float data_in[]; }};\n"
                     "layout(std430, binding = {}) buffer Out {{ float data_out[]; }};\n"
                     "void main() {{\n"
                     "  int i = int(gl_GlobalInvocationID.x);\n  int base = i * {};\n{}{}}}\n",
                     Program::group, Program::input_binding, Program::output_binding, program.inputs, body,
                     writes);
}

std::string local(Language language, const std::string& type, const std::string& name,
                  const std::string& value) {
  return language == Language::wgsl ? fmt::format("  let {} = {};\n", name, value)
                                    : fmt::format("  {} {} = {};\n", type, name, value);
}

/// Godot's text as GLSL: its uniforms are its only words of its own. A number is the constant that it is
/// given as its value. Compute shaders lack derivatives: the function that takes them is there, and is not
/// called.
std::string glsl_of_godot(const Shader& shader, std::string text) {
  text = std::regex_replace(text, std::regex("\\bdFd[xy]\\("), "(");
  text = std::regex_replace(text, std::regex("\nuniform (float|vec2|vec4) (\\w+) = ([^;]*);"),
                            "\nconst $1 $2 = $3;");
  text = std::regex_replace(
      text, std::regex("\nuniform vec4 (\\w+\\[\\d+\\]);"),
      fmt::format("\nlayout(std140, binding = {}) uniform Decals {{ vec4 $1; }};", shader.decals_binding));
  for (const TextureBinding& t : shader.textures)
    text = std::regex_replace(text, std::regex("\nuniform (sampler2D|samplerCube) " + t.name + " : [^;]*;"),
                              fmt::format("\nlayout(binding = {}) uniform $1 {};", t.binding, t.name));
  return text;
}

gpu::Spirv words_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  gpu::Spirv words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), 4 * words.size());
  return words;
}

void run(const std::string& command, const std::string& what) {
  if (std::system((command + " > /dev/null").c_str()) != 0)
    throw std::runtime_error("does not compile: " + what);
}

} // namespace

Program normal_program(const Shader& shader) {
  Program program;
  program.language = shader.language;
  program.outputs = 4;
  const bool wgsl = shader.language == Language::wgsl;
  std::string body = wgsl ? fmt::format("  var s: {}Surface;\n", shader.type_name)
                          : fmt::format("  {}Surface s;\n", shader.type_name);
  for (const SurfaceMember& member : shader.surface) {
    const int count = static_cast<int>(values_of(member, {}, {}).size());
    body += fmt::format("  s.{} = {};\n", member.name,
                        reading(shader.language, member.type, program.inputs, count));
    program.inputs += count;
  }
  body += local(shader.language, shader.type_name + "Result", "r", shader.name + "_normal(s)");
  program.text =
      around(shader, program, body,
             {"r.normal.x", "r.normal.y", "r.normal.z", shader.has_sunlight ? "r.sunlight" : "1.0"});
  if (shader.language == Language::godot) program.text = glsl_of_godot(shader, program.text);
  return program;
}

Program vertex_program(const Shader& shader, bool by_map) {
  Program program;
  program.language = shader.language;
  program.outputs = 6;
  const bool wgsl = shader.language == Language::wgsl;
  const bool hlsl = shader.language == Language::hlsl;
  std::vector<std::string> arguments;
  const auto argument = [&](int count) {
    const std::string type = fmt::format("{}{}{}", hlsl ? "float" : "vec", count, wgsl ? "f" : "");
    arguments.push_back(reading(shader.language, type, program.inputs, count));
    program.inputs += count;
  };
  argument(3);
  argument(3);
  if (by_map)
    for (const int count : {2, 3, 3}) argument(count);
  const std::string body = local(shader.language, shader.type_name + "Vertex", "v",
                                 fmt::format("{}_displaced({})", shader.name, fmt::join(arguments, ", ")));
  program.text =
      around(shader, program, body,
             {"v.position.x", "v.position.y", "v.position.z", "v.normal.x", "v.normal.y", "v.normal.z"});
  if (shader.language == Language::godot) program.text = glsl_of_godot(shader, program.text);
  return program;
}

std::vector<gpu::Spirv> spirv_of(const std::vector<const Program*>& programs) {
  const surfgrad::test::TemporaryFolder folder;
  std::vector<gpu::Spirv> result(programs.size());
  std::string in_wgsl; // one run for all: the compiler takes longer to start than to compile
  const auto made = [&](std::size_t i) { return folder.path() / fmt::format("{}.spv", i); };
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const Program& program = *programs[i];
    if (program.language == Language::wgsl)
      in_wgsl += fmt::format(" {} {}", folder.write(fmt::format("{}.wgsl", i), program.text).string(),
                             made(i).string());
    else if (program.language != Language::hlsl)
      result[i] = gpu::compile({.text = program.text});
    else
      run(fmt::format("glslangValidator -V -D -S comp -e main --target-env vulkan1.1 --shift-texture-binding "
                      "{0} --shift-ssbo-binding {0} --shift-sampler-binding {1} {2} -o {3}",
                      hlsl_texture_shift, hlsl_sampler_shift,
                      folder.write(fmt::format("{}.hlsl", i), program.text).string(), made(i).string()),
          program.text);
  }
  if (!in_wgsl.empty())
    run("node " SURFGRAD_SOURCE_DIR "/tests/conformance/wgsl.mjs spirv" + in_wgsl, "WGSL, see above");
  for (std::size_t i = 0; i < programs.size(); ++i)
    if (result[i].empty()) result[i] = words_of(made(i));
  return result;
}

} // namespace surfgrad::shadergen::test
