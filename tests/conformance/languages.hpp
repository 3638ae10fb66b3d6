#pragma once

/// The shader libraries and the text of shaders that run their functions.

#include "conformance/rows.hpp"
#include "gpu/shader.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace surfgrad::test {

enum class Language { glsl, hlsl, wgsl };
inline constexpr Language languages[] = {Language::glsl, Language::hlsl, Language::wgsl};

[[nodiscard]] const char* name_of(Language language);

/// The library, as its file has it.
[[nodiscard]] std::string library_text(Language language);

/// What a workgroup runs: 64 cases of a row.
struct Work {
  std::uint32_t row;        ///< among those of the shader
  std::uint32_t first_case; ///< its inputs begin at first_case * shader_input_count
};

/// A compute shader over these rows. Workgroup g runs the work g; its cases' results begin at
/// (64 * g + lane) * row_results.
[[nodiscard]] std::string shader_text(Language language, std::span<const Row* const> rows);

[[nodiscard]] gpu::Spirv compiled(Language language, const std::string& text);

} // namespace surfgrad::test
