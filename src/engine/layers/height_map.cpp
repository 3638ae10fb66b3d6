#include "engine/layers/height_map.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {

HeightMap compiled(const stack::HeightMapLayer& layer, const Compiler& compiler) {
  MapLibrary& maps = compiler.maps();
  const bool scale_free = layer.mode == stack::HeightMode::scale_free;
  const bool smooth = layer.taps == stack::Taps::bicubic;
  HeightMap result;
  result.influence = compiler.influence(layer.common);
  result.texture = compiler.texture(layer.map, nullptr);
  const auto heights = !scale_free || smooth ? maps.heights(layer.map.file, layer.channel) : nullptr;
  result.texture.tiled.map =
      scale_free ? maps.height_slopes(layer.map.file, layer.channel, result.texture.tiled.wrap) : heights;
  if (smooth) result.smooth = heights;
  result.height = layer.height;
  result.kind = scale_free                            ? HeightMap::Kind::scale_free
                : layer.units == stack::Units::object ? HeightMap::Kind::object_units
                                                      : HeightMap::Kind::scene_units;
  result.across_quad = layer.taps == stack::Taps::one;
  result.derived = layer.basis.value_or(stack::Basis::derived) == stack::Basis::derived;
  return result;
}

} // namespace surfgrad::engine
