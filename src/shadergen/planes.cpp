#include "shadergen/planes.hpp"

#include "shadergen/space.hpp"

namespace surfgrad::shadergen {

std::string convention_of(Generator& generator, const TriplanarConvention& c) {
  const std::string function = generator.function(
      "stack_convention", fmt::format("SurfgradTriplanarConvention @() {{\n"
                                      "  SurfgradTriplanarConvention convention;\n"
                                      "  convention.handedness = SURFGRAD_HANDEDNESS_{};\n"
                                      "  convention.origin = SURFGRAD_TEXTURE_ORIGIN_{};\n"
                                      "  convention.planes = SURFGRAD_TRIPLANAR_PLANES_{};\n"
                                      "  return convention;\n"
                                      "}}\n",
                                      c.handedness == Handedness::right ? "RIGHT" : "LEFT",
                                      c.origin == TextureOrigin::lower_left ? "LOWER_LEFT" : "UPPER_LEFT",
                                      c.planes == TriplanarPlanes::mikkelsen ? "MIKKELSEN" : "GOLUBEV"));
  return function + "()";
}

Planes planes_of(Generator& g, bool world, const std::string& convention) {
  const SpacePoint at = in_space(g, world);
  const auto on_planes = [&](const char* name, const std::string& v) {
    return g.shared(name, "SurfgradTriplanarCoordinates",
                    fmt::format("surfgrad_triplanar_coordinates({}, {})", v, convention));
  };
  // The coordinates are linear in the position: what they make of its derivatives are theirs.
  return {on_planes("planes", at.position), on_planes("planes_dx", at.dp_dx),
          on_planes("planes_dy", at.dp_dy)};
}

} // namespace surfgrad::shadergen
