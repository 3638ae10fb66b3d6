#pragma once

/// The shader compilers of the tests, as programs: glslang for GLSL and HLSL, Dawn and naga for WGSL.

#include <string>

namespace surfgrad::test {

/// What a compiler said; empty where it accepted the shader without a word.
struct Verdict {
  bool accepted = false;
  std::string messages{};
};

/// A file of shaders/, "surfgrad.glsl".
[[nodiscard]] std::string library(const std::string& name);

/// GLSL with its #version line; stage: vert, frag, comp. An ES version is parsed for OpenGL ES; a desktop
/// version is parsed for OpenGL and becomes SPIR-V for Vulkan 1.1, which is validated.
[[nodiscard]] Verdict compile_glsl(const std::string& text, const std::string& stage);

/// A GLSL file of the project, by its path there, that includes files of shaders/.
[[nodiscard]] Verdict compile_glsl_file(const std::string& file, const std::string& stage);

/// The same of a text, for Vulkan alone: parsing for OpenGL, glslang finds no includes.
[[nodiscard]] Verdict compile_glsl_with_includes(const std::string& text, const std::string& stage);

/// HLSL with a function main, that may include files of shaders/, by way of SPIR-V, which is validated.
[[nodiscard]] Verdict compile_hlsl(const std::string& text, const std::string& stage);

/// WGSL, uniformity included: both compilers must accept it.
[[nodiscard]] Verdict compile_wgsl(const std::string& text);

} // namespace surfgrad::test
