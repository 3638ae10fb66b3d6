#include "shadergen/maps.hpp"

#include <surfgrad/trigonometry.hpp>

#include <algorithm>
#include <cmath>

namespace surfgrad::shadergen {
namespace {

using Role = SurfaceMember::Role;

// Numbers of exact.glsl.
int number_of(stack::Wrap wrap) { return static_cast<int>(wrap); }
int number_of(stack::Filter filter) {
  return filter == stack::Filter::nearest ? 0 : filter == stack::Filter::bilinear ? 1 : 2;
}

char letter_of(stack::MaskChannel channel) { return "rgba"[static_cast<int>(channel)]; }

bool same_file(const stack::FileName& a, const stack::FileName& b) { return a.path == b.path; }

bool same(const TextureBinding& a, const TextureBinding& b) {
  return a.kind == b.kind &&
         std::equal(a.files.begin(), a.files.end(), b.files.begin(), b.files.end(), same_file) &&
         a.wrap_s == b.wrap_s && a.wrap_t == b.wrap_t && a.filter == b.filter &&
         a.anisotropy == b.anisotropy && a.channels == b.channels && a.green == b.green &&
         a.sampled == b.sampled && a.code.range == b.code.range && a.code.neutral == b.code.neutral &&
         a.channel == b.channel;
}

/// The number of the binding: that of one which is the same, or a new one's.
std::size_t index_of(Shader& shader, TextureBinding binding, const std::string& layer) {
  auto& textures = shader.textures;
  const auto found = std::find_if(textures.begin(), textures.end(),
                                  [&](const TextureBinding& known) { return same(known, binding); });
  const auto index = static_cast<std::size_t>(found - textures.begin());
  if (found == textures.end()) {
    // In exact access a relief is two maps.
    if (!textures.empty()) {
      const TextureBinding& last = textures.back();
      binding.binding = last.binding + (last.kind == MapKind::relief ? 2 : 1);
    }
    textures.push_back(std::move(binding));
  }
  std::vector<std::string>& layers = textures[index].layers;
  if (std::find(layers.begin(), layers.end(), layer) == layers.end()) layers.push_back(layer);
  return index;
}

/// Whether hardware filters a map of the engine's as the engine does, but for the precision of its weights.
/// Heights of which differences are taken would show the steps of those weights, and encoded normals make
/// slopes of any size of them.
bool can_be_sampled(const TextureBinding& binding) {
  switch (binding.kind) {
  case MapKind::slopes:
  case MapKind::derivatives:
  case MapKind::height_slopes:
  case MapKind::directions:
  case MapKind::weights:
    return binding.anisotropy == 1;
  case MapKind::normals:
  case MapKind::heights:
  case MapKind::relief:
  case MapKind::cube:
    break;
  }
  return false;
}

/// Where the two arguments of a footprint part: the comma outside all brackets.
std::size_t middle_comma(const std::string& arguments) {
  int depth = 0;
  std::size_t i = 0;
  for (; depth > 0 || arguments[i] != ','; ++i)
    depth += arguments[i] == '(' ? 1 : arguments[i] == ')' ? -1 : 0;
  return i;
}

FileFacts facts_of(const Generator& generator, const stack::FileName& file) {
  const auto& known = generator.options().facts_of;
  return known ? known(file) : FileFacts{};
}

/// The vec2 of a slope as its channels hold it, x along s and y along t.
std::string with_green(const TextureBinding& binding, const std::string& slope) {
  return binding.green == stack::Green::up ? slope : "vec2(1.0, -1.0) * " + slope;
}

} // namespace

TextureBinding binding_of(MapKind kind, const stack::Tiled& tiled, const stack::FileName& file, int uv) {
  TextureBinding binding;
  binding.kind = kind;
  binding.files = {file};
  binding.uv = uv;
  binding.wrap_s = tiled.wrap;
  binding.wrap_t = tiled.wrap_t.value_or(tiled.wrap);
  binding.filter = tiled.filter;
  binding.anisotropy = tiled.filter == stack::Filter::anisotropic ? tiled.anisotropy : 1;
  return binding;
}

TextureBinding binding_of(MapKind kind, const stack::Texture& texture) {
  return binding_of(kind, texture, texture.file, texture.uv);
}

MapUse::MapUse(Generator& generator, const stack::Tiled& tiled, TextureBinding binding,
               const std::string& what)
    : generator_(generator), tiled_(tiled), name_(generator.global() + "_" + what) {
  const auto named = [&](const char* parameter) {
    return what == "map" ? parameter : what + "_" + parameter;
  };
  const bool is_normal_map = binding.kind == MapKind::slopes || binding.kind == MapKind::normals;
  if (!generator.exact() && is_normal_map && binding.channels == stack::Channels::automatic)
    binding.channels = facts_of(generator, binding.files[0]).channels;
  if (binding.kind == MapKind::derivatives && !generator.exact())
    range_ = generator.parameter(named("range"), "slope of the largest code", binding.code.range);
  binding.name = name_;
  const bool is_mask = what == "mask";
  if (const auto& samples = generator.options().samples; generator.exact() && samples)
    binding.sampled = can_be_sampled(binding) && samples({generator.layer_index(), is_mask}, binding);
  index_ = index_of(generator.shader(), std::move(binding), generator.layer_key() + (is_mask ? ".mask" : ""));

  if (tiled.tile.x != 1 || tiled.tile.y != 1)
    tile_ = generator.parameter(named("tile"), "repetitions of the " + what, tiled.tile);
  if (tiled.rotate_deg != 0) {
    const SinCos<double> r = sin_cos_turns(std::remainder(tiled.rotate_deg, 360.0) / 360);
    rotation_ = generator.parameter(named("rotation"), "cosine and sine of the turn of the " + what,
                                    vec2<double>{r.cos, r.sin});
  }
  if (tiled.offset.x != 0 || tiled.offset.y != 0)
    offset_ = generator.parameter(named("offset"), "where the " + what + " begins", tiled.offset);
  if (tiled.tiling == stack::Tiling::hex)
    hex_turn_ =
        generator.parameter(named("hex_turn"), "how far hex tiles turn, 0 to 1", tiled.hex_turn_deg / 180);
}

std::string MapUse::in_map(const std::string& change) const {
  const std::string scaled = tile_.empty() ? change : tile_ + " * " + change;
  return rotation_.empty() ? scaled : fmt::format("surfgrad_rotate({}, {})", scaled, rotation_);
}

std::string MapUse::map_coordinate(const std::string& st) const {
  return offset_.empty() ? in_map(st) : in_map(st) + " + " + offset_;
}

std::string MapUse::along_coordinate(const std::string& slope) const {
  const std::string turned =
      rotation_.empty() ? slope : fmt::format("surfgrad_rotate_back({}, {})", slope, rotation_);
  return tile_.empty() ? turned : fmt::format("sign({}) * {}", tile_, turned);
}

std::string MapUse::by_coordinate(const std::string& derivative) const {
  const std::string turned =
      rotation_.empty() ? derivative : fmt::format("surfgrad_rotate_back({}, {})", derivative, rotation_);
  return tile_.empty() ? turned : fmt::format("{} * {}", tile_, turned);
}

std::string MapUse::size() const {
  return generator_.exact() ? fmt::format("stack_map_size({})", exact_map())
                            : fmt::format("texture_size({})", binding().name);
}

bool MapUse::trilinear() const { return number_of(binding().filter) == 2; }

std::string MapUse::exact_wraps() const {
  return fmt::format("{}, {}", number_of(binding().wrap_s), number_of(binding().wrap_t));
}

bool MapUse::moved() const { return !tile_.empty() || !rotation_.empty() || !offset_.empty(); }

std::string MapUse::place_lines() const {
  std::string lines;
  if (moved()) lines += fmt::format("  vec2 at = {};\n", map_coordinate("st"));
  if (generator_.exact()) {
    lines += fmt::format("  StackFootprint footprint = stack_footprint({}, {}, {}, {});\n", exact_map(),
                         in_map("dst_dx"), in_map("dst_dy"), binding().anisotropy);
  } else if (trilinear() && moved()) {
    lines += fmt::format("  vec2 dx = {};\n  vec2 dy = {};\n", in_map("dst_dx"), in_map("dst_dy"));
  }
  if (!hex_turn_.empty())
    lines += fmt::format("  vec2 sides = stack_sides({});\n"
                         "  SurfgradHexTiles tiles = stack_hex_tiles(sides * {}, {}, sides);\n",
                         size(), moved() ? "at" : "st", hex_turn_);
  return lines;
}

std::vector<MapUse::Place> MapUse::places() const {
  const bool exact = generator_.exact();
  const char* dx = moved() ? "dx" : "dst_dx";
  const char* dy = moved() ? "dy" : "dst_dy";
  if (hex_turn_.empty())
    return {{moved() ? "at" : "st", exact ? "footprint" : fmt::format("{}, {}", dx, dy), ""}};
  std::vector<Place> places;
  for (int k = 0; k < 3; ++k) {
    const std::string rotation = fmt::format("tiles.rotation[{}]", k);
    const std::string turned =
        exact
            ? fmt::format("stack_footprint_in_tile(footprint, sides, {})", rotation)
            : fmt::format("stack_in_tile({1}, sides, {0}), stack_in_tile({2}, sides, {0})", rotation, dx, dy);
    places.push_back({fmt::format("tiles.st[{}] / sides", k), turned, rotation});
  }
  return places;
}

std::string MapUse::in_place(const Place& place, const std::string& change) const {
  return place.rotation.empty() ? change
                                : fmt::format("stack_in_tile({}, sides, {})", change, place.rotation);
}

std::string MapUse::from_place(const Place& place, const std::string& derivative) const {
  return place.rotation.empty() ? derivative
                                : fmt::format("stack_from_tile({}, sides, {})", derivative, place.rotation);
}

std::string MapUse::blended(const std::vector<std::string>& values) const {
  if (values.size() == 1) return values[0];
  return fmt::format("weights.x * {} +\n      weights.y * {} +\n      weights.z * {}", values[0], values[1],
                     values[2]);
}

std::string MapUse::texel(const Place& place) const {
  const TextureBinding& b = binding();
  const bool from_top = generator_.options().origin == TextureOrigin::upper_left;
  const std::string at = from_top ? fmt::format("stack_from_top({})", place.st) : place.st;
  if (!trilinear()) return fmt::format("sample_lod({}, {}, 0.0)", b.name, at);
  if (!from_top) return fmt::format("sample_grad({}, {}, {})", b.name, at, place.footprint);
  const std::string& footprint = place.footprint;
  const std::size_t comma = middle_comma(footprint);
  return fmt::format("sample_grad({}, {}, stack_downwards({}), stack_downwards({}))", b.name, at,
                     footprint.substr(0, comma), footprint.substr(comma + 2));
}

std::string MapUse::sampled_texel(const Place& place) const {
  const TextureBinding& b = binding();
  const std::string unit = fmt::format("stack_unit({})", exact_map());
  if (b.filter == stack::Filter::nearest)
    return fmt::format("({} * texelFetch({}, stack_nearest({}, {}, {}), 0))", unit, b.name, exact_map(),
                       place.st, exact_wraps());
  return fmt::format("({} * textureLod({}, stack_in_period({}, {}), {}))", unit, b.name, place.st,
                     exact_wraps(), trilinear() ? place.footprint + ".lod" : "0.0");
}

std::string MapUse::slope(const Place& place) const {
  const TextureBinding& b = binding();
  if (b.sampled) return sampled_texel(place) + ".xy";
  if (generator_.exact())
    return fmt::format("stack_map_slope({}, {}, {}, {}, {})", exact_map(), place.st, place.footprint,
                       exact_wraps(), number_of(b.filter));
  if (b.kind == MapKind::derivatives) {
    const FileFacts facts = facts_of(generator_, b.files[0]);
    if (facts.codes == Codes::floats) return with_green(b, fmt::format("({} * {}.xy)", range_, texel(place)));
    if (b.code.neutral == stack::NeutralCode::between)
      return with_green(b, fmt::format("({} * (2.0 * {}.xy - 1.0))", range_, texel(place)));
    // The whole code above the middle is flat; code 0 counts as code 1.
    const char* most = facts.codes == Codes::unorm8 ? "255.0" : "65535.0";
    const char* flat = facts.codes == Codes::unorm8 ? "128.0" : "32768.0";
    return with_green(
        b, fmt::format("({} * stack_whole_code({}.xy, {}, {}))", range_, texel(place), most, flat));
  }
  const bool two = b.channels == stack::Channels::xy;
  return with_green(
      b, fmt::format("surfgrad_derivative_from_normal{}({})", two ? "__vec2" : "", normal_code(place)));
}

std::string MapUse::normal_code(const Place& place) const {
  return fmt::format("2.0 * {}.{} - 1.0", texel(place),
                     binding().channels == stack::Channels::xy ? "xy" : "xyz");
}

bool MapUse::tells_variance() const {
  const TextureBinding& b = binding();
  return generator_.options().roughness && !generator_.exact() && trilinear() &&
         (b.kind == MapKind::slopes || b.kind == MapKind::normals) && b.channels == stack::Channels::xyz;
}

std::string MapUse::value(const Place& place) const {
  const TextureBinding& b = binding();
  if (b.sampled) return sampled_texel(place) + ".x";
  if (generator_.exact())
    return fmt::format("stack_map({}, {}, {}, {}, {}).x", exact_map(), place.st, place.footprint,
                       exact_wraps(), number_of(b.filter));
  return fmt::format("{}.{}", texel(place), letter_of(b.channel));
}

std::string MapUse::direction(const Place& place) const {
  const TextureBinding& b = binding();
  if (b.sampled) return sampled_texel(place) + ".xyz";
  if (generator_.exact())
    return fmt::format("stack_map({}, {}, {}, {}, {})", exact_map(), place.st, place.footprint, exact_wraps(),
                       number_of(b.filter));
  const std::string decoded = fmt::format("(2.0 * {}.xyz - 1.0)", texel(place));
  return b.green == stack::Green::up ? decoded : "vec3(1.0, -1.0, 1.0) * " + decoded;
}

std::string MapUse::height_slope(const Place& place) const {
  if (binding().sampled)
    return fmt::format("stack_wrapped_slopes({}, {}.xy, {})", place.st, sampled_texel(place), exact_wraps());
  if (generator_.exact())
    return fmt::format("stack_map_height_slope({}, {}, {}, {}, {})", exact_map(), place.st, place.footprint,
                       exact_wraps(), number_of(binding().filter));
  // Central differences a texel to each side: between texels too, those of the texels. On coarser levels half a
  // texel to each side, of heights of the level below: the mean slope of a level's texels is the difference of
  // heights at its ends.
  const std::string footprint = trilinear() ? ", vec2 dx, vec2 dy" : "";
  const auto height = [&](const char* at) { return value({at, "0.5 * dx, 0.5 * dy", ""}); };
  const std::string reach =
      trilinear() ? "exp2(max(surfgrad_texture_lod(dx, dy, size) - 1.0, 0.0)) / size" : "1.0 / size";
  const std::string function =
      generator_.function(name_ + "_differences",
                          fmt::format("// Slopes of the heights at a place of the map, by the whole map.\n"
                                      "vec2 @(vec2 at{}) {{\n"
                                      "  vec2 size = {};\n"
                                      "  vec2 reach = {};\n"
                                      "  vec2 x = vec2(reach.x, 0.0);\n"
                                      "  vec2 y = vec2(0.0, reach.y);\n"
                                      "  float dh_ds = {} - {};\n"
                                      "  float dh_dt = {} - {};\n"
                                      "  return vec2(dh_ds, dh_dt) / (2.0 * reach);\n"
                                      "}}\n",
                                      footprint, size(), reach, height("at + x"), height("at - x"),
                                      height("at + y"), height("at - y")));
  return fmt::format("{}({}{})", function, place.st, trilinear() ? ", " + place.footprint : "");
}

std::string MapUse::function_of(const std::string& type, const std::string& suffix,
                                const std::string& rest) const {
  return generator_.function(
      name_ + suffix,
      fmt::format("{} @(vec2 st, vec2 dst_dx, vec2 dst_dy) {{\n{}{}}}\n", type, place_lines(), rest));
}

std::string MapUse::slope_and_variance_function() const {
  const std::vector<Place> where = places();
  const auto normal = [&](std::size_t k) {
    return where.size() == 1 ? "normal" : fmt::format("normal{}", k);
  };
  std::string rest;
  for (std::size_t k = 0; k < where.size(); ++k)
    rest += fmt::format("  vec3 {} = {};\n", normal(k), normal_code(where[k]));
  const auto slope_of = [&](std::size_t k) {
    return with_green(binding(), fmt::format("surfgrad_derivative_from_normal({})", normal(k)));
  };
  std::string hidden = "stack_hidden_variance(normal)";
  if (where.size() == 1) {
    rest += fmt::format("  vec2 slope = {};\n", slope_of(0));
  } else {
    rest += "  vec2 slopes[3];\n";
    for (std::size_t k = 0; k < 3; ++k) rest += fmt::format("  slopes[{}] = {};\n", k, slope_of(k));
    rest += "  vec3 weights = surfgrad_hex_weights(tiles, slopes, 7.0, 1.5);\n"
            "  vec2 slope = surfgrad_hex_derivative(tiles, weights, slopes);\n"
            "  vec3 variances = vec3(stack_hidden_variance(normal0), stack_hidden_variance(normal1), "
            "stack_hidden_variance(normal2));\n";
    hidden = "dot(weights * weights, variances)";
  }
  const char* of_footprint = moved() ? "dx, dy" : "dst_dx, dst_dy";
  rest += fmt::format("  float variance = stack_minified({}, {}) * {};\n", of_footprint, size(), hidden);
  const std::string along = along_coordinate("slope");
  if (along != "slope") rest += fmt::format("  vec2 along = {};\n", along);
  rest += fmt::format("  return vec3({0}.x, {0}.y, variance);\n", along == "slope" ? "slope" : "along");
  return function_of("vec3", "_slope", rest);
}

std::string MapUse::slope_function() const {
  if (tells_variance()) return slope_and_variance_function();
  const std::vector<Place> where = places();
  std::string rest;
  if (where.size() == 1) {
    const bool as_it_is = along_coordinate("slope") == "slope";
    rest = as_it_is ? fmt::format("  return {};\n", slope(where[0]))
                    : fmt::format("  vec2 slope = {};\n  return {};\n", slope(where[0]),
                                  along_coordinate("slope"));
  } else {
    rest = "  vec2 slopes[3];\n";
    for (std::size_t k = 0; k < 3; ++k) rest += fmt::format("  slopes[{}] = {};\n", k, slope(where[k]));
    // The steeper tiles prevail.
    rest += fmt::format("  vec3 weights = surfgrad_hex_weights(tiles, slopes, 7.0, 1.5);\n"
                        "  vec2 slope = surfgrad_hex_derivative(tiles, weights, slopes);\n"
                        "  return {};\n",
                        along_coordinate("slope"));
  }
  return function_of("vec2", "_slope", rest);
}

std::string MapUse::value_function() const {
  const std::vector<Place> where = places();
  std::vector<std::string> values;
  for (const Place& place : where) values.push_back(value(place));
  const std::string weights =
      where.size() == 1 ? "" : "  vec3 weights = stack_hex_weights_by_place(tiles);\n";
  return function_of("float", "_value", fmt::format("{}  return {};\n", weights, blended(values)));
}

std::string MapUse::direction_function() const {
  return function_of("vec3", "_direction", fmt::format("  return {};\n", direction(places()[0])));
}

std::string MapUse::height_slope_function() const {
  const std::vector<Place> where = places();
  std::vector<std::string> slopes;
  for (const Place& place : where) slopes.push_back(from_place(place, height_slope(place)));
  const std::string weights =
      where.size() == 1 ? "" : "  vec3 weights = stack_hex_weights_by_place(tiles);\n";
  return function_of(
      "vec2", "_slope",
      fmt::format("{}  vec2 slope = {};\n  return {};\n", weights, blended(slopes), by_coordinate("slope")));
}

std::string weight_of(Generator& generator, const stack::LayerWeight& common, const std::string& opacity) {
  if (!common.mask) return opacity;
  const MapUse mask(
      generator, *common.mask,
      [&] {
        TextureBinding binding = binding_of(MapKind::weights, *common.mask);
        binding.channel = common.mask->channel;
        return binding;
      }(),
      "mask");
  const std::string call =
      fmt::format("{}({})", mask.value_function(), coordinate_arguments(generator, common.mask->uv));
  return fmt::format("({} * {})", opacity, generator.shared("mask", "float", call));
}

std::string coordinate_arguments(Generator& generator, int uv) {
  const Generator::Footprint footprint = generator.footprint(uv);
  return fmt::format("{}, {}, {}", generator.surface(Role::st, uv), footprint.dx, footprint.dy);
}

} // namespace surfgrad::shadergen
