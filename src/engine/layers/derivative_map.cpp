#include "engine/compiler.hpp"

namespace surfgrad::engine {

NormalMap compiled(const stack::DerivativeMapLayer& layer, const Compiler& compiler) {
  return {
      compiler.influence(layer.common),
      compiler.texture(layer.map, compiler.maps().derivatives(layer.map.file, layer.code, layer.map.green)),
      layer.basis == stack::Basis::derived};
}

} // namespace surfgrad::engine
