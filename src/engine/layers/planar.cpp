#include "engine/layers/planar.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {

Planar compiled(const stack::PlanarLayer& layer, const Compiler& compiler) {
  return {compiler.influence(layer.common), compiler.bump_map(layer.map, layer.file), layer.axis,
          layer.space == stack::Space::world};
}

} // namespace surfgrad::engine
