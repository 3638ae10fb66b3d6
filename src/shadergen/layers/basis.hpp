#pragma once

#include "shadergen/generator.hpp"

namespace surfgrad::shadergen {

/// The tangent frame of a texture coordinate in the pass, computed once: made in place, or the vertex frame.
[[nodiscard]] inline std::string basis_of(Generator& g, int uv, bool derived) {
  using Role = SurfaceMember::Role;
  constexpr const char* type = "SurfgradTangentFrame";
  std::string basis;
  if (g.tangents_alone()) return "tangents"; // stands for those of the surface: see Generator::resolved
  if (derived) {
    g.need_footprint();
    basis = g.shared(fmt::format("derived{}", uv), type,
                     fmt::format("surfgrad_tangent_basis({}, {}, {})", g.frame(), g.surface(Role::dst_dx, uv),
                                 g.surface(Role::dst_dy, uv)));
  } else {
    const std::string tangent = g.surface(Role::tangent, uv);
    const std::string vertex =
        fmt::format("surfgrad_mikktspace_basis({}, {}.xyz, {}.w)", g.surface(Role::normal), tangent, tangent);
    // Of a tangent along the normal nothing is left: no bump.
    basis = g.shared(fmt::format("basis{}", uv), type,
                     g.options().diagnostics ? fmt::format("stack_sound_basis({})", vertex) : vertex);
    if (!g.first_pass())
      basis = g.shared(fmt::format("basis{}", uv), type,
                       fmt::format("stack_rebased_basis({}, {})", g.frame(), basis));
  }
  if (g.options().diagnostics) g.degenerate_once(fmt::format("surfgrad_max_abs({}.bitangent) == 0.0", basis));
  return basis;
}

} // namespace surfgrad::shadergen
