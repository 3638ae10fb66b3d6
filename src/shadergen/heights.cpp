#include "shadergen/heights.hpp"

namespace surfgrad::shadergen {
namespace {

/// Parameters of a function that stand for a place's footprint, named as MapUse::Place names the whole map's.
std::string footprint_parameters(const Generator& generator) {
  return generator.exact() ? "StackFootprint footprint" : "vec2 dx, vec2 dy";
}
std::string own_footprint(const Generator& generator) { return generator.exact() ? "footprint" : "dx, dy"; }

/// Height of a texel of level 0: a function of (int x, int y).
std::string texel_function(const MapUse& heights, Generator& g) {
  const TextureBinding& b = heights.binding();
  std::string texel;
  if (g.exact()) {
    texel = fmt::format("stack_map_texel({}, x, y)", heights.exact_map());
  } else {
    const bool from_top = g.options().origin == TextureOrigin::upper_left;
    const std::string row = from_top ? fmt::format("int(texture_size({}).y) - 1 - y", b.name) : "y";
    texel = fmt::format("fetch({}, x, {}).{}", b.name, row, "rgba"[static_cast<int>(b.channel)]);
  }
  return g.function(heights.name() + "_texel",
                    fmt::format("float @(int x, int y) {{ return {}; }}\n", texel));
}

int number_of(stack::Wrap wrap) { return static_cast<int>(wrap); }

} // namespace

std::string level_of_detail(const MapUse& map) {
  return fmt::format("surfgrad_texture_lod({}, {}, {})", map.in_map("dst_dx"), map.in_map("dst_dy"),
                     map.size());
}

namespace {

/// Lines that read 4x4 texels around `at`: rows less `pivot`, and `fraction` and `direction` of the point.
std::string spline_lines(const MapUse& heights, Generator& g) {
  const std::string texel = texel_function(heights, g);
  std::string lines = fmt::format("  vec2 size = {};\n", heights.size());
  constexpr const char* steps[] = {" - 1", "", " + 1", " + 2"}; // from the texel below the point
  const auto taps = [&](const char* axis, stack::Wrap wrap) {
    lines +=
        fmt::format("  StackTaps {0} = stack_cubic_taps(at.{0}, size.{0}, {1});\n", axis, number_of(wrap));
    for (int k = 0; k < 4; ++k)
      lines += fmt::format("  int {0}{1} = stack_wrapped(int({0}.low){2}, int(size.{0}), {3});\n", axis, k,
                           steps[k], number_of(wrap));
  };
  taps("x", heights.binding().wrap_s);
  taps("y", heights.binding().wrap_t);
  // Heights relative to one of them: a plateau keeps the precision of its relief.
  lines += fmt::format("  float pivot = {}(x1, y1);\n", texel);
  for (int j = 0; j < 4; ++j) {
    std::string row;
    for (int i = 0; i < 4; ++i) row += fmt::format("{}{}(x{}, y{}) - pivot", i > 0 ? ", " : "", texel, i, j);
    lines += fmt::format("  vec4 row{} = vec4({});\n", j, row);
  }
  return lines + "  vec2 fraction = vec2(x.fraction, y.fraction);\n"
                 "  vec2 direction = vec2(x.direction, y.direction);\n";
}

constexpr const char* slope_line =
    "  vec2 slope = direction * surfgrad_derivative_from_bicubic(matrix_of_rows(row0, "
    "row1, row2, row3), fraction);\n";

} // namespace

std::string smooth_slope_function(const MapUse& heights, Generator& g) {
  return g.function(
      heights.name() + "_smooth_slope",
      fmt::format("// Slope of the cubic B-spline of the texels at a place of the map, by the whole map.\n"
                  "vec2 @(vec2 at) {{\n{}{}  return size * slope;\n}}\n",
                  spline_lines(heights, g), slope_line));
}

std::string smooth_function(const MapUse& heights, Generator& g) {
  return g.function(
      heights.name() + "_smooth",
      fmt::format("// The cubic B-spline of the texels at a place of the map: its slope by the whole map, "
                  "and its value.\n"
                  "vec3 @(vec2 at) {{\n{}{}"
                  "  float height = pivot + stack_spline_value(row0, row1, row2, row3, fraction);\n"
                  "  return vec3(size.x * slope.x, size.y * slope.y, height);\n"
                  "}}\n",
                  spline_lines(heights, g), slope_line));
}

std::string height_per_pixel_function(const MapUse& map, Generator& g, HeightTaps taps) {
  const auto height = [&](const char* at) { return map.value({at, own_footprint(g), ""}); };
  std::string smooth;
  if (taps.smooth)
    smooth = fmt::format("  float share = stack_smooth_share(lod);\n"
                         "  if (share > 0.0) {{\n"
                         "    vec2 dh = {}(at);\n"
                         "    dh_dxy = dh_dxy + share * (vec2(dot(dh, step_x), dot(dh, step_y)) - dh_dxy);\n"
                         "  }}\n",
                         smooth_slope_function(map, g));
  const std::string at_place =
      g.function(map.name() + "_taps",
                 fmt::format("// Differences of the heights at a place of the map.\n"
                             "vec2 @(vec2 at, vec2 first, vec2 step_x, vec2 step_y, {}{}) {{\n"
                             "  vec2 dh_dxy = surfgrad_derivative_from_heights({}, {}, {});\n"
                             "{}"
                             "  return dh_dxy;\n"
                             "}}\n",
                             footprint_parameters(g), taps.smooth ? ", float lod" : "", height("first"),
                             height("first + step_x"), height("first + step_y"), smooth));
  std::string lines = map.place_lines();
  if (!g.exact() && !map.trilinear() && map.moved()) lines += "  vec2 dx = dst_dx;\n  vec2 dy = dst_dy;\n";
  lines += fmt::format("  vec2 x = {};\n  vec2 y = {};\n", map.in_map("step_x"), map.in_map("step_y"));
  if (taps.smooth) lines += fmt::format("  float lod = {};\n", level_of_detail(map));
  std::vector<std::string> values;
  const std::vector<MapUse::Place> places = map.places();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const MapUse::Place& place = places[k];
    const std::string x = map.in_place(place, "x"), y = map.in_place(place, "y");
    // Pixels of a block share the differences between its first pixel and the two next to that.
    const std::string first =
        taps.across_quad
            ? fmt::format("{} - stack_odd(raster.x) * {} - stack_odd(raster.y) * {}", place.st, x, y)
            : place.st;
    values.push_back(fmt::format("{}({}, {}, {}, {}, {}{})", at_place, place.st, first, x, y, place.footprint,
                                 taps.smooth ? ", lod" : ""));
  }
  if (values.size() > 1) lines += "  vec3 weights = stack_hex_weights_by_place(tiles);\n";
  return g.function(map.name() + "_per_pixel",
                    fmt::format("vec2 @(vec2 st, vec2 dst_dx, vec2 dst_dy, vec2 step_x, vec2 step_y{}) {{\n"
                                "{}"
                                "  return {};\n"
                                "}}\n",
                                taps.across_quad ? ", vec2 raster" : "", lines, map.blended(values)));
}

} // namespace surfgrad::shadergen
