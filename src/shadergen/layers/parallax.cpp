#include "shadergen/heights.hpp"
#include "shadergen/layers/influence.hpp"
#include "shadergen/layers/layers.hpp"
#include "stack/format.hpp"

#include <algorithm>

namespace surfgrad::shadergen {
namespace {

using Role = SurfaceMember::Role;

/// Writes a parallax: what engine/layers/parallax.hpp does, in its order.
class Parallax {
 public:
  Parallax(const stack::ParallaxLayer& layer, Generator& g) : layer_(layer), g_(g) {}

  void write() {
    open_window();
    search();
    move();
    if (layer_.self_shadow) cast_shadow();
    open_pass();
  }

 private:
  template <class... Parts>
  std::string value(const char* name, std::string_view type, fmt::format_string<Parts...> text,
                    Parts&&... parts) {
    return g_.value(name, type, fmt::format(text, std::forward<Parts>(parts)...));
  }
  std::string own(Role role) { return g_.surface(role, layer_.map.uv); }

  /// What the search depends on: all of it is the base surface's.
  void open_window() {
    for (const Role role : {Role::position, Role::normal, Role::dp_dx, Role::dp_dy, Role::front_facing,
                            Role::to_viewer, Role::raster, Role::relative_from_screen})
      static_cast<void>(g_.surface(role));
    // Positions stay within what all layers can bear, as single factors do.
    const double height =
        std::clamp(layer_.height * layer_.common.scale, -stack::largest_number, stack::largest_number);
    const std::string height_parameter =
        g_.parameter("height", "displacement of the value 1, scale included", height);
    const std::string weight = influence_of(g_, layer_.common, false).weight;
    TextureBinding binding = binding_of(g_.exact() ? MapKind::relief : MapKind::heights, layer_.map);
    binding.channel = layer_.channel;
    map_.emplace(g_, layer_.map, std::move(binding), "map");
    level_ = g_.parameter("level", "the height that lies on the mesh", layer_.level);
    const std::string& frame = g_.frame();
    const std::string dst_dx = own(Role::dst_dx), dst_dy = own(Role::dst_dy);
    // In mode flip the normal is turned over, and the relief stays where it was.
    displacement_ =
        value("displacement", "float", "{}.resolve_sign * ({} * {})", frame, height_parameter, weight);
    side_ =
        value("side", "float", "select(s.front_facing || dot({}.normal, s.normal) < 0.0, 1.0, -1.0)", frame);
    sound_ = value("sound", "bool",
                   "surfgrad_max_abs({0}.normal) > 0.0 && !stack_collapsed({1}, {2}, {0}.dp_dx, {0}.dp_dy)",
                   frame, dst_dx, dst_dy);
    g_.degenerate("!" + sound_);
    const Generator::Footprint footprint = g_.footprint(layer_.map.uv);
    footprint_dx_ = value("footprint_dx", "vec2", "{}", map_->in_map(footprint.dx));
    footprint_dy_ = value("footprint_dy", "vec2", "{}", map_->in_map(footprint.dy));
    lod_ = map_->trilinear() ? value("lod", "float", "surfgrad_texture_lod({}, {}, {})", footprint_dx_,
                                     footprint_dy_, map_->size())
                             : "0.0";
  }

  /// Change of st while a ray in a direction rises by a height of 1, no longer than a march bears.
  std::string way_of(const std::string& frame, const char* direction, bool skip_projection) {
    const std::string dst =
        value("dst", "vec2", "surfgrad_project_to_texture_space({}, {}, {}, {}, {}, {})", frame, direction,
              own(Role::dst_dx), own(Role::dst_dy), displacement_, skip_projection ? "true" : "false");
    return fmt::format("stack_way_share({}, {}, {}) * {}", map_->in_map(dst), map_->size(), lod_, dst);
  }

  /// Arguments that say how a function of places on the map filters, and its parameters.
  std::string filter() const {
    return g_.exact() ? lod_ : fmt::format("{}, {}", footprint_dx_, footprint_dy_);
  }
  std::string filter_parameters() const { return g_.exact() ? "float lod" : "vec2 dx, vec2 dy"; }

