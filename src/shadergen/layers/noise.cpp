#include "diagnostic/error.hpp"
#include "shadergen/layers/influence.hpp"
#include "shadergen/layers/layers.hpp"
#include "shadergen/noise_function.hpp"
#include "shadergen/space.hpp"

namespace surfgrad::shadergen {

void write(const stack::NoiseLayer& layer, Generator& generator) {
  if (layer.custom)
    throw InputError({.file = generator.options().document,
                      .line = layer.common.line,
                      .place = layer.common.key,
                      .problem = "is a function of the program's own, written in C++",
                      .remedy = "a shader needs a \"function\" of the stack format"});
  const bool world = layer.space == stack::Space::world;
  // Neither method is linear in the gradient: the scale applies before them.
  const std::string scale = generator.parameter("scale", "height of the function", layer.common.scale);
  const Influence influence = influence_of(generator, layer.common, false);
  const SpacePoint at = in_space(generator, world);
  // The longer side of the pixel: along the shorter one the function loses detail before it must.
  const std::string width =
      generator.shared("width", "float", fmt::format("max(length({}), length({}))", at.dp_dx, at.dp_dy));
  const std::string function = noise_function(generator, layer.noise, "noise");
  const std::string gradient = generator.value(
      "gradient", "vec3", fmt::format("{} * {}({}, {}).gradient", scale, function, at.position, width));
  std::string g;
  if (layer.method == stack::NoiseMethod::perlin1985) {
    const std::string normal = generator.frame() + ".normal";
    const std::string in_world =
        world ? gradient
              : fmt::format("stack_object_gradient_in_world({}, {}, {}, {})",
                            generator.surface(SurfaceMember::Role::world_from_object),
                            generator.surface(SurfaceMember::Role::object_from_world), normal, gradient);
    g = fmt::format("surfgrad_from_perturbed_normal({}, {} - {})", normal, normal, in_world);
  } else {
    g = from_gradient_in_space(generator, world, gradient);
  }
  generator.add(influence.weight, influence.scale, influence.mix, g);
}

} // namespace surfgrad::shadergen
