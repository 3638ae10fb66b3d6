#include "shadergen/bumps.hpp"

namespace surfgrad::shadergen {

BumpFunction bump_function(Generator& g, const stack::BumpCodes& bumps, stack::Content content,
                           const stack::FileName& file, const std::string& what) {
  const auto binding = [&](MapKind kind) {
    TextureBinding b = binding_of(kind, bumps, file);
    b.channels = bumps.channels;
    b.green = bumps.green;
    b.code = bumps.derivative;
    b.channel = bumps.height_channel;
    return b;
  };
  switch (content) {
  case stack::Content::derivative:
    return {MapUse(g, bumps, binding(MapKind::derivatives), what).slope_function()};
  case stack::Content::height: {
    const MapUse map(g, bumps, binding(g.exact() ? MapKind::height_slopes : MapKind::heights), what);
    const std::string height = g.parameter(what == "map" ? "height" : what + "_height",
                                           "displacement of a height of 1", bumps.height);
    return {
        g.function(map.name() + "_derivative", fmt::format("vec2 @(vec2 st, vec2 dst_dx, vec2 dst_dy) {{\n"
                                                           "  return {} * {}(st, dst_dx, dst_dy);\n"
                                                           "}}\n",
                                                           height, map.height_slope_function()))};
  }
  case stack::Content::normal:
    break;
  }
  const bool encoded = bumps.filter == stack::Filter::normal;
  const MapUse map(g, bumps, binding(encoded ? MapKind::normals : MapKind::slopes), what);
  return {map.slope_function(), map.tells_variance()};
}

} // namespace surfgrad::shadergen
