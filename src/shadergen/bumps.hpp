#pragma once

#include "shadergen/maps.hpp"

namespace surfgrad::shadergen {

/// A projected image of bumps (engine/bump_map.hpp): a function of (vec2 st, vec2 dst_dx, vec2 dst_dy) that
/// gives the derivative along the coordinates, slopes or changes of height; its name.
///
/// what  names the texture after the layer: `map`, `map_x`
[[nodiscard]] std::string bump_function(Generator& generator, const stack::BumpCodes& bumps,
                                        stack::Content content, const stack::FileName& file,
                                        const std::string& what);

} // namespace surfgrad::shadergen
