// Three projections blended by the base normal: the definition on analytic surfaces under every convention,
// whole normals, transforms, passes.

#include "projection.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Sphere;
using surfgrad::test::Torus;
using surfgrad::test::Worst;
using test::composed;
using test::Quadratic;
using test::triplanar_layer;
using test::vec2d;
using test::vec3d;

/// A few dozen roundings of double of values of order ten.
constexpr double exact = 1e-13;
/// Maps of directions and of normals are stored in float and rounded once.
constexpr double stored = 2 * std::numeric_limits<float>::epsilon();

/// Heights over (y, z), (x, z) and (x, y): what the planes of x, y and z hold, whatever the convention.
struct Heights {
  Quadratic x, y, z;
  explicit Heights(test::Random& random) : x(random), y(random), z(random) {}

  template <class T>
  [[nodiscard]] T operator()(vec3d weights, vec3<T> p) const {
    return T(weights.x) * x(vec2<T>{p.y, p.z}) + T(weights.y) * y(vec2<T>{p.x, p.z}) +
           T(weights.z) * z(vec2<T>{p.x, p.y});
  }
};

/// One coordinate of a plane: a component of the position, or its negative.
struct Component {
  int index; ///< 0 to 2 for x to z
  double sign;
};
struct PlaneOf {
  Component s, t;
};
struct ConventionCase {
  stack::Convention convention;
  std::array<PlaneOf, 3> planes;
};

/// What section 2.8 and Golubev's equation 46 say, written out.
std::vector<ConventionCase> conventions() {
  using enum Handedness;
  using enum TextureOrigin;
  using enum TriplanarPlanes;
  const Component x{0, 1}, y{1, 1}, z{2, 1}, not_x{0, -1}, not_y{1, -1}, not_z{2, -1};
  return {{{left, lower_left, mikkelsen}, {{{z, y}, {x, z}, {x, y}}}},
          {{right, lower_left, mikkelsen}, {{{not_z, y}, {x, not_z}, {x, y}}}},
          {{left, upper_left, mikkelsen}, {{{z, not_y}, {x, not_z}, {x, not_y}}}},
          {{right, upper_left, mikkelsen}, {{{not_z, not_y}, {x, z}, {x, not_y}}}},
          {{left, lower_left, golubev}, {{{y, z}, {z, x}, {x, y}}}},
          {{right, lower_left, golubev}, {{{y, z}, {z, x}, {x, y}}}},
          {{left, upper_left, golubev}, {{{y, not_z}, {z, not_x}, {x, not_y}}}},
          {{right, upper_left, golubev}, {{{y, not_z}, {z, not_x}, {x, not_y}}}}};
}

/// The image of a plane's height as that convention lays it: its heights, or its slopes.
image::Image image_of(const Quadratic& height, int axis, PlaneOf plane, bool slopes) {
  const int first = axis == 0 ? 1 : 0; // of the two components that the height is over
  return test::image_of([&](vec2d st) {
    const vec2d q = plane.s.index == first ? vec2d{plane.s.sign * st.x, plane.t.sign * st.y}
                                           : vec2d{plane.t.sign * st.y, plane.s.sign * st.x};
    if (!slopes) return vec3d{height(q), 0, 0};
    const vec2d d = height.gradient(q);
    return plane.s.index == first ? vec3d{plane.s.sign * d.x, plane.t.sign * d.y, 0}
                                  : vec3d{plane.s.sign * d.y, plane.t.sign * d.x, 0};
  });
}

struct Triplanars : ::testing::Test {
  static constexpr std::uint64_t seed = 181;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};

  /// One value in all texels of a map.
  void add_constant(const char* name, vec3d value) {
    lab.add(name, surfgrad::test::constant_image(2, 2, value));
  }
};

