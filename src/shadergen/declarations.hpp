#pragma once

#include "shadergen/shadergen.hpp"

#include <string>

namespace surfgrad::shadergen {

/// Numbers the bindings of a shader for its language: the block, the decals, textures and samplers.
///
/// throws  InputError where the language has fewer
void number_bindings(Shader& shader, const Options& options);

/// Declarations of the uniform block, the decals and the textures in the shader's language.
///
/// code  what uses them: helpers that it does not call are left out
[[nodiscard]] std::string declarations(const Shader& shader, const Options& options, std::string_view code);

} // namespace surfgrad::shadergen
