#include "conformance/inputs.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

namespace surfgrad::test {

using F = ShaderInputs<float>;

// Members of a standard-layout aggregate of floats.
#define SURFGRAD_FIELD(name, member, kind)                                                                   \
  Field { #name, kind, offsetof(F, member) / sizeof(float), sizeof(F::member) / sizeof(float) }
#define SURFGRAD_CORE_FIELD(name, kind)                                                                      \
  Field {                                                                                                    \
#name, kind, offsetof(F, core.name) / sizeof(float), sizeof(CoreInputs <float>::name) / sizeof(float)    \
  }

const std::vector<Field>& fields() {
  static const std::vector<Field> all{
      SURFGRAD_CORE_FIELD(frame, "_frame"),
      SURFGRAD_CORE_FIELD(raw_normal, "3"),
      SURFGRAD_CORE_FIELD(raw_tangent, "3"),
      SURFGRAD_CORE_FIELD(sign, "1"),
      SURFGRAD_CORE_FIELD(tangent, "3"),
      SURFGRAD_CORE_FIELD(bitangent, "3"),
      SURFGRAD_CORE_FIELD(perturbed, "3"),
      SURFGRAD_CORE_FIELD(dp_du, "3"),
      SURFGRAD_CORE_FIELD(dp_dv, "3"),
      SURFGRAD_CORE_FIELD(gradient, "3"),
      SURFGRAD_CORE_FIELD(direction, "3"),
      SURFGRAD_CORE_FIELD(position, "3"),
      SURFGRAD_CORE_FIELD(dn_dx, "3"),
      SURFGRAD_CORE_FIELD(dn_dy, "3"),
      SURFGRAD_CORE_FIELD(weights, "3"),
      SURFGRAD_CORE_FIELD(tangent_normal, "3"),
      SURFGRAD_CORE_FIELD(xy_normal, "2"),
      SURFGRAD_CORE_FIELD(dst_dx, "2"),
      SURFGRAD_CORE_FIELD(dst_dy, "2"),
      SURFGRAD_CORE_FIELD(texture_offset, "2"),
      SURFGRAD_CORE_FIELD(size, "2"),
      SURFGRAD_CORE_FIELD(deriv, "2"),
      SURFGRAD_CORE_FIELD(deriv_y, "2"),
      SURFGRAD_CORE_FIELD(deriv_z, "2"),
      SURFGRAD_CORE_FIELD(dh_duv, "2"),
      SURFGRAD_CORE_FIELD(height, "1"),
      SURFGRAD_CORE_FIELD(height_x, "1"),
      SURFGRAD_CORE_FIELD(height_y, "1"),
      SURFGRAD_CORE_FIELD(bump_scale, "1"),
      SURFGRAD_CORE_FIELD(scale, "1"),
      SURFGRAD_CORE_FIELD(texels, "_mat4"),
      SURFGRAD_CORE_FIELD(fraction, "2"),
      SURFGRAD_CORE_FIELD(rotation, "_mat3"),
      SURFGRAD_CORE_FIELD(matrix, "_mat3"),
      SURFGRAD_CORE_FIELD(world_from_screen, "_mat4"),
      SURFGRAD_CORE_FIELD(x, "1"),
      SURFGRAD_CORE_FIELD(y, "1"),
      SURFGRAD_FIELD(decal_origin, decal_origin, "3"),
      SURFGRAD_FIELD(point, point, "3"),
      SURFGRAD_FIELD(half_size, half_size, "3"),
      SURFGRAD_FIELD(half_length, half_length, "1"),
      SURFGRAD_FIELD(tan_half_angle, tan_half_angle, "1"),
      SURFGRAD_FIELD(range, range, "1"),
      SURFGRAD_FIELD(radius, radius, "1"),
      SURFGRAD_FIELD(fade, fade, "1"),
      SURFGRAD_FIELD(place, place, "3"),
      SURFGRAD_FIELD(width, width, "1"),
      SURFGRAD_FIELD(plane, plane, "2"),
      SURFGRAD_FIELD(height_map, height_map, "2"),
      SURFGRAD_FIELD(turn, turn, "1"),
      SURFGRAD_FIELD(exponent, exponent, "1"),
      SURFGRAD_FIELD(positive, positive, "1"),
      SURFGRAD_FIELD(alpha, alpha, "1"),
      SURFGRAD_FIELD(far, far, "2"),
  };
  return all;
}

const Field& field(std::string_view name) {
  for (const Field& each : fields())
    if (each.name == name) return each;
  throw std::out_of_range("no input is called " + std::string(name));
}

ShaderInputs<float> random_shader_inputs(Random& random) {
  const auto number = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
  F in;
  in.core = random_inputs<float>(random);
  in.decal_origin = convert<float>(random.vector3(-0.2, 0.2));
  in.point = convert<float>(random.vector3(-1, 1));
  in.half_size = convert<float>(random.vector3(0.5, 1.2));
  in.half_length = number(0.1, 0.6);
  in.tan_half_angle = number(0.3, 1.5);
  in.range = number(0.5, 1.5);
  in.radius = number(0.5, 1.5);
  in.fade = number(0.1, 1);
  in.place = convert<float>(random.vector3(-40, 40));
  in.width = number(0, 0.4);
  in.plane = convert<float>(random.vector2(-20, 20));
  in.height_map = convert<float>(random.vector2(-0.5, 0.5));
  in.turn = number(0, 1);
  in.exponent = number(1, 14);
  in.positive = static_cast<float>(random.magnitude(1e-2, 1e2));
  in.alpha = number(0.05, 1);
  in.far = convert<float>(vec2<double>{random.uniform(-100, 100), random.uniform(-50, 50)});
  return in;
}

std::span<float> values_of(F& in, const Field& f) {
  return {reinterpret_cast<float*>(&in) + f.offset, f.count};
}

namespace {

/// Whole numbers and plain directions: results are exact or nearly so.
F plain_inputs() {
  F in{};
  for (const Field& f : fields()) {
    const std::span<float> v = values_of(in, f);
    for (std::size_t i = 0; i < f.count; ++i) v[i] = 0.25f * static_cast<float>(i + 1);
    if (f.kind == "1") v[0] = 0.5f;
  }
  in.core.raw_normal = {0, 0, 2};
  in.core.direction = {0.6f, 0, 0.8f};
  in.core.dp_du = {1, 0, 0};
  in.core.dp_dv = {0, 1, 0};
  in.core.dst_dx = {1, 0};
  in.core.dst_dy = {0, 1};
  in.core.size = {8, 8};
  in.core.weights = {0.25f, 0.25f, 0.5f};
  const mat3<float> identity{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  in.core.rotation = identity;
  in.core.matrix = identity;
  in.core.world_from_screen = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  in.core.frame = make_frame(vec3<float>{0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  in.half_size = {1, 1, 1};
  in.decal_origin = {0, 0, 0};
  in.point = {0.25f, 0.125f, 0.5f};
  in.tan_half_angle = 1;
  in.range = 1;
  in.radius = 1;
  in.exponent = 7;
  return in;
}

/// A value for all components of a field, with its name.
struct Special {
  const char* name;
  float value;
  Edge edge;
};
const std::vector<Special>& specials() {
  using L = std::numeric_limits<float>;
  static const std::vector<Special> all{
      {"0", 0, Edge::ordinary},
      {"-0", -0.0f, Edge::ordinary},
      {"1", 1, Edge::ordinary},
      {"-1", -1, Edge::ordinary},
      {"-3", -3, Edge::ordinary},
      {"1e12", 1e12f, Edge::ordinary},
      {"1e-12", 1e-12f, Edge::ordinary},
      {"subnormal", L::min() / 4, Edge::extreme},
      {"-subnormal", -L::min() / 4, Edge::extreme},
      {"smallest", L::min(), Edge::extreme},
      {"huge", L::max(), Edge::extreme},
      {"-huge", -L::max(), Edge::extreme},
      {"NaN", L::quiet_NaN(), Edge::infinite},
      {"Inf", L::infinity(), Edge::infinite},
      {"-Inf", -L::infinity(), Edge::infinite},
  };
  return all;
}

/// What functions require to be unit, a rotation or a camera's matrix is turned and mirrored only.
bool is_free(const Field& f) {
  return f.name != "frame" && f.name != "direction" && f.name != "rotation" &&
         f.name != "world_from_screen" && f.name != "weights";
}

void add_frames(std::vector<EdgeCase>& cases) {
  const vec3<float> o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const auto add = [&](const Frame<float>& frame, const char* what, Edge edge = Edge::ordinary) {
    EdgeCase made{plain_inputs(), edge, std::string("frame ") + what};
    made.in.core.frame = frame;
    cases.push_back(made);
  };
  add(make_frame(-z, x, y), "facing away");
  add(make_frame(x, y, z), "edge-on");
  add(make_frame(vec3<float>{1, 0, 1}, x - z, y), "slanted");
  add(make_frame(z, -x, y), "mirrored");
  add(make_frame(z, x, x), "collapsed");
  add(make_frame(z, x, -3.0f * x), "collapsed the other way");
  add(make_frame(z, o, o), "without position");
  add(make_frame(z, x, o), "without dp_dy");
  add(rebase_frame(make_frame(z, x, y), o), "without normal");
  add(make_frame(z, x, y, false, BackFaces::flip), "flipped");
  add(make_frame(z, x, y, false, BackFaces::mirror), "mirror");
  add(make_frame(z, 1e-12f * x, 1e-12f * y), "of tiny pixels");
  add(make_frame(z, 1e12f * x, 1e12f * y), "of huge pixels");
  const float smallest = std::numeric_limits<float>::min();
  add(make_frame(z, smallest * x, smallest * y), "of the smallest pixels", Edge::extreme);
  add(make_frame(z, std::numeric_limits<float>::max() * x, y), "of the hugest pixels", Edge::extreme);
  add(make_frame(vec3<float>{std::numeric_limits<float>::quiet_NaN(), 0, 0}, x, y), "NaN", Edge::infinite);
}

} // namespace

std::vector<EdgeCase> edge_cases(const std::vector<const Field*>& used) {
  std::vector<EdgeCase> cases;
  cases.push_back({plain_inputs(), Edge::ordinary, "plain"});
  const auto with = [&](const Field& f, const Special& special, std::size_t first, std::size_t last) {
    EdgeCase made{plain_inputs(), special.edge,
                  std::string(f.name) + "[" + std::to_string(first) + ".." + std::to_string(last) +
                      "] = " + special.name};
    for (std::size_t i = first; i < last; ++i) values_of(made.in, f)[i] = special.value;
    cases.push_back(made);
  };
  for (const Field* f : used) {
    if (f->name == "frame") add_frames(cases);
    // Bumps that take the whole normal away: nothing is left to normalise.
    if (f->name == "gradient" || f->name == "raw_tangent") {
      EdgeCase made{plain_inputs(), Edge::ordinary, std::string(f->name) + " is the normal"};
      made.in.core.gradient = made.in.core.frame.normal;
      made.in.core.raw_normal = made.in.core.raw_tangent = {0, 0, 8};
      made.in.core.deriv = {1, 0};
      cases.push_back(made);
    }
    if (f->name == "direction" || f->name == "rotation" || f->name == "weights") {
      EdgeCase made{plain_inputs(), Edge::ordinary, std::string(f->name) + " turned"};
      const std::span<float> v = values_of(made.in, *f);
      for (std::size_t i = 0; i < f->count; ++i) v[i] = f->name == "weights" ? (i == 0 ? 1.0f : 0.0f) : -v[i];
      if (f->name == "rotation") made.in.core.rotation = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
      cases.push_back(made);
    }
    if (f->name == "direction")
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f}) {
          EdgeCase made{plain_inputs(), Edge::ordinary,
                        std::string("direction along axis ") + (sign < 0 ? "-" : "") + "xyz"[axis]};
          const std::span<float> v = values_of(made.in, *f);
          for (std::size_t i = 0; i < 3; ++i) v[i] = i == axis ? sign : 0.0f;
          cases.push_back(made);
        }
    if (!is_free(*f)) continue;
    for (const Special& special : specials()) {
      // A position between two texels, or so near a map that a march resolves it.
      if (f->name == "fraction" && std::abs(special.value) > 3 && special.edge == Edge::ordinary) continue;
      with(*f, special, 0, f->count);
      if (f->count > 1)
        for (std::size_t i = 0; i < f->count; ++i) with(*f, special, i, i + 1);
    }
    // Parallel to every other field of its kind, mirrored, and both zero.
    for (const Field* g : used) {
      if (g == f || g->kind != f->kind || !is_free(*g)) continue;
      for (const float factor : {1.0f, -3.0f, 0.0f}) {
        EdgeCase made{plain_inputs(), Edge::ordinary,
                      std::string(g->name) + " = " + std::to_string(factor) + " " + std::string(f->name)};
        if (factor == 0)
          for (std::size_t i = 0; i < f->count; ++i) values_of(made.in, *f)[i] = 0;
        for (std::size_t i = 0; i < f->count; ++i)
          values_of(made.in, *g)[i] = factor * values_of(made.in, *f)[i];
        cases.push_back(made);
      }
    }
  }
  return cases;
}

} // namespace surfgrad::test