  void search() {
    const std::string& frame = g_.frame();
    const std::string along = value("along", "float", "{} * dot({}.normal, s.to_viewer)", side_, frame);
    seen_ = value("seen", "bool", "{} && 0.0 < {}", sound_, along);
    const std::string way = way_of(frame, "s.to_viewer", layer_.limit_offset);
    const std::string dst = value("seen_dst", "vec2", "select({}, {}{}, vec2(0.0, 0.0))", seen_,
                                  layer_.limit_offset ? side_ + " * " : "", way);
    const std::string st = own(Role::st);
    if (layer_.method == stack::ParallaxMethod::offset) {
      const std::string height = map_->value_function();
      const std::string arguments = plane_footprint();
      way_ = value("way", "vec2", "({}({}, {}) - {}) * {}", height, st, arguments, level_, dst);
      height_ = value("height", "float", "{}({} + {}, {})", height, st, way_, arguments);
      return;
    }
    const std::string below = value("from_below", "bool", "{} && {} * {} < 0.0", seen_, displacement_, side_);
    height_ = value("height", "float", "{}({}, {}, {}, {}, {})", first_height_function(),
                    map_->map_coordinate(st), map_->in_map(dst), level_, below, filter());
    way_ = value("way", "vec2", "({} - {}) * {}", height_, level_, dst);
  }

  std::string plane_footprint() {
    const Generator::Footprint footprint = g_.footprint(layer_.map.uv);
    return fmt::format("{}, {}", footprint.dx, footprint.dy);
  }

  /// The first crossing: who looks along the displacement meets the relief from below, where depths are
  /// heights.
  std::string first_height_function() {
    std::string march;
    if (g_.exact()) {
      march = fmt::format("  float met = stack_march({} + side, start, ray, lod, {});\n", map_->exact_map(),
                          map_->exact_wraps());
      march = "  int side = select(from_below, 1, 0);\n" + march;
    } else {
      march = fmt::format(
          "  SurfgradParallaxMarch march = surfgrad_march_parallax_begin(start, ray, {});\n"
          "  while (surfgrad_march_parallax_asks(march)) {{\n"
          "    vec2 there = surfgrad_march_parallax_at(march);\n"
          "    float value = {};\n"
          "    march = surfgrad_march_parallax_answer(march, select(from_below, 1.0 - value, value));\n"
          "  }}\n"
          "  SurfgradParallaxHit hit = surfgrad_march_parallax_end(march);\n"
          "  float met = hit.height;\n",
          g_.options().march_steps, map_->value({"there", "dx, dy", ""}));
    }
    return g_.function(
        map_->name() + "_first_height",
        fmt::format("// Height at which the view first meets the relief.\n"
                    "float @(vec2 at, vec2 way, float level, bool from_below, {}) {{\n"
                    "  vec2 start = select(from_below, at + (1.0 - level) * way, at - level * way);\n"
                    "  vec2 ray = select(from_below, -way, way);\n"
                    "{}"
                    "  return select(from_below, 1.0 - met, met);\n"
                    "}}\n",
                    filter_parameters(), march));
  }

