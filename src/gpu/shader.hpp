#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace surfgrad::gpu {

/// A shader module's words.
using Spirv = std::vector<std::uint32_t>;

enum class ShaderLanguage { glsl, hlsl };
enum class ShaderStage { vertex, fragment, compute };

struct ShaderSource {
  std::string text{};
  std::string name{"shader"}; ///< for messages: "name:line: ..."
  ShaderLanguage language = ShaderLanguage::glsl;
  ShaderStage stage = ShaderStage::compute;
  std::vector<std::pair<std::string, std::string>> definitions{}; ///< of the preprocessor
};

/// Compiles a shader's function main for Vulkan 1.1.
///
/// throws  std::runtime_error with the compiler's messages: shaders are this program's own, a fault in
///         one is never the user's
[[nodiscard]] Spirv compile(const ShaderSource& source);

} // namespace surfgrad::gpu
