#pragma once

/// An exported function within a program of its own: a compute shader that reads a buffer of floats and
/// writes another. It is what a user writes around the function, in every language.

#include "gpu/shader.hpp"
#include "shadergen/shadergen.hpp"

#include <string>
#include <vector>

namespace surfgrad::shadergen::test {

struct Program {
  static constexpr int group = 64; ///< invocations run together: their number is a multiple of it
  static constexpr int input_binding = 40, output_binding = 41;

  std::string text{};
  Language language = Language::glsl;
  int inputs = 0;  ///< floats an invocation reads
  int outputs = 0; ///< floats it writes
};

/// NAME_normal: reads the members of the surface one after the other (values_of), writes the normal and the
/// share of sunlight.
[[nodiscard]] Program normal_program(const Shader& shader);

/// NAME_displaced: reads position, normal and, with a map, st, dp_ds and dp_dt; writes position and normal.
[[nodiscard]] Program vertex_program(const Shader& shader, bool by_map);

/// What HLSL's spaces of registers, which overlap in Vulkan, are moved by.
inline constexpr int hlsl_texture_shift = 1, hlsl_sampler_shift = 20;

/// The programs as SPIR-V: GLSL and Godot by shaderc, HLSL by glslang, WGSL by naga. Godot's language is read
/// as GLSL, its uniforms as constants of the values that they are given.
///
/// throws  std::runtime_error with a text that is refused
[[nodiscard]] std::vector<gpu::Spirv> spirv_of(const std::vector<const Program*>& programs);

} // namespace surfgrad::shadergen::test