TEST_F(Triplanars,
       ComposeBlinnsNormalUnderEveryConvention) { // listings 13 and 14, equation 7; Golubev, 46 to 49
  const auto check = [&](const auto& surface, const char* name) {
    for (const ConventionCase& c : conventions())
      for (const bool slopes : {false, true}) {
        Worst worst(std::string("Blinn's normal on a ") + name + (slopes ? ", slopes" : ", heights"));
        const Heights heights(random);
        lab.add("x", image_of(heights.x, 0, c.planes[0], slopes));
        lab.add("y", image_of(heights.y, 1, c.planes[1], slopes));
        lab.add("z", image_of(heights.z, 2, c.planes[2], slopes));
        stack::TriplanarLayer layer = triplanar_layer(
            {"x", "y", "z"}, slopes ? stack::TriplanarContent::derivative : stack::TriplanarContent::height);
        test::lay(layer.map);
        layer.convention = c.convention;
        layer.sharpness = random.uniform(0.5, 20);
        const Program program = lab.compile({layer});
        for (long k = 0; k < 100; ++k) {
          const auto p = random_point(surface, random);
          const vec3d w = triplanar_weights(p.normal, layer.sharpness);
          worst.add(composed(program, test::fragment_of(p, random)).normal,
                    test::blinn_normal(surface, p, [&](auto q) { return heights(w, q); }), exact, k);
        }
      }
  };
  check(Sphere{1.5}, "sphere");
  check(Torus{1, 0.5}, "torus");
}

TEST_F(Triplanars, ShowNoMirroredImageFromTheAxesByDefault) {
  add_constant("right", {0.5, 0, 0});
  add_constant("up", {0, 0.5, 0});
  const auto turn_of = [&](stack::Convention convention, vec3d axis) {
    auto f = test::random_fragment(random);
    f.normal = axis;
    const auto g = [&](const char* map) {
      stack::TriplanarLayer layer = triplanar_layer({map}, stack::TriplanarContent::derivative);
      layer.convention = convention;
      return 2.0 * composed(lab.compile({layer}), f).surfgrad;
    };
    return dot(cross(g("right"), g("up")), axis);
  };
  for (const vec3d axis : {vec3d{1, 0, 0}, vec3d{0, 1, 0}, vec3d{0, 0, 1}}) {
    EXPECT_NEAR(turn_of({}, axis), 1, exact);
    EXPECT_NEAR(turn_of({.planes = TriplanarPlanes::golubev}, axis), 1, exact);
    // Listing 13 as printed is for left-handed spaces.
    EXPECT_NEAR(turn_of({.handedness = Handedness::left}, axis), axis.z == 1 ? 1 : -1, exact);
  }
}

