#pragma once

#include "shadergen/generator.hpp"

namespace surfgrad::shadergen {

/// The vertex stage: common code of StackVertex and stack_displaced, what they call put into the generator.
[[nodiscard]] std::string vertex_stage(Generator& generator, const stack::Displace& displace);

} // namespace surfgrad::shadergen
