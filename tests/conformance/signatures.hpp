#pragma once

/// The functions that the core and the shader libraries offer, by signature: "name(type, type)", without the
/// prefix surfgrad_ and with types in GLSL's words.

#include "conformance/languages.hpp"

#include <set>
#include <string>

namespace surfgrad::test {

using Signatures = std::set<std::string>;

/// As a library's text defines them at the start of a line, without those for its own use.
[[nodiscard]] Signatures signatures_of_library(Language language);

/// Macros of a library that stand for functions: they take arguments.
[[nodiscard]] std::set<std::string> macros_of_library(Language language);

/// What shaders have to offer for the functions of the core's headers: every overload, and every form that
/// leaves defaults out.
[[nodiscard]] Signatures signatures_of_core();

/// Forms of the core that leave out what shaders always write.
[[nodiscard]] const Signatures& spelt_out_in_shaders();

/// What shaders offer besides.
[[nodiscard]] const Signatures& shaders_own();

} // namespace surfgrad::test
