#include "gpu/shader.hpp"

#include <shaderc/shaderc.hpp>

#include <stdexcept>

namespace surfgrad::gpu {
namespace {

shaderc_shader_kind kind_of(ShaderStage stage) {
  switch (stage) {
  case ShaderStage::vertex:
    return shaderc_vertex_shader;
  case ShaderStage::fragment:
    return shaderc_fragment_shader;
  case ShaderStage::compute:
    break;
  }
  return shaderc_compute_shader;
}

} // namespace

Spirv compile(const ShaderSource& source) {
  shaderc::CompileOptions options;
  options.SetTargetEnvironment(shaderc_target_env_vulkan, shaderc_env_version_vulkan_1_1);
  options.SetSourceLanguage(source.language == ShaderLanguage::hlsl ? shaderc_source_language_hlsl
                                                                    : shaderc_source_language_glsl);
  options.SetWarningsAsErrors();
  for (const auto& [name, value] : source.definitions) options.AddMacroDefinition(name, value);
  // One for all: the language's own functions are read when the first comes and forgotten with the last.
  // Threads may share it.
  static const shaderc::Compiler compiler;
  const shaderc::SpvCompilationResult result = compiler.CompileGlslToSpv(
      source.text.data(), source.text.size(), kind_of(source.stage), source.name.c_str(), "main", options);
  if (result.GetCompilationStatus() != shaderc_compilation_status_success)
    throw std::runtime_error("shader does not compile: " + result.GetErrorMessage());
  return {result.cbegin(), result.cend()};
}

} // namespace surfgrad::gpu
