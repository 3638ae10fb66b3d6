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

/// By naga, in Node.js: there is no compiler for WGSL among Debian's packages.
gpu::Spirv spirv_of_wgsl(const std::string& text) {
  const TemporaryFolder folder;
  const std::string from = folder.write("shader.wgsl", text).string();
  const std::string to = (folder.path() / "shader.spv").string();
  const std::string command =
      SURFGRAD_NODE " " SURFGRAD_SOURCE_DIR "/tests/conformance/wgsl.mjs spirv " + from + " " + to;
  if (std::system(command.c_str()) != 0) throw std::runtime_error("naga refuses the shader");
  const std::string bytes = read(to);
  gpu::Spirv words(bytes.size() / sizeof(std::uint32_t));
  std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
  return words;
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

std::string shader_text(Language language, std::span<const Row* const> rows) {
  std::ostringstream text;
  if (language == Language::glsl) text << "#version 450\n";
  text << library_text(language)
       << read(std::string(SURFGRAD_SOURCE_DIR "/tests/conformance/harness.") + name_of(language));
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
    text << "  case " << i << (wgsl ? "u" : "") << ": { " << statement_of(*rows[i], language)
         << (wgsl ? " }\n" : " break; }\n");
  if (wgsl) text << "  default: { }\n";
  text << "  }\n}\n";
  return text.str();
}

gpu::Spirv compiled(Language language, const std::string& text) {
  if (language == Language::wgsl) return spirv_of_wgsl(text);
  gpu::ShaderSource source;
  source.text = text;
  source.name = std::string("conformance.") + name_of(language);
  source.language = language == Language::hlsl ? gpu::ShaderLanguage::hlsl : gpu::ShaderLanguage::glsl;
  return gpu::compile(source);
}

} // namespace surfgrad::test
