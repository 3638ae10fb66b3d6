#pragma once

#include <string>
#include <string_view>

namespace surfgrad::shadergen {

/// Longest line of code that is written.
inline constexpr std::size_t most_columns = 110;

/// The code with longer lines broken at commas and operators. Comments and directives stay as they are.
[[nodiscard]] std::string with_line_breaks(std::string_view code);

} // namespace surfgrad::shadergen