  /// There: position, texture coordinates, base normal.
  void move() {
    const std::string& frame = g_.frame();
    const std::string dst_dx = own(Role::dst_dx), dst_dy = own(Role::dst_dy), st = own(Role::st);
    const std::string v = value("pixels", "vec2", "surfgrad_screen_offset({}, {}, {})", dst_dx, dst_dy, way_);
    const std::string displaced = value(
        "displaced", "vec3", "surfgrad_surface_offset({0}, {1}, {2}, {3}) + (({4} - {5}) * {6}) * {0}.normal",
        frame, dst_dx, dst_dy, way_, height_, level_, displacement_);
    const std::string moves =
        value("shift", "vec3",
              "select({} || ({} && surfgrad_max_abs(s.to_viewer) == 0.0), {}, vec3(0.0, 0.0, 0.0))", seen_,
              sound_, displaced);
    const std::string own_st = value("moved_st", "vec2", "{} + {}", st, way_);
    g_.line("s.position = s.position + {};", moves);
    for (const SurfaceMember& m : g_.expected_surface()) {
      const std::string name = "s." + m.name;
      if (m.role == Role::object_position)
        g_.line("{} = {} + product({}, {});", name, name, g_.surface(Role::object_from_world), moves);
      if (m.role == Role::world_position) g_.line("{} = {} + {};", name, name, moves);
      if (m.role == Role::st && m.uv != layer_.map.uv)
        g_.line("{0} = select({1}, {0} + {2}.x * {3} + {2}.y * {4}, {0});", name, seen_, v,
                g_.surface(Role::dst_dx, m.uv), g_.surface(Role::dst_dy, m.uv));
    }
    g_.line("{} = {};", st, own_st);
    std::string normal = frame + ".normal";
    if (layer_.curvature) {
      const std::string rate = g_.options().diagnostics
                                   ? fmt::format("select({}, 0.0, stack_unit_rate({}.normal, s.normal))",
                                                 g_.surface(Role::normal_is_absent), frame)
                                   : fmt::format("stack_unit_rate({}.normal, s.normal)", frame);
      const std::string r = value("rate", "float", "{}", rate);
      normal = fmt::format(
          "select({0}, surfgrad_offset_normal({1}, surfgrad_from_volume_gradient({1}.normal, {2} * {3}), "
          "surfgrad_from_volume_gradient({1}.normal, {2} * {4}), {5}), {1}.normal)",
          seen_, frame, r, g_.surface(Role::dn_dx), g_.surface(Role::dn_dy), v);
    }
    base_ = value("base", "SurfgradFrame", "surfgrad_rebase_frame({}, {})", frame, normal);
  }

  /// Sun over the relief: none where relief is in the way, or the sun behind the mesh.
  void cast_shadow() {
    g_.shader().has_sunlight = true;
    const std::string to_sun = g_.surface(Role::to_sun);
    const std::string along = value("sun_along", "float", "dot({}.normal, {})", base_, to_sun);
    const std::string searched =
        value("searched", "bool", "{} && surfgrad_max_abs({}) > 0.0", sound_, to_sun);
    const std::string lit = value("lit", "bool", "{} && 0.0 < {}", searched, along);
    const std::string way = way_of(base_, "s.to_sun", false);
    const std::string dst = value("sun_dst", "vec2", "select({}, {}, vec2(0.0, 0.0))", lit, way);
    const std::string below = value("sun_below", "bool", "{} * {} < 0.0", displacement_, along);
    std::string height = height_;
    const std::string here = value("here", "vec2", "{}", map_->map_coordinate(own(Role::st)));
    if (g_.exact() && layer_.method == stack::ParallaxMethod::offset)
      // An offset's height is blended from two mip levels; shadows fall within one.
      height = value("height", "float", "stack_march({}, {}, vec2(0.0, 0.0), {}, {})", map_->exact_map(),
                     here, lod_, map_->exact_wraps());
    const std::string sun = value("sun", "float", "{}({}, {}, {}, {}, {})", visible_function(), here, height,
                                  map_->in_map(dst), below, filter());
    g_.line("sunlight = sunlight * select({}, {}, select({}, 0.0, 1.0));", lit, sun, searched);
  }

  /// Whether the way to the sun is free: 1 or 0.
  std::string visible_function() {
    std::string body;
    if (g_.exact()) {
      body = fmt::format(
          "  return stack_visible({} + select(from_below, 1, 0), at, select(from_below, 1.0 - height, "
          "height), select(from_below, -way, way), lod, {});\n",
          map_->exact_map(), map_->exact_wraps());
    } else {
      const int steps = g_.options().march_steps;
      body = fmt::format("  float start = select(from_below, 1.0 - height, height);\n"
                         "  vec2 ray = select(from_below, -way, way);\n"
                         "  float sun = 1.0;\n"
                         "  for (int i = 1; i < {0}; ++i) {{\n"
                         "    float rise = (1.0 - start) * float(i) / {0}.0;\n"
                         "    vec2 there = at + rise * ray;\n"
                         "    float value = {1};\n"
                         "    if (select(from_below, 1.0 - value, value) > start + rise) {{\n"
                         "      sun = 0.0;\n"
                         "      break;\n"
                         "    }}\n"
                         "  }}\n"
                         "  return sun;\n",
                         steps, map_->value({"there", "dx, dy", ""}));
    }
    return g_.function(map_->name() + "_visible",
                       fmt::format("// 1 where no relief is in the way to the sun.\n"
                                   "float @(vec2 at, float height, vec2 way, bool from_below, {}) {{\n{}}}\n",
                                   filter_parameters(), body));
  }

