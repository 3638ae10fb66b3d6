#include "conformance/languages.hpp"

#include "support/temporary_folder.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace surfgrad::test {
namespace {

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A row's call, $name as what reads it by the harness.
std::string statement_of(const Row& row, Language language) {
  std::string text = language == Language::wgsl ? wgsl_call(row) : row.call;
  for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$')) {
    std::size_t end = at + 1;
    while (end < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
      ++end;
    const Field& f = field(std::string_view(text).substr(at + 1, end - at - 1));
    text.replace(at, end - at, "in" + std::string(f.kind) + "(" + std::to_string(f.offset) + "u)");
  }
  return text + ";";
}

/// What a program makes of texts.
///
/// command  with every text's path behind it, then `into` and that of its result
std::vector<gpu::Spirv> spirv_by(std::string command, const char* into, std::span<const std::string> texts) {
  const TemporaryFolder folder;
  std::vector<std::string> results;
  for (const std::string& text : texts) {
    const std::string number = std::to_string(results.size());
    results.push_back((folder.path() / (number + ".spv")).string());
    for (const std::string& word : {folder.write(number, text).string(), into + results.back()}) {
      command += ' ';
      command += word;
    }
  }
  if (std::system(command.c_str()) != 0) throw std::runtime_error("a shader does not compile: " + command);
  std::vector<gpu::Spirv> modules;
  for (const std::string& result : results) {
    const std::string bytes = read(result);
    modules.emplace_back(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(modules.back().data(), bytes.data(), modules.back().size() * sizeof(std::uint32_t));
  }
  return modules;
}

} // namespace

const char* name_of(Language language) {
  switch (language) {
  case Language::glsl:
    return "glsl";
  case Language::hlsl:
    return "hlsl";
  case Language::wgsl:
    break;
  }
  return "wgsl";
}

std::string library_text(Language language) {
  return read(std::string(SURFGRAD_SOURCE_DIR "/shaders/surfgrad.") + name_of(language));
}

namespace {

/// The library, the harness and every row as a function.
std::string rows_text(Language language, std::span<const Row* const> rows) {
  std::ostringstream text;
  text << library_text(language)
       << read(std::string(SURFGRAD_SOURCE_DIR "/tests/conformance/harness.") + name_of(language));
  for (std::size_t i = 0; i < rows.size(); ++i)
    text << (language == Language::wgsl ? "fn" : "void") << " row_" << i << "() { "
         << statement_of(*rows[i], language) << " }\n";
  return text.str();
}

} // namespace

std::string compute_text(Language language, std::span<const Row* const> rows) {
  std::ostringstream text;
  if (language == Language::glsl) text << "#version 450\nlayout(local_size_x = 64) in;\n";
  text << rows_text(language, rows);
  switch (language) {
  case Language::glsl:
    text << "void main() {\n  uint group = gl_WorkGroupID.x;\n  uint lane = gl_LocalInvocationID.x;\n";
    break;
  case Language::hlsl:
    text << "[numthreads(64, 1, 1)]\nvoid main(uint3 groups : SV_GroupID, uint3 lanes : SV_GroupThreadID) {\n"
            "  uint group = groups.x;\n  uint lane = lanes.x;\n";
    break;
  case Language::wgsl:
    text << "@compute @workgroup_size(64)\nfn main(@builtin(workgroup_id) groups: vec3<u32>, "
            "@builtin(local_invocation_id) lanes: vec3<u32>) {\n"
            "  let group = groups.x;\n  let lane = lanes.x;\n";
    break;
  }
  const bool wgsl = language == Language::wgsl;
  text << "  first_input = (work[2u * group + 1u] + lane) * " << shader_input_count<float> << "u;\n"
       << "  first_result = (group * 64u + lane) * " << row_results << "u;\n"
       << (wgsl ? "  switch work[2u * group] {\n" : "  switch (int(work[2u * group])) {\n");
  for (std::size_t i = 0; i < rows.size(); ++i)
    text << "  case " << i << (wgsl ? "u" : "") << ": { row_" << i << (wgsl ? "(); }\n" : "(); break; }\n");
  if (wgsl) text << "  default: { }\n";
  text << "  }\n}\n";
  return text.str();
}

std::string fragment_text(Language language, std::span<const Row* const> rows) {
  std::ostringstream text;
  if (language == Language::glsl) text << "#version 450\n";
  if (language != Language::wgsl) text << "#define SURFGRAD_FRAGMENT\n";
  text << rows_text(language, rows);
  switch (language) {
  case Language::glsl:
    text << "void main() {\n  uvec2 at = uvec2(gl_FragCoord.xy);\n";
    break;
  case Language::hlsl:
    text << "void main(float4 coordinate : SV_Position) {\n  uint2 at = uint2(coordinate.xy);\n";
    break;
  case Language::wgsl:
    text << "@fragment\nfn main(@builtin(position) coordinate: vec4f) {\n  let at = vec2u(coordinate.xy);\n";
    break;
  }
  text << (language == Language::wgsl ? "  let" : "  uint") << " pixel = at.y * " << fragment_width
       << "u + at.x;\n  first_input = pixel * " << shader_input_count<float> << "u;\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text << "  first_result = (" << fragment_width * fragment_height * i << "u + pixel) * " << row_results
         << "u;\n  row_" << i << "();\n";
  text << "}\n";
  return text.str();
}

gpu::Spirv compiled(Language language, gpu::ShaderStage stage, const std::string& text) {
  return compiled(language, stage, std::span(&text, 1)).front();
}

std::vector<gpu::Spirv> compiled(Language language, gpu::ShaderStage stage,
                                 std::span<const std::string> texts) {
  // There is no compiler for WGSL among Debian's packages: naga, in Node.js.
  if (language == Language::wgsl)
    return spirv_by(SURFGRAD_NODE " " SURFGRAD_SOURCE_DIR "/tests/conformance/wgsl.mjs spirv", "", texts);
  std::vector<gpu::Spirv> modules;
  for (const std::string& text : texts) {
    gpu::ShaderSource source;
    source.text = text;
    source.name = std::string("conformance.") + name_of(language);
    source.language = language == Language::hlsl ? gpu::ShaderLanguage::hlsl : gpu::ShaderLanguage::glsl;
    source.stage = stage;
    modules.push_back(gpu::compile(source));
  }
  return modules;
}

gpu::Spirv compiled_function_by_function(Language language, gpu::ShaderStage stage, const std::string& text) {
  if (language != Language::hlsl) return compiled(language, stage, text);
  return spirv_by(
             std::string(SURFGRAD_GLSLANG_VALIDATOR " -V -D -Od --quiet --target-env vulkan1.1 -e main -S ") +
                 (stage == gpu::ShaderStage::fragment ? "frag" : "comp"),
             "-o ", std::span(&text, 1))
      .front();
}

} // namespace surfgrad::test
