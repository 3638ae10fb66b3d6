#include "shadergen/layers/layers.hpp"
#include "shadergen/layers/slope_map.hpp"

namespace surfgrad::shadergen {

void write(const stack::DerivativeMapLayer& layer, Generator& generator) {
  TextureBinding binding = binding_of(MapKind::derivatives, layer.map);
  binding.code = layer.code;
  binding.green = layer.map.green;
  add_slope_map(generator, layer, std::move(binding));
}

} // namespace surfgrad::shadergen
