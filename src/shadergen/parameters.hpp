#pragma once

#include "shadergen/shadergen.hpp"

namespace surfgrad::shadergen {

/// Adds a member to the uniform block.
///
/// Members lie where std140 has them. HLSL packs more tightly; members that only fill the block make all
/// languages agree.
void add_parameter(Shader& shader, std::string name, Parameter::Type type, std::string meaning,
                   std::vector<double> value);

/// A member of the block, or what only fills it.
struct BlockMember {
  std::string_view type; ///< in common code
  std::string name;
  std::string meaning;
};

/// The block's members in order, with unused ones where a language would close a gap that another leaves.
[[nodiscard]] std::vector<BlockMember> block_members(const Shader& shader);

/// What the stack says, as the block holds it: whole vec4s.
[[nodiscard]] std::vector<std::byte> block_data(const Shader& shader);

} // namespace surfgrad::shadergen
