#pragma once

/// Which functions a compiled shader holds, whom each calls, and which operations it has that Vulkan does not
/// round correctly: what a shader runs, told by its compiler rather than by its text.

#include "gpu/shader.hpp"

#include <map>
#include <set>
#include <string>

namespace surfgrad::test {

/// Operations that Vulkan lets err by more than half a unit in the last place.
enum class Loose {
  division,     ///< 2.5 units
  inverse_root, ///< inversesqrt, normalize: 2 units
  root,         ///< sqrt, length: those of an inverse root's reciprocal
  power,        ///< pow, exp2, log2: bounds of their own
};

struct ShaderFunction {
  std::set<std::string> calls;
  std::set<Loose> operations;
};

/// By signature: "name(type, type)", types in GLSL's words. Functions that no entry point reaches are left
/// out.
using ShaderFunctions = std::map<std::string, ShaderFunction>;

[[nodiscard]] ShaderFunctions functions_of(const gpu::Spirv& module);

/// The operations of a function and of all that it calls.
///
/// name  without parameters, of the only function of this name
[[nodiscard]] std::set<Loose> operations_under(const ShaderFunctions& functions, const std::string& name);

} // namespace surfgrad::test
