#include "diagnostic/error.hpp"
#include "shadergen/bumps.hpp"
#include "shadergen/layers/layers.hpp"
#include "shadergen/space.hpp"

#include <surfgrad/trigonometry.hpp>
#include <surfgrad/vec.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace surfgrad::shadergen {
namespace {

using Role = SurfaceMember::Role;

bool is_cube(stack::DecalShape shape) {
  return shape == stack::DecalShape::sphere || shape == stack::DecalShape::capsule;
}

stack::DecalBlend blend_of(const stack::DecalLayer& layer, const stack::DecalInstance& instance) {
  return instance.blend.value_or(layer.blend);
}

bool has(const stack::DecalLayer& layer, stack::DecalBlend blend) {
  return std::any_of(layer.instances.begin(), layer.instances.end(),
                     [&](const stack::DecalInstance& i) { return blend_of(layer, i) == blend; });
}

/// Where a decal acts: nowhere on an object whose transform has no inverse. Only the engine's own device
/// looks for that.
const char* inside_of(const stack::DecalLayer& layer, const Generator& g) {
  const bool may_lack_space = g.options().diagnostics && layer.space == stack::Space::object;
  return may_lack_space ? "place.inside && !stack_is_zero(s.object_from_world)" : "place.inside";
}

/// What a decal adds where it is.
struct Addition {
  std::string lines;    ///< inside the loop over decals: they give `gradient`
  std::string variance; ///< MapUse::tells_variance: of the slopes, as an expression; else empty
};

/// Of a box, cone or wedge.
Addition image_addition(const stack::DecalLayer& layer, Generator& g, const std::string& fade) {
  const BumpFunction function = bump_function(g, layer.map, layer.map.content, layer.files[0], "map");
  const char* gradient = layer.gradient == stack::ConeGradient::exact ? "SURFGRAD_CONE_GRADIENT_EXACT"
                                                                      : "SURFGRAD_CONE_GRADIENT_SCALE_FREE";
  std::string shape;
  if (layer.shape == stack::DecalShape::cone)
    shape = fmt::format("surfgrad_cone_decal(decal.frame, at, decal.size.x, decal.size.y, {}, {})", fade,
                        gradient);
  else if (layer.shape == stack::DecalShape::wedge)
    shape = fmt::format("surfgrad_wedge_decal(decal.frame, at, decal.half_length, decal.size.x, "
                        "decal.size.y, {}, {})",
                        fade, gradient);
  else
    shape = fmt::format("surfgrad_box_decal(decal.frame, at, decal.size, {})", fade);
  // Slopes lie along the image's axes, heights go by its coordinates.
  const char* axis = layer.map.content == stack::Content::height ? "grad" : "axis";
  const char* bump = function.tells_variance ? "bump" : "derivative";
  return {fmt::format("    SurfgradDecalProjection place = {};\n"
                      "    if ({}) {{\n"
                      "      SurfgradTextureDerivatives d = surfgrad_projected_derivatives(place.grad_s, "
                      "place.grad_t, dp_dx, dp_dy);\n"
                      "      {} {} = {}(place.texture_coordinate, d.dst_dx, d.dst_dy);\n"
                      "      vec3 gradient = surfgrad_decal_gradient({}, place.{}_s, place.{}_t);\n",
                      shape, inside_of(layer, g), function.type(), bump, function.name,
                      function.derivative(bump), axis, axis),
          function.variance(bump)};
}

/// Of a sphere or capsule.
Addition cube_addition(const stack::DecalLayer& layer, Generator& g, const std::string& fade) {
  TextureBinding binding = binding_of(MapKind::cube, stack::Tiled{}, layer.files[0]);
  binding.files = layer.files;
  const stack::Tiled whole;
  const MapUse map(g, whole, std::move(binding), "map");
  const bool capsule = layer.shape == stack::DecalShape::capsule;
  const std::string shape =
      capsule
          ? fmt::format("surfgrad_capsule_decal(decal.frame, at, decal.half_length, decal.size.x, {})", fade)
          : fmt::format("surfgrad_sphere_decal(decal.frame, at, decal.size.x, {})", fade);
  const std::string sampled =
      g.exact() ? fmt::format("stack_sample_cube({0}, place.lookup, stack_cube_lod({0}, q, q_dx, q_dy))",
                              map.exact_map())
                : fmt::format("(2.0 * sample_cube_grad({}, q, q_dx, q_dy).xyz - 1.0)", map.binding().name);
  return {
      fmt::format(
          "    SurfgradDecalDirection place = {};\n"
          "    if ({}) {{\n"
          "      vec3 q = stack_in_decal(decal.frame, place.unchanging, at - decal.frame.origin{});\n"
          "      vec3 q_dx = stack_in_decal(decal.frame, place.unchanging, dp_dx);\n"
          "      vec3 q_dy = stack_in_decal(decal.frame, place.unchanging, dp_dy);\n"
          "      vec3 n = {};\n"
          "      vec3 v = n.x * decal.frame.axis_x + n.y * decal.frame.axis_y + n.z * decal.frame.axis_z;\n"
          "      vec3 gradient = surfgrad_decal_gradient_from_normal(place, v);\n",
          shape, inside_of(layer, g),
          capsule ? " - clamp(dot(at - decal.frame.origin, decal.frame.axis_x), -decal.half_length, "
                    "decal.half_length) * decal.frame.axis_x"
                  : "",
          sampled),
      ""};
}

/// What the loop over decals carries: only what their blends need.
class Blending {
 public:
  /// tracks   whether what slopes hide is summed, too
  /// project  the surface gradient of `waiting`, as an expression
  Blending(const stack::DecalLayer& layer, bool tracks, std::string project)
      : layer_(layer), adds_(has(layer, stack::DecalBlend::add)), mixes_(has(layer, stack::DecalBlend::mix)),
        replaces_(has(layer, stack::DecalBlend::replace)), tracks_(tracks), project_(std::move(project)) {}

