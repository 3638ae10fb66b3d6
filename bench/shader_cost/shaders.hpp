#pragma once

#include "gpu/shader.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::bench {

/// The fragment shaders of bench/shader_cost, by name and in order.
[[nodiscard]] std::vector<std::string> cost_shader_names();

/// A file of bench/shader_cost, compiled: `name` with its extension, .frag or .vert. Its #include lines name
/// files of the same folder or of shaders/.
///
/// throws  std::runtime_error where a file is missing or does not compile
[[nodiscard]] gpu::Spirv compiled_cost_shader(std::string_view file_name);

} // namespace surfgrad::bench
