#include "engine/layers/normal_map.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {

NormalMap compiled(const stack::NormalMapLayer& layer, const Compiler& compiler) {
  return {compiler.influence(layer.common), compiler.texture(layer.map, compiler.maps().slopes(layer.map.file, layer.map.channels, layer.map.green, layer.map.filter)),
          layer.basis == stack::Basis::derived};
}

} // namespace surfgrad::engine