  /// The new frame. The relief is steep by the base surface's derivatives.
  void open_pass() {
    const bool relief_normal = layer_.normal == stack::ParallaxNormal::height;
    std::string surfgrad = "vec3(0.0, 0.0, 0.0)";
    if (relief_normal) {
      const std::string dh = value("dh", "vec2", "{} * {}({}, {}, {}, {})", displacement_,
                                   height_per_pixel_function(*map_, g_, {.smooth = true}), own(Role::st),
                                   plane_footprint(), own(Role::dst_dx), own(Role::dst_dy));
      surfgrad =
          value("relief", "vec3", "select({}, surfgrad_from_height_derivative({}, {}), vec3(0.0, 0.0, 0.0))",
                sound_, base_, dh);
    }
    const std::string normal =
        value("relief_normal", "vec3", "surfgrad_normalize_or_zero({}.normal - {})", base_, surfgrad);
    std::string plane = normal;
    if (layer_.facing == stack::Facing::reflect)
      plane = value("plane", "vec3", "stack_reflected({}, s.to_viewer, {})", normal, side_);
    const std::string dp =
        value("dp", "SurfgradScreenDerivatives",
              "stack_relief_footprint({}, {}, {}, s.position, s.relative_from_screen, s.raster)", base_,
              surfgrad, plane);
    // Texture coordinates are those of the base point below.
    for (const int uv : coordinates()) {
      const std::string dx = g_.surface(Role::dst_dx, uv), dy = g_.surface(Role::dst_dy, uv);
      const Generator::Footprint before = g_.footprint(uv);
      if (layer_.lod == stack::ParallaxLod::displaced) {
        g_.set_footprint(uv, {dx, dy});
      } else if (before.dx == dx) { // else an earlier parallax has kept it
        g_.set_footprint(uv, {value(fmt::format("footprint{}_dx", uv).c_str(), "vec2", "{}", dx),
                              value(fmt::format("footprint{}_dy", uv).c_str(), "vec2", "{}", dy)});
      }
      const std::string d = value("moved", "SurfgradTextureDerivatives",
                                  "stack_relief_derivatives({}, {}, {}, {})", base_, dx, dy, dp);
      g_.line("{0} = select({1}, {2}.dst_dx, {0});", dx, sound_, d);
      g_.line("{0} = select({1}, {2}.dst_dy, {0});", dy, sound_, d);
    }
    g_.line("s.dp_dx = select({}, {}.dp_dx, s.dp_dx);", sound_, dp);
    g_.line("s.dp_dy = select({}, {}.dp_dy, s.dp_dy);", sound_, dp);
    const std::string frame =
        value("frame", "SurfgradFrame", "surfgrad_rebase_frame__moved({}, {}, s.dp_dx, s.dp_dy)", g_.frame(),
              normal);
    const bool stays_first = !relief_normal && g_.first_pass();
    if (stays_first) // still the smooth surface: vertex frames follow its normal as MikkTSpace defines them
      g_.line("s.normal = (select(dot({0}, s.normal) < 0.0, -1.0, 1.0) * length(s.normal)) * {0};", normal);
    g_.forget_shared();
    g_.begin_pass(frame, stays_first);
    g_.shader().moves = true;
  }

  /// UV sets that any layer reads.
  std::vector<int> coordinates() const {
    std::vector<int> sets{layer_.map.uv};
    for (const SurfaceMember& m : g_.expected_surface())
      if (m.role == Role::dst_dx && m.uv != layer_.map.uv) sets.push_back(m.uv);
    return sets;
  }

  const stack::ParallaxLayer& layer_;
  Generator& g_;
  std::optional<MapUse> map_;
  // Names of values.
  std::string level_, displacement_, side_, sound_, seen_, lod_, footprint_dx_, footprint_dy_;
  std::string way_, height_, base_;
};

} // namespace

void write(const stack::ParallaxLayer& layer, Generator& generator) { Parallax(layer, generator).write(); }

} // namespace surfgrad::shadergen