  /// Before the loop.
  [[nodiscard]] std::string begin() const {
    return fmt::format("{}{}{}{}", replaces_ ? "  vec3 result = sum;\n" : "",
                       tracks_ ? "  float hidden = variance;\n" : "", mixes_ ? "  float factor = 1.0;\n" : "",
                       waits() ? "  vec3 waiting = vec3(0.0, 0.0, 0.0);\n" : "");
  }

  /// The sum, with all that waits to be projected.
  [[nodiscard]] std::string all() const {
    const std::string so_far = fmt::format("{}{}", mixes_ ? "factor * " : "", replaces_ ? "result" : "sum");
    return waits() ? fmt::format("{} + {}", so_far, project_) : so_far;
  }

  /// How `gradient` joins.
  [[nodiscard]] std::string lines(const std::string& variance, bool world) const {
    std::string lines = "      float w = place.falloff * weight * decal.opacity;\n";
    if (tracks_) lines += variance_line(variance);
    if (!waits()) return lines + replace_lines("      ", world);
    if (!replaces_) return lines + wait_lines("      ");
    return lines + "      if (decal.blend > 1.5) {\n" + replace_lines("        ", world) +
           "      } else {\n" + wait_lines("        ") + "      }\n";
  }

 private:
  [[nodiscard]] bool waits() const { return adds_ || mixes_; }

  [[nodiscard]] std::string variance_line(const std::string& variance) const {
    const std::string kept = !mixes_ && !replaces_ ? "hidden"
                             : adds_ ? "stack_square(select(decal.blend > 0.5, 1.0 - w, 1.0)) * hidden"
                                     : "stack_square(1.0 - w) * hidden";
    const std::string own =
        variance.empty() ? "" : fmt::format(" + stack_square(w * decal.scale) * {}", variance);
    return fmt::format("      hidden = {}{};\n", kept, own);
  }

  /// Of the direction only its part along the surface of the decal bends.
  [[nodiscard]] std::string replace_lines(const std::string& indent, bool world) const {
    const char* outward = is_cube(layer_.shape) ? "place.direction" : "decal.outward";
    const std::string bent =
        world ? fmt::format("{} - bent", outward)
              : fmt::format("surfgrad_transform_normal(s.world_from_object, {} - bent)", outward);
    return fmt::format("{0}vec3 bent = decal.scale * surfgrad_from_volume_gradient({1}, gradient);\n"
                       "{0}vec3 g = surfgrad_from_perturbed_normal(frame.normal, {2});\n"
                       "{0}result = (1.0 - w) * {3} + w * g;\n"
                       "{4}{5}",
                       indent, outward, bent, waits() ? fmt::format("({})", all()) : all(),
                       mixes_ ? fmt::format("{}factor = 1.0;\n", indent) : "",
                       waits() ? fmt::format("{}waiting = vec3(0.0, 0.0, 0.0);\n", indent) : "");
  }

