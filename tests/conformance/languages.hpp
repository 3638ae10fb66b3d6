#pragma once

/// The shader libraries and the text of shaders that run their functions.

#include "conformance/rows.hpp"
#include "gpu/shader.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

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

/// A compute shader over these rows, each a function row_0, row_1, ... Workgroup g runs the work g; its
/// cases' results begin at (64 * g + lane) * row_results.
[[nodiscard]] std::string compute_text(Language language, std::span<const Row* const> rows);

/// Pixels of what a fragment shader runs over.
inline constexpr std::uint32_t fragment_width = 64;
inline constexpr std::uint32_t fragment_height = 32;

/// A fragment shader over all of these rows. A pixel's inputs begin at its number * shader_input_count; the
/// results of row r at (fragment_width * fragment_height * r + number) * row_results.
[[nodiscard]] std::string fragment_text(Language language, std::span<const Row* const> rows);

[[nodiscard]] gpu::Spirv compiled(Language language, gpu::ShaderStage stage, const std::string& text);

/// Several at once: a compiler that is a program of its own is started once.
[[nodiscard]] std::vector<gpu::Spirv> compiled(Language language, gpu::ShaderStage stage,
                                               std::span<const std::string> texts);

/// The same with every function left whole: for HLSL, `compiled` puts them all into one.
[[nodiscard]] gpu::Spirv compiled_function_by_function(Language language, gpu::ShaderStage stage,
                                                       const std::string& text);

} // namespace surfgrad::test
