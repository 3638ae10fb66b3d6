#include "engine/layers/planar.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {

Planar compiled(const stack::PlanarLayer& layer, const Compiler& compiler) {
  return {compiler.influence(layer.common), compiler.bump_map(layer.map, layer.file), layer.axis,
          layer.space == stack::Space::world};
}

TriplanarCoordinates<double> origin_on_planes(vec3<double> origin, TriplanarConvention convention) {
  return triplanar_coordinates(origin, convention);
}

} // namespace surfgrad::engine
