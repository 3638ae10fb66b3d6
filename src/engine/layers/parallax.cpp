#include "engine/layers/parallax.hpp"

#include "engine/compiler.hpp"
#include "stack/format.hpp"

#include <algorithm>

namespace surfgrad::engine {

Parallax compiled(const stack::ParallaxLayer& layer, const Compiler& compiler) {
  Parallax result;
  result.influence = compiler.influence(layer.common);
  result.field = compiler.maps().relief(layer.map.file, layer.channel);
  // The field's own map: it lives as long as the field.
  const std::shared_ptr<const image::Map> heights(result.field, &result.field->from_above.map);
  result.relief.texture = compiler.texture(layer.map, heights);
  result.relief.smooth = heights;
  // Positions stay within what all layers can bear, as single factors do.
  result.relief.height =
      std::clamp(layer.height * layer.common.scale, -stack::largest_number, stack::largest_number);
  result.level = layer.level;
  result.occlusion = layer.method == stack::ParallaxMethod::occlusion;
  result.limit_offset = layer.limit_offset;
  result.displaced_footprint = layer.lod == stack::ParallaxLod::displaced;
  result.height_normal = layer.normal == stack::ParallaxNormal::height;
  result.curvature = layer.curvature;
  result.reflect = layer.facing == stack::Facing::reflect;
  result.self_shadow = layer.self_shadow;
  return result;
}

} // namespace surfgrad::engine
