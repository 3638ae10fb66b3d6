#include "shadergen/layers/layers.hpp"
#include "shadergen/layers/slope_map.hpp"

namespace surfgrad::shadergen {

void write(const stack::NormalMapLayer& layer, Generator& generator) {
  TextureBinding binding =
      binding_of(layer.map.filter == stack::Filter::normal ? MapKind::normals : MapKind::slopes, layer.map);
  binding.channels = layer.map.channels;
  binding.green = layer.map.green;
  add_slope_map(generator, layer, std::move(binding));
}

} // namespace surfgrad::shadergen
