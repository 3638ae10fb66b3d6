#include "shadergen/heights.hpp"
#include "shadergen/layers/basis.hpp"
#include "shadergen/layers/influence.hpp"
#include "shadergen/layers/layers.hpp"
#include "shadergen/space.hpp"

namespace surfgrad::shadergen {
namespace {

using Role = SurfaceMember::Role;

MapUse heights_of(const stack::HeightMapLayer& layer, Generator& g, MapKind kind, const char* what) {
  TextureBinding binding = binding_of(kind, layer.map);
  binding.channel = layer.channel;
  return {g, layer.map, std::move(binding), what};
}

/// Slopes of the heights along the texture coordinate, for any tile and any object: measured in widths of the
/// map, whose texels count as square, and as steep as a normal map's at most.
std::string scale_free_slope_function(const stack::HeightMapLayer& layer, Generator& g) {
  const bool smooth = layer.taps == stack::Taps::bicubic;
  const MapUse map = heights_of(layer, g, g.exact() ? MapKind::height_slopes : MapKind::heights, "map");
  const std::string height = g.parameter("height", "of the value 1, in widths of the map", layer.height);
  std::string lines = map.place_lines();
  std::string smooth_function;
  if (smooth) {
    lines += fmt::format("  float share = stack_smooth_share({});\n", level_of_detail(map));
    // The engine's slopes and its heights are two maps of one file.
    smooth_function =
        smooth_slope_function(g.exact() ? heights_of(layer, g, MapKind::heights, "heights") : map, g);
  }
  std::vector<std::string> slopes;
  const std::vector<MapUse::Place> places = map.places();
  for (std::size_t k = 0; k < places.size(); ++k) {
    lines += fmt::format("  vec2 slope{} = {};\n", k, map.height_slope(places[k]));
    if (smooth)
      lines += fmt::format(
          "  if (share > 0.0) {{\n    slope{0} = slope{0} + share * ({1}({2}) - slope{0});\n  }}\n", k,
          smooth_function, places[k].st);
    slopes.push_back(map.from_place(places[k], fmt::format("slope{}", k)));
  }
  if (slopes.size() > 1) lines += "  vec3 weights = stack_hex_weights_by_place(tiles);\n";
  return g.function(map.name() + "_slope",
                    fmt::format("vec2 @(vec2 st, vec2 dst_dx, vec2 dst_dy) {{\n"
                                "{}"
                                "  vec2 by_map = {};\n"
                                "  vec2 texels = {};\n"
                                "  vec2 slope = {} * vec2(by_map.x, by_map.y * texels.x / texels.y);\n"
                                "  vec2 limited = (SURFGRAD_MAX_SLOPE / max(SURFGRAD_MAX_SLOPE, "
                                "surfgrad_max_abs__vec2(slope))) * slope;\n"
                                "  return {};\n"
                                "}}\n",
                                lines, map.blended(slopes), map.size(), height,
                                map.along_coordinate("limited")));
}

} // namespace

void write(const stack::HeightMapLayer& layer, Generator& g) {
  const Influence influence = influence_of(g, layer.common);
  const int uv = layer.map.uv;
  if (layer.mode == stack::HeightMode::scale_free) {
    const std::string basis =
        basis_of(g, uv, layer.basis.value_or(stack::Basis::derived) == stack::Basis::derived);
    g.add_slope(influence.weight, influence.scale, influence.mix, basis,
                fmt::format("{}({})", scale_free_slope_function(layer, g), coordinate_arguments(g, uv)));
    return;
  }
  const bool world = layer.units == stack::Units::scene;
  const bool across_quad = layer.taps == stack::Taps::one;
  const MapUse map = heights_of(layer, g, MapKind::heights, "map");
  const std::string height = g.parameter("height", "displacement of the value 1", layer.height);
  const std::string function =
      height_per_pixel_function(map, g, {layer.taps == stack::Taps::bicubic, across_quad});
  const std::string dst_dx = g.surface(Role::dst_dx, uv), dst_dy = g.surface(Role::dst_dy, uv);
  std::string dx = g.surface(Role::dp_dx), dy = g.surface(Role::dp_dy);
  if (!world) {
    const std::string inverse = g.surface(Role::object_from_world);
    dx = g.shared("object_dp_dx", "vec3", fmt::format("product({}, {})", inverse, dx));
    dy = g.shared("object_dp_dy", "vec3", fmt::format("product({}, {})", inverse, dy));
  }
  const std::string dh =
      g.value("dh", "vec2",
              fmt::format("{} * {}({}, {}, {}{})", height, function, coordinate_arguments(g, uv), dst_dx,
                          dst_dy, across_quad ? ", " + g.surface(Role::raster) : ""));
  const std::string parametric = fmt::format("surfgrad_from_parametric_derivative({}, {}, {}, {})",
                                             normal_in_space(g, world), dx, dy, dh);
  std::string gradient = world ? parametric : from_gradient_in_space(g, world, parametric);
  if (g.options().diagnostics) {
    const std::string collapsed =
        g.shared("collapsed", "bool", fmt::format("stack_collapsed({}, {}, {}, {})", dst_dx, dst_dy, dx, dy));
    g.degenerate_once(collapsed);
    gradient = fmt::format("select({}, vec3(0.0, 0.0, 0.0), {})", collapsed, gradient);
  }
  g.add(influence.weight, influence.scale, influence.mix, gradient);
}

} // namespace surfgrad::shadergen
