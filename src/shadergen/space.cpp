#include "shadergen/space.hpp"

namespace surfgrad::shadergen {

using Role = SurfaceMember::Role;

SpacePoint in_space(Generator& g, bool world) {
  const std::string dx = g.surface(Role::dp_dx), dy = g.surface(Role::dp_dy);
  if (world) return {g.surface(Role::world_position), dx, dy};
  const std::string inverse = g.surface(Role::object_from_world);
  if (g.options().diagnostics) g.degenerate_once(fmt::format("stack_is_zero({})", inverse));
  return {g.surface(Role::object_position),
          g.shared("object_dp_dx", "vec3", fmt::format("product({}, {})", inverse, dx)),
          g.shared("object_dp_dy", "vec3", fmt::format("product({}, {})", inverse, dy))};
}

std::string normal_in_space(Generator& g, bool world) {
  const std::string normal = g.frame() + ".normal";
  if (world) return normal;
  return g.shared("object_normal", "vec3",
                  fmt::format("surfgrad_normalize_or_zero(product(transpose({}), {}))",
                              g.surface(Role::world_from_object), normal));
}

std::string from_gradient_in_space(Generator& g, bool world, const std::string& gradient) {
  const std::string normal = g.frame() + ".normal";
  if (world) return fmt::format("surfgrad_from_volume_gradient({}, {})", normal, gradient);
  return fmt::format("stack_from_object_gradient({}, {}, {}, {})", g.surface(Role::world_from_object),
                     g.surface(Role::object_from_world), normal, gradient);
}

} // namespace surfgrad::shadergen
