#pragma once

#include "shadergen/generator.hpp"
#include "shadergen/maps.hpp"

namespace surfgrad::shadergen {

/// Weight, scale and blend of a layer within its pass, as expressions.
struct Influence {
  std::string weight, scale;
  bool mix = false;
};

/// scaled  whether the sum scales the surface gradient; a kind that scales something else does it itself
[[nodiscard]] inline Influence influence_of(Generator& generator, const stack::LayerCommon& common,
                                            bool scaled = true) {
  Influence influence;
  if (scaled) influence.scale = generator.parameter("scale", "scale of the bumps", common.scale);
  const std::string opacity = generator.parameter("opacity", "opacity, 0 to 1", common.opacity);
  influence.weight = weight_of(generator, common, opacity);
  influence.mix = common.blend == stack::Blend::mix;
  return influence;
}

} // namespace surfgrad::shadergen
