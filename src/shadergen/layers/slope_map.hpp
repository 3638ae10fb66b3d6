#pragma once

#include "shadergen/layers/basis.hpp"
#include "shadergen/layers/influence.hpp"

#include <utility>

namespace surfgrad::shadergen {

/// A layer that is a map of slopes on a tangent frame: a normal map or a derivative map.
///
/// binding  how the map is read
template <class Layer>
void add_slope_map(Generator& generator, const Layer& layer, TextureBinding binding) {
  const Influence influence = influence_of(generator, layer.common);
  const MapUse map(generator, layer.map, std::move(binding), "map");
  const std::string basis = basis_of(generator, layer.map.uv, layer.basis == stack::Basis::derived);
  const std::string slope =
      fmt::format("{}({})", map.slope_function(), coordinate_arguments(generator, layer.map.uv));
  if (map.tells_variance()) {
    const std::string bump = generator.value("bump", "vec3", slope);
    generator.add_slope(influence.weight, influence.scale, influence.mix, basis, bump + ".xy", bump + ".z");
  } else {
    generator.add_slope(influence.weight, influence.scale, influence.mix, basis, slope);
  }
}

} // namespace surfgrad::shadergen