  [[nodiscard]] std::string wait_lines(const std::string& indent) const {
    if (!mixes_) return fmt::format("{}waiting = waiting + (w * decal.scale) * gradient;\n", indent);
    return fmt::format("{0}float keep = {1};\n"
                       "{0}factor = keep * factor;\n"
                       "{0}waiting = keep * waiting + (w * decal.scale) * gradient;\n",
                       indent, adds_ ? "select(decal.blend > 0.5, 1.0 - w, 1.0)" : "1.0 - w");
  }

  const stack::DecalLayer& layer_;
  bool adds_, mixes_, replaces_, tracks_;
  std::string project_;
};

// Placement: as engine/layers/decal.cpp places them.

struct Axes {
  vec3<double> origin{}, s{}, t{}, outward{};
  vec3<double> scale{1, 1, 1};
};

Axes axes_of(const stack::DecalPlacement& p) {
  Axes axes;
  if (p.transform) {
    const std::array<double, 16>& m = *p.transform;
    const vec3<double> x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
    axes.outward = normalize_or_zero(z);
    axes.s = normalize_or_zero(x - dot(x, axes.outward) * axes.outward);
    const vec3<double> t = cross(axes.outward, axes.s);
    axes.t = dot(t, y) < 0 ? -t : t;
    axes.origin = {m[12], m[13], m[14]};
    axes.scale = {length(x), length(y), length(z)};
    return axes;
  }
  axes.outward = -normalize_or_zero(p.direction);
  constexpr double vertical = 1e-9; // nearer to the vertical rounding would turn the image
  const vec3<double> across = cross(vec3<double>{0, 1, 0}, axes.outward);
  const vec3<double> s = max_abs(across) < vertical ? vec3<double>{1, 0, 0} : across;
  const vec3<double> upright_s = normalize_or_zero(s - dot(s, axes.outward) * axes.outward);
  const vec3<double> upright_t = cross(axes.outward, upright_s);
  const SinCos<double> turn = sin_cos_turns(std::remainder(p.roll_deg, 360.0) / 360);
  axes.s = turn.cos * upright_s + turn.sin * upright_t;
  axes.t = turn.cos * upright_t - turn.sin * upright_s;
  axes.origin = p.position;
  return axes;
}

/// The five vec4 of a decal (support.glsl, StackDecal).
std::array<float, 20> packed(const stack::DecalLayer& layer, const stack::DecalInstance& instance) {
  const Axes axes = axes_of(instance);
  const double scale = axes.scale.x; // of all axes, but for a box
  const bool projects = layer.shape == stack::DecalShape::cone || layer.shape == stack::DecalShape::wedge;
  const vec3<double> z = projects ? -axes.outward : axes.outward;
  vec3<double> size{};
  if (layer.shape == stack::DecalShape::box) {
    size = 0.5 * vec3<double>{axes.scale.x * instance.size.x, axes.scale.y * instance.size.y,
                              axes.scale.z * instance.size.z};
  } else if (projects) {
    const SinCos<double> half_angle = sin_cos_turns(instance.angle_deg / 720);
    size = {half_angle.sin / half_angle.cos, scale * instance.depth, 0};
  } else {
    size = {scale * instance.radius, 0, 0};
  }
  const std::array<double, 20> values{
      axes.origin.x, axes.origin.y, axes.origin.z, 0.5 * scale * instance.length,
      axes.s.x,      axes.s.y,      axes.s.z,      instance.scale.value_or(layer.common.scale),
      axes.t.x,      axes.t.y,      axes.t.z,      instance.opacity.value_or(layer.common.opacity),
      z.x,           z.y,           z.z,           static_cast<double>(blend_of(layer, instance)),
      size.x,        size.y,        size.z,        projects ? -1.0 : 1.0};
  std::array<float, 20> result{};
  std::transform(values.begin(), values.end(), result.begin(),
                 [](double v) { return static_cast<float>(v); });
  return result;
}

void append_instances(const stack::DecalLayer& layer, Generator& g) {
  Shader& shader = g.shader();
  for (const stack::DecalInstance& instance : layer.instances) {
    const std::array<float, 20> values = packed(layer, instance);
    static_assert(sizeof values == bytes_a_decal);
    const std::size_t end = shader.decal_data.size();
    shader.decal_data.resize(end + sizeof values);
    std::memcpy(shader.decal_data.data() + end, values.data(), sizeof values);
    ++shader.decal_count;
  }
  const Options& options = g.options();
  const bool glsl = options.language == Language::glsl && !g.exact();
  const int most = options.language == Language::godot || (glsl && options.es) ? most_decals_es : most_decals;
  const auto fault = [&](std::string remedy) {
    return InputError({.file = options.document,
                       .line = layer.common.line,
                       .place = layer.common.key,
                       .problem = fmt::format("brings the stack to {} decals", shader.decal_count),
                       .remedy = std::move(remedy)});
  };
  // A device says itself what its buffers hold.
  if (!g.exact() && shader.decal_count > most)
    throw fault(fmt::format("a shader in this language takes {}", most));
  if (glsl && shader.beyond_es.empty() && shader.decal_count > most_decals_es)
    shader.beyond_es =
        fault(fmt::format("the code compiles as GLSL 450 alone, as ES takes {}", most_decals_es)).what();
}

} // namespace