TEST_F(Triplanars, FacingAnAxisArePlanar) {
  lab.add("map", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  lab.add("other", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  Worst worst("normal of a single plane");
  const PlaneAxis axes[] = {PlaneAxis::x, PlaneAxis::y, PlaneAxis::z};
  for (long k = 0; k < 200; ++k) {
    const int i = random.integer(3);
    auto f = test::random_fragment(random);
    // The weight of a component below 0.2 is zero.
    const vec3d tilt = 0.1 * random.vector3();
    f.normal =
        normalize_or_zero(tilt + random.sign() * vec3d{i == 0 ? 1.0 : 0, i == 1 ? 1.0 : 0, i == 2 ? 1.0 : 0});
    const vec3d expected = composed(lab.compile({test::planar_layer("map", axes[i])}), f).normal;
    worst.add(composed(lab.compile({triplanar_layer({"map"})}), f).normal, expected, exact, k);
    std::vector<const char*> maps(3, "other");
    maps[static_cast<std::size_t>(i)] = "map";
    worst.add(composed(lab.compile({triplanar_layer(maps)}), f).normal, expected, exact, k);
  }
}

TEST_F(Triplanars, OfWholeNormalsAreEquation45) {
  Worst worst("weighted sum of object-space normals, as layers of their own");
  for (long k = 0; k < 300; ++k) {
    const auto f = test::random_fragment(random);
    const mat3<double> m =
        k % 3 == 0 ? test::identity : random.rotation() * mat3<double>{{2, 0, 0}, {0, -0.5, 0}, {0, 0, 1}};
    const vec3d in_object = normalize_or_zero(transpose(m) * f.normal);
    for (const char* name : {"x", "y", "z"})
      add_constant(name, 0.5 * normalize_or_zero(in_object + 0.5 * random.vector3()) + vec3d{0.5, 0.5, 0.5});
    for (const bool world : {false, true}) {
      stack::TriplanarLayer layer = triplanar_layer({"x", "y", "z"}, stack::TriplanarContent::object_normal);
      layer.space = world ? stack::Space::world : stack::Space::object;
      // Projections of equal maps would blend by the weights that add up to 1.
      const vec3d w = triplanar_weights(world ? normalize_or_zero(f.normal) : in_object);
      std::vector<stack::Layer> separate;
      for (const auto& [name, weight] : {std::pair{"x", w.x}, std::pair{"y", w.y}, std::pair{"z", w.z}}) {
        stack::ObjectNormalMapLayer one = test::object_layer(name, layer.space);
        one.common.opacity = weight;
        separate.emplace_back(one);
      }
      const auto expected = composed(lab.compile(separate), f, BackFaces::same, m);
      worst.add(composed(lab.compile({layer}), f, BackFaces::same, m).normal, expected.normal,
                exact * (1 + max_abs(expected.surfgrad)), k);
    }
  }
}

TEST_F(Triplanars, OfTheSurfacesOwnNormalsAddNothing) {
  // Flat facets of any direction hold their normal exactly; a sphere's plane holds it between texels.
  Worst worst("gradient of the own normal");
  for (long k = 0; k < 200; ++k) {
    const vec3d n = random.unit_vector();
    add_constant("own", 0.5 * n + vec3d{0.5, 0.5, 0.5});
    auto f = test::random_fragment(random);
    const mat3<double> m = random.rotation() * mat3<double>{{2, 0, 0}, {0, -0.5, 0}, {0, 0, 1}};
    f.normal = transform_normal(m, n);
    const Program program = lab.compile({triplanar_layer({"own"}, stack::TriplanarContent::object_normal)});
    // A scale of 1:4 magnifies the rounding of the stored normal.
    worst.add(composed(program, f, BackFaces::same, m).surfgrad, {0, 0, 0}, 8 * stored, k);
  }
  // The octant of a sphere that every plane sees once.
  Worst sphere("gradient of a sphere's own normals, degrees");
  const auto plane = [&](int axis) {
    return test::image_of([&](vec2d st) { // in [0, 1] on the plane of the default convention
      const vec2d q{axis == 0 ? -st.x : st.x, axis == 1 ? -st.y : st.y};
      const double along = std::sqrt(std::max(0.0, 1 - dot(q, q)));
      const vec3d n = axis == 0   ? vec3d{along, q.y, q.x}
                      : axis == 1 ? vec3d{q.x, along, q.y}
                                  : vec3d{q.x, q.y, along};
      return 0.5 * normalize_or_zero(n) + vec3d{0.5, 0.5, 0.5};
    });
  };
  lab.add("x", plane(0));
  lab.add("y", plane(1));
  lab.add("z", plane(2));
  stack::TriplanarLayer layer = triplanar_layer({"x", "y", "z"}, stack::TriplanarContent::object_normal);
  test::lay(layer.map);
  layer.sharpness = 8; // keeps to planes that face the surface, where texels lie close on it
  const Program program = lab.compile({layer});
  for (long k = 0; k < 300; ++k) {
    auto f = test::random_fragment(random);
    const vec3d n = random.unit_vector();
    f.normal = f.object_position = {std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    const vec3d got = composed(program, f).normal;
    // Linear between texels of 1/8 of the radius: sagitta (1/8)^2 / 8 times a curvature of up to 1 / 0.58^3.
    sphere.add(57.3 * length(cross(got, f.normal)), 0, 57.3 * 0.01, k);
  }
}

TEST_F(Triplanars, WithoutADirectionAreFlaggedOnlyWhereThePlaneCounts) {
  add_constant("none", {0.5, 0.5, 0.5});
  add_constant("up", {0.5, 0.5, 1});
  const Program program =
      lab.compile({triplanar_layer({"none", "up", "up"}, stack::TriplanarContent::object_normal)});
  auto f = test::random_fragment(random);
  f.normal = {0, 0, 1};
  EXPECT_FALSE(composed(program, f).degenerate);
  f.normal = normalize_or_zero(vec3d{1, 0, 1});
  EXPECT_TRUE(composed(program, f).degenerate);
  f.normal = {1, 0, 0};
  const auto c = composed(program, f);
  EXPECT_TRUE(c.degenerate);
  EXPECT_EQ(length(c.surfgrad), 0);
}

TEST_F(Triplanars, WithGreenDownNegateYOfWholeNormals) {
  add_constant("map", {0.5, 0.75, 1});
  stack::TriplanarLayer layer = triplanar_layer({"map"}, stack::TriplanarContent::object_normal);
  layer.map.green = stack::Green::down;
  auto f = test::random_fragment(random);
  f.normal = {0, 0, 1};
  EXPECT_LT(max_abs(composed(lab.compile({layer}), f).normal - normalize_or_zero(vec3d{0, -0.5, 1})), stored);
}

TEST_F(Triplanars, InObjectSpaceFollowTheObject) {
  Worst worst("normal of the moved object");
  lab.add("x", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  lab.add("y", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  lab.add("z", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  for (const auto content : {stack::TriplanarContent::normal, stack::TriplanarContent::height,
                             stack::TriplanarContent::object_normal}) {
    stack::TriplanarLayer layer = triplanar_layer({"x", "y", "z"}, content);
    if (content == stack::TriplanarContent::height) layer.map.height = 0.02;
    if (content == stack::TriplanarContent::object_normal) layer.common.scale = 0.2;
    layer.map.filter = stack::Filter::bilinear;
    const Program program = lab.compile({layer});
    for (long k = 0; k < 300; ++k) {
      auto f = test::random_fragment(random);
      f.normal = normalize_or_zero(f.normal);
      const vec3d g = composed(program, f).surfgrad;
      const double size = random.magnitude(1e-6, 1e6);
      const mat3<double> r = random.rotation();
      const mat3<double> similar{random.sign() * size * r.x, random.sign() * size * r.y, size * r.z};
      // Whole normals blend in world space, where layers do: a stretch weighs them differently there.
      const bool stretches = k % 2 == 0 && content != stack::TriplanarContent::object_normal;
      const mat3<double> m = stretches ? test::random_stretch(random) : similar;
      const auto got = composed(program, test::moved(f, m), BackFaces::same, m);
      // A direction may lie nearly in the surface: relative to the gradient's size.
      worst.add(got.normal, test::transformed_normal(m, f.normal, g),
                exact * (1 + dot(g, g) + dot(got.surfgrad, got.surfgrad)), k);
    }
  }
}

TEST_F(Triplanars, InWorldSpaceOfAnObjectAtRestAreThoseInObjectSpace) {
  Worst worst("object against world space");
  lab.add("x", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  for (const auto content : {stack::TriplanarContent::normal, stack::TriplanarContent::height,
                             stack::TriplanarContent::object_normal}) {
    stack::TriplanarLayer layer = triplanar_layer({"x"}, content);
    const Program in_object = lab.compile({layer});
    layer.space = stack::Space::world;
    const Program in_world = lab.compile({layer});
    for (long k = 0; k < 200; ++k) {
      const auto f = test::random_fragment(random);
      const auto expected = composed(in_object, f);
      worst.add(composed(in_world, f).normal, expected.normal, exact * (1 + max_abs(expected.surfgrad)), k);
    }
  }
}

TEST_F(Triplanars, BlendByTheNormalThatAResolveLeft) { // section 2.8, figure 3(b)
  // A first pass turns the normal from one axis to another; the projection along that one is what shows.
  add_constant("flat", {0.5, 0.5, 1});
  lab.add("bumps", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  add_constant("to_y", {0.5, 1, 0.5});
  const std::vector<stack::Layer> turn{test::object_layer("to_y", stack::Space::world),
                                       stack::ResolveLayer{}};
  const auto after = [&](std::vector<const char*> maps) {
    std::vector<stack::Layer> layers = turn;
    layers.emplace_back(triplanar_layer(maps));
    return lab.compile(layers);
  };
  auto f = test::random_fragment(random);
  f.normal = normalize_or_zero(vec3d{1, 0.1, 0}); // before, only the plane of x has a weight
  EXPECT_LT(max_abs(composed(after({"bumps", "flat", "bumps"}), f).normal - vec3d{0, 1, 0}), exact);
  EXPECT_GT(max_abs(composed(after({"flat", "bumps", "flat"}), f).normal - vec3d{0, 1, 0}), 0.01);
}

TEST_F(Triplanars, OnBackFacesAreTheSameSurfaceGradient) {
  Worst worst("gradient on a face seen from behind");
  lab.add("x", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  for (const auto content : {stack::TriplanarContent::normal, stack::TriplanarContent::object_normal}) {
    const Program program = lab.compile({triplanar_layer({"x"}, content)});
    for (long k = 0; k < 200; ++k) {
      auto f = test::random_fragment(random);
      const vec3d n = normalize_or_zero(f.normal);
      const vec3d g = composed(program, f).surfgrad;
      const double bound = exact * (1 + dot(g, g));
      f.front_facing = false;
      worst.add(composed(program, f).normal, normalize_or_zero(n - g), bound, k);
      worst.add(composed(program, f, BackFaces::mirror).normal, normalize_or_zero(-n - g), bound, k);
      worst.add(composed(program, f, BackFaces::flip).normal, normalize_or_zero(g - n), bound, k);
    }
  }
}

TEST_F(Triplanars, DoNotReachLanesWherePlanesHaveNoWeight) {
  using simd::EmulatedFloat;
  // The facet's own normal adds nothing; the sign of that zero shows what else was added.
  add_constant("x", {1, 0.5, 0.5});
  add_constant("other", {1, 0.2, 0.2});
  for (const auto content : {stack::TriplanarContent::normal, stack::TriplanarContent::object_normal}) {
    const Program program = lab.compile({triplanar_layer({"x", "other", "other"}, content)});
    const auto& layer = std::get<Triplanar>(program.layers[0]);
    const Placement placement = test::placed(test::identity);
    raster::Fragment<EmulatedFloat> in_lanes{};
    raster::Fragment<float> fragment{};
    Point<EmulatedFloat> pack{in_lanes, {}, placement};
    Point<float> alone{fragment, {}, placement};
    pack.frame.normal = {EmulatedFloat(1), EmulatedFloat(-0.0F), EmulatedFloat(-0.0F)};
    alone.frame.normal = {1, -0.0F, -0.0F};
    for (int i = 1; i < simd::emulated_width; ++i) { // all lanes but the first see the other planes
      pack.frame.normal.x.lane[i] = 0;
      (i % 2 == 0 ? pack.frame.normal.y : pack.frame.normal.z).lane[i] = i < 4 ? 1.0F : -1.0F;
    }
    simd::EmulatedMask flags{};
    bool flag = false;
    const vec3<EmulatedFloat> got = surface_gradient(layer, pack, flags);
    const vec3<float> expected = surface_gradient(layer, alone, flag);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(got.x.lane[0]), std::bit_cast<std::uint32_t>(expected.x));
    EXPECT_EQ(std::bit_cast<std::uint32_t>(got.y.lane[0]), std::bit_cast<std::uint32_t>(expected.y));
    EXPECT_EQ(std::bit_cast<std::uint32_t>(got.z.lane[0]), std::bit_cast<std::uint32_t>(expected.z));
  }
}

TEST_F(Triplanars, OfDegenerateFragmentsAreFlaggedAndFlat) {
  lab.add("x", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  for (const auto content : {stack::TriplanarContent::normal, stack::TriplanarContent::object_normal}) {
    const Program program = lab.compile({triplanar_layer({"x"}, content)});
    auto f = test::random_fragment(random);
    const auto flattened = composed(program, f, BackFaces::same, {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}});
    EXPECT_TRUE(flattened.degenerate);
    EXPECT_NEAR(length(flattened.normal), 1, exact);
    f.normal = f.dp_dx = f.dp_dy = {0, 0, 0};
    const auto absent = composed(program, f);
    EXPECT_TRUE(absent.degenerate);
    EXPECT_EQ(length(absent.normal), 0);
  }
}

} // namespace
} // namespace surfgrad::engine
