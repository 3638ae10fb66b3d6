#include "shadergen/layers/influence.hpp"
#include "shadergen/layers/layers.hpp"

namespace surfgrad::shadergen {

void write(const stack::ObjectNormalMapLayer& layer, Generator& generator) {
  const Influence influence = influence_of(generator, layer.common);
  TextureBinding binding = binding_of(MapKind::directions, layer.map);
  binding.green = layer.map.green;
  const MapUse map(generator, layer.map, std::move(binding), "map");
  std::string v =
      fmt::format("{}({})", map.direction_function(), coordinate_arguments(generator, layer.map.uv));
  if (layer.space == stack::Space::object)
    v = fmt::format("surfgrad_transform_normal({}, {})",
                    generator.surface(SurfaceMember::Role::world_from_object), v);
  const std::string direction = generator.value("direction", "vec3", v);
  generator.degenerate(fmt::format("surfgrad_max_abs({}) == 0.0", direction));
  generator.add(influence.weight, influence.scale, influence.mix,
                fmt::format("surfgrad_from_perturbed_normal({}.normal, {})", generator.frame(), direction));
}

} // namespace surfgrad::shadergen
