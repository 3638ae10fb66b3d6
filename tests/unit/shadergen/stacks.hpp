#pragma once

/// Stacks to generate shaders of.

#include "shadergen/shadergen.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::shadergen::test {

struct NamedStack {
  std::string name; ///< fit for Options::name
  std::vector<stack::Layer> layers{};
  stack::BackFaces back_faces = stack::BackFaces::flip;
  std::optional<stack::Displace> displace{};
};

/// A stack document.
[[nodiscard]] NamedStack parsed(const std::string& name, std::string_view document);

/// The smallest stack there is to speak of.
[[nodiscard]] NamedStack one_normal_map();
/// Two passes: slopes on two UV sets, a mask, a noise.
[[nodiscard]] NamedStack two_passes();
/// Every kind of layer, with every key that changes the code.
[[nodiscard]] std::vector<NamedStack> every_kind();

[[nodiscard]] Options options_of(const NamedStack& stack, Language language);

/// Godot's code as GLSL ES 3.00: its uniforms without their hints and values.
[[nodiscard]] std::string as_glsl_es(const std::string& godot);

inline constexpr Language every_language[] = {Language::glsl, Language::hlsl, Language::wgsl,
                                              Language::godot};

} // namespace surfgrad::shadergen::test
