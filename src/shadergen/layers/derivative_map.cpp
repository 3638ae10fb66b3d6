#include "shadergen/layers/basis.hpp"
#include "shadergen/layers/influence.hpp"
#include "shadergen/layers/layers.hpp"

namespace surfgrad::shadergen {

void write(const stack::DerivativeMapLayer& layer, Generator& generator) {
  const Influence influence = influence_of(generator, layer.common);
  TextureBinding binding = binding_of(MapKind::derivatives, layer.map);
  binding.code = layer.code;
  binding.green = layer.map.green;
  const MapUse map(generator, layer.map, std::move(binding), "map");
  const std::string basis = basis_of(generator, layer.map.uv, layer.basis == stack::Basis::derived);
  generator.add_slope(
      influence.weight, influence.scale, influence.mix, basis,
      fmt::format("{}({})", map.slope_function(), coordinate_arguments(generator, layer.map.uv)));
}

} // namespace surfgrad::shadergen
