#include "shadergen/bumps.hpp"
#include "shadergen/layers/influence.hpp"
#include "shadergen/layers/layers.hpp"
#include "shadergen/planes.hpp"
#include "shadergen/space.hpp"

#include <array>

namespace surfgrad::shadergen {
namespace {

stack::Content bump_content(stack::TriplanarContent content) {
  switch (content) {
  case stack::TriplanarContent::derivative:
    return stack::Content::derivative;
  case stack::TriplanarContent::height:
    return stack::Content::height;
  case stack::TriplanarContent::normal:
  case stack::TriplanarContent::object_normal:
    break;
  }
  return stack::Content::normal;
}

/// The function of each plane's map; one serves all where there is one map.
template <class FunctionOf>
auto of_planes(const stack::TriplanarLayer& layer, const FunctionOf& function_of) {
  using Function = decltype(function_of(layer.files[0], "map"));
  if (layer.files.size() == 1) {
    const Function one = function_of(layer.files[0], "map");
    return std::array<Function, 3>{one, one, one};
  }
  return std::array<Function, 3>{function_of(layer.files[0], "map_x"), function_of(layer.files[1], "map_y"),
                                 function_of(layer.files[2], "map_z")};
}

} // namespace

void write(const stack::TriplanarLayer& layer, Generator& g) {
  const Influence influence = influence_of(g, layer.common);
  const bool world = layer.space == stack::Space::world;
  const std::string convention =
      convention_of(g, {layer.convention.handedness, layer.convention.origin, layer.convention.planes});
  const std::string sharpness =
      g.parameter("sharpness", "how abruptly one plane yields to the next", layer.sharpness);
  const std::string weights =
      g.value("weights", "vec3",
              fmt::format("surfgrad_triplanar_weights({}, {})", normal_in_space(g, world), sharpness));
  const Planes planes = planes_of(g, world, convention);
  if (layer.map.content == stack::TriplanarContent::object_normal) {
    const auto functions = of_planes(layer, [&](const stack::FileName& file, const char* what) {
      TextureBinding binding = binding_of(MapKind::directions, layer.map, file);
      binding.green = layer.map.green;
      return MapUse(g, layer.map, std::move(binding), what).direction_function();
    });
    std::string sum;
    for (std::size_t i = 0; i < 3; ++i) {
      const char axis = "xyz"[i];
      std::string v = fmt::format("{}({})", functions[i], planes.arguments(axis));
      if (!world)
        v = fmt::format("surfgrad_transform_normal({}, {})",
                        g.surface(SurfaceMember::Role::world_from_object), v);
      const std::string direction = g.value(fmt::format("direction_{}", axis), "vec3", v);
      g.degenerate(fmt::format("(0.0 < {}.{} && surfgrad_max_abs({}) == 0.0)", weights, axis, direction));
      sum += fmt::format("{}{}.{} * surfgrad_from_perturbed_normal({}.normal, {})", i > 0 ? " + " : "",
                         weights, axis, g.frame(), direction);
    }
    g.add(influence.weight, influence.scale, influence.mix, "(" + sum + ")");
    return;
  }
  const auto functions = of_planes(layer, [&](const stack::FileName& file, const char* what) {
    return bump_function(g, layer.map, bump_content(layer.map.content), file, what);
  });
  std::array<std::string, 3> derivatives;
  std::string variance;
  for (std::size_t i = 0; i < 3; ++i) {
    const char axis = "xyz"[i];
    const BumpFunction& function = functions[i];
    const std::string bump =
        g.value(fmt::format("{}_{}", function.tells_variance ? "bump" : "derivative", axis), function.type(),
                fmt::format("{}({})", function.name, planes.arguments(axis)));
    derivatives[i] = function.derivative(bump);
    if (function.tells_variance)
      variance += fmt::format("{}stack_square({}.{}) * {}", variance.empty() ? "" : " + ", weights, axis,
                              function.variance(bump));
  }
  const std::string gradient =
      g.value("gradient", "vec3",
              fmt::format("surfgrad_triplanar_gradient({}, {}, {}, {}, {})", weights, derivatives[0],
                          derivatives[1], derivatives[2], convention));
  g.add(influence.weight, influence.scale, influence.mix, from_gradient_in_space(g, world, gradient),
        variance.empty() ? "" : "(" + variance + ")");
}

} // namespace surfgrad::shadergen
