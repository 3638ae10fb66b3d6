#include "shadergen/bumps.hpp"
#include "shadergen/layers/influence.hpp"
#include "shadergen/layers/layers.hpp"
#include "shadergen/planes.hpp"
#include "shadergen/space.hpp"

namespace surfgrad::shadergen {

void write(const stack::PlanarLayer& layer, Generator& g) {
  const Influence influence = influence_of(g, layer.common);
  const bool world = layer.space == stack::Space::world;
  const BumpFunction function = bump_function(g, layer.map, layer.map.content, layer.file, "map");
  // An image appears the right way round to whom looks against the axis.
  const std::string convention = convention_of(g, {.handedness = Handedness::right});
  const char axis = "xyz"[static_cast<int>(layer.axis)];
  const std::string bump =
      g.value(function.tells_variance ? "bump" : "derivative", function.type(),
              fmt::format("{}({})", function.name, planes_of(g, world, convention).arguments(axis)));
  const std::string gradient =
      fmt::format("surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_{}, {}, {})",
                  "XYZ"[static_cast<int>(layer.axis)], function.derivative(bump), convention);
  g.add(influence.weight, influence.scale, influence.mix, from_gradient_in_space(g, world, gradient),
        function.variance(bump));
}

} // namespace surfgrad::shadergen
