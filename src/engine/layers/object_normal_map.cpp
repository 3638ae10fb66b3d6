#include "engine/layers/object_normal_map.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {

ObjectNormalMap compiled(const stack::ObjectNormalMapLayer& layer, const Compiler& compiler) {
  return {compiler.influence(layer.common),
          compiler.texture(layer.map, compiler.maps().directions(layer.map.file, layer.map.green)),
          layer.space == stack::Space::world};
}

} // namespace surfgrad::engine