void write(const stack::DecalLayer& layer, Generator& g) {
  const bool world = layer.space == stack::Space::world;
  const int first = g.shader().decal_count;
  append_instances(layer, g);
  const std::string fade =
      g.parameter("falloff", "fraction of the shape over which decals fade", layer.falloff);
  const std::string weight = weight_of(g, layer.common, "1.0");
  const std::string dx = g.surface(Role::dp_dx), dy = g.surface(Role::dp_dy);
  std::string at = g.surface(Role::position), at_dx = dx, at_dy = dy, origin = "vec3(0.0, 0.0, 0.0)";
  if (world) {
    origin = g.surface(Role::world_origin);
  } else {
    const std::string inverse = g.surface(Role::object_from_world);
    if (g.options().diagnostics) g.degenerate_once(fmt::format("stack_is_zero({})", inverse));
    static_cast<void>(g.surface(Role::world_from_object));
    at = g.shared("object_at", "vec3",
                  fmt::format("product({}, {} - {})", inverse, at, g.surface(Role::object_origin)));
    at_dx = g.shared("object_dp_dx", "vec3", fmt::format("product({}, {})", inverse, dx));
    at_dy = g.shared("object_dp_dy", "vec3", fmt::format("product({}, {})", inverse, dy));
  }
  const std::string waiting =
      world ? "surfgrad_from_volume_gradient(frame.normal, waiting)"
            : "stack_from_object_gradient(s.world_from_object, s.object_from_world, frame.normal, waiting)";
  const Addition addition =
      is_cube(layer.shape) ? cube_addition(layer, g, fade) : image_addition(layer, g, fade);
  const bool yields = has(layer, stack::DecalBlend::mix) || has(layer, stack::DecalBlend::replace);
  const bool tracks = !addition.variance.empty() || (yields && !g.variance().empty());
  const Blending blending(layer, tracks, waiting);
  const std::string result = blending.all();
  const std::string function = g.function(
      g.global() + "_decals",
      fmt::format("// Volume gradients of decals are summed, then projected once.\n"
                  "{} @(StackSurface s, SurfgradFrame frame, vec3 at, vec3 dp_dx, vec3 dp_dy, vec3 origin, "
                  "vec3 sum, {}float weight) {{\n"
                  "{}"
                  "  for (int i = {}; i < {}; ++i) {{\n"
                  "    StackDecal decal = stack_decal(i, origin);\n"
                  "{}{}"
                  "    }}\n"
                  "  }}\n"
                  "{}"
                  "}}\n",
                  tracks ? "vec4" : "vec3", tracks ? "float variance, " : "", blending.begin(), first,
                  g.shader().decal_count, addition.lines, blending.lines(addition.variance, world),
                  tracks ? fmt::format("  vec3 blended = {};\n  return vec4(blended.x, blended.y, blended.z, "
                                       "hidden);\n",
                                       result)
                         : fmt::format("  return {};\n", result)));
  const std::string sum = g.sum().empty() ? "vec3(0.0, 0.0, 0.0)" : g.sum();
  const auto call = [&](const std::string& variance) {
    return fmt::format("{}(s, {}, {}, {}, {}, {}, {}, {}{})", function, g.frame(), at, at_dx, at_dy, origin,
                       sum, variance, weight);
  };
  if (!tracks) {
    g.set_sum(call(""));
    return;
  }
  const std::string both =
      g.value("decals", "vec4", call(g.variance().empty() ? "0.0, " : g.variance() + ", "));
  g.set_sum(both + ".xyz");
  g.set_variance(both + ".w");
}

} // namespace surfgrad::shadergen
