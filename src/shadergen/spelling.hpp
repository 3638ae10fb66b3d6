#pragma once

#include "shadergen/shadergen.hpp"

#include <string>
#include <string_view>

namespace surfgrad::shadergen {

/// Gives the name of a texture's sampler; asked only where a language has them apart.
using SamplerOf = std::function<std::string(std::string_view texture)>;

/// Common code in a language.
///
/// Common code is GLSL of few forms, so that the other languages can be spelled by rule:
///   struct NAME { TYPE member; ... };
///   TYPE function(TYPE parameter, ...) { statements }
///   TYPE name = expression;   TYPE name;   TYPE name[3];   name = expression;   name.x += expression;
///   if, else, while (...) {   for (int i = 0; i < n; ++i) {   return expression;   // comments
/// Statements of if, else and loops stand in braces; parameters are never assigned to; constructors of
/// vectors name every component. In expressions these calls stand for what the languages say differently:
///   select(condition, a, b)           a where the condition holds, else b; both may be evaluated
///   product(matrix, vector)           matrix times column vector
///   matrix_of_rows(a, b, c, d)        mat4 with these rows
///   sample_grad(texture, st, dx, dy)  sample_lod(texture, st, lod)
///   fetch(texture, x, y)              texel of level 0, by integers
///   texture_size(texture)             of level 0, as vec2
///   sample_cube_grad(texture, direction, dx, dy)
///   name__overload(...)               one of the library functions that share a name: WGSL knows them apart
[[nodiscard]] std::string spelled(std::string_view common, Language language, const SamplerOf& sampler_of);

/// The spelling of a type.
[[nodiscard]] std::string_view type_in(Language language, std::string_view type);

/// The code with every identifier that begins with `stack_` or `Stack` given another beginning.
[[nodiscard]] std::string renamed(std::string_view code, std::string_view name, std::string_view type_name);

} // namespace surfgrad::shadergen
