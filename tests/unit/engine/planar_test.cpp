// Images projected along an axis: the definition on analytic surfaces, transforms, footprints.

#include "projection.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Sphere;
using surfgrad::test::Torus;
using surfgrad::test::Worst;
using test::composed;
using test::planar_layer;
using test::Quadratic;
using test::vec2d;
using test::vec3d;

/// A few dozen roundings of double of values of order ten.
constexpr double exact = 1e-13;

/// The coordinates on the plane of an axis, right-handed and seen against it (section 2.8).
template <class T>
vec2<T> coordinates(PlaneAxis axis, vec3<T> p) {
  return axis == PlaneAxis::x   ? vec2<T>{-p.z, p.y}
         : axis == PlaneAxis::y ? vec2<T>{p.x, -p.z}
                                : vec2<T>{p.x, p.y};
}
constexpr PlaneAxis all_axes[] = {PlaneAxis::x, PlaneAxis::y, PlaneAxis::z};
constexpr vec3d direction_of(PlaneAxis axis) {
  return {axis == PlaneAxis::x ? 1.0 : 0.0, axis == PlaneAxis::y ? 1.0 : 0.0,
          axis == PlaneAxis::z ? 1.0 : 0.0};
}

struct Planars : ::testing::Test {
  static constexpr std::uint64_t seed = 171;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};
};

TEST_F(Planars, ComposeBlinnsNormal) { // Golubev, equations 39 to 44
  Worst worst("Blinn's normal under planar maps of heights and of slopes");
  const auto check = [&](const auto& surface) {
    for (const PlaneAxis axis : all_axes) {
      const Quadratic h(random);
      lab.add("heights", test::image_of([&](vec2d st) { return vec3d{h(st), 0, 0}; }));
      lab.add("slopes", test::image_of([&](vec2d st) {
                const vec2d d = h.gradient(st);
                return vec3d{d.x, d.y, 0};
              }));
      stack::PlanarLayer heights = planar_layer("heights", axis, stack::Content::height);
      heights.map.height = 0.5;
      heights.common.scale = 2;
      stack::PlanarLayer slopes = planar_layer("slopes", axis, stack::Content::derivative);
      test::lay(heights.map);
      test::lay(slopes.map);
      const Program of_heights = lab.compile({heights});
      const Program of_slopes = lab.compile({slopes});
      for (long k = 0; k < 200; ++k) {
        const auto p = random_point(surface, random);
        const vec3d expected =
            test::blinn_normal(surface, p, [&](auto q) { return h(coordinates(axis, q)); });
        const auto f = test::fragment_of(p, random);
        worst.add(composed(of_heights, f).normal, expected, exact, k);
        worst.add(composed(of_slopes, f).normal, expected, exact, k);
      }
    }
  };
  check(Sphere{1.5});
  check(Torus{1, 0.5});
}

TEST_F(Planars, FollowTheTransformOfTheMap) { // section 2.5: slopes keep their size, heights do not
  Worst worst("gradient of a height under rotation, tiling and mirroring");
  for (long k = 0; k < 60; ++k) {
    const Quadratic h(random);
    const bool of_heights = k % 2 == 0;
    lab.add("map", test::image_of([&](vec2d st) {
              const vec2d d = h.gradient(st);
              return of_heights ? vec3d{h(st), 0, 0} : vec3d{d.x, d.y, 0};
            }));
    const PlaneAxis axis = all_axes[random.integer(3)];
    stack::PlanarLayer layer =
        planar_layer("map", axis, of_heights ? stack::Content::height : stack::Content::derivative);
    test::lay(layer.map);
    const vec2d times = of_heights ? random.vector2(0.3, 1.2) : vec2d{1, 1};
    const vec2d scale{random.sign() * times.x, random.sign() * times.y};
    layer.map.tile = test::tile * scale;
    layer.map.rotate_deg = random.uniform(-180, 180);
    const double turn = layer.map.rotate_deg * 3.14159265358979324 / 180;
    const Program program = lab.compile({layer});
    for (int i = 0; i < 20; ++i) {
      auto f = test::random_fragment(random);
      f.normal = normalize_or_zero(f.normal);
      const auto height = [&](auto p) {
        using T = decltype(p.x);
        const vec2<T> st = coordinates(axis, p);
        const vec2<T> tiled{T(scale.x) * st.x, T(scale.y) * st.y};
        return h(vec2<T>{T(std::cos(turn)) * tiled.x - T(std::sin(turn)) * tiled.y,
                         T(std::sin(turn)) * tiled.x + T(std::cos(turn)) * tiled.y});
      };
      const vec3d g = surfgrad::test::gradient_of(height, f.object_position);
      worst.add(composed(program, f).normal, normalize_or_zero(f.normal - g + dot(g, f.normal) * f.normal),
                exact, k);
    }
  }
}

TEST_F(Planars, ShowNoMirroredImageAgainstTheAxis) {
  lab.add("right", surfgrad::test::constant_image(2, 2, {0.5, 0, 0}));
  lab.add("up", surfgrad::test::constant_image(2, 2, {0, 0.5, 0}));
  for (const PlaneAxis axis : all_axes) {
    auto f = test::random_fragment(random);
    f.normal = direction_of(axis);
    const auto g = [&](const char* map) {
      return 2.0 * composed(lab.compile({planar_layer(map, axis, stack::Content::derivative)}), f).surfgrad;
    };
    // Right and up in the picture, and towards the viewer: a right-handed frame, so not mirrored.
    EXPECT_LT(max_abs(cross(g("right"), g("up")) - direction_of(axis)), exact);
    const vec3d up = axis == PlaneAxis::y ? vec3d{0, 0, -1} : vec3d{0, 1, 0};
    EXPECT_LT(max_abs(g("up") - up), exact);
  }
}

TEST_F(Planars, FilterForTheFootprintOnTheirPlane) {
  image::Image checks = surfgrad::test::constant_image(64, 64, {0, 0, 0});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) checks.at(x, y, 0) = (x + y) % 2 == 0 ? 1.0F : -1.0F;
  lab.add("checks", checks);
  for (const PlaneAxis axis : all_axes) {
    const Program program = lab.compile({planar_layer("checks", axis, stack::Content::derivative)});
    auto f = test::random_fragment(random);
    f.object_position = {0.5 / 64, 0.5 / 64, -0.5 / 64}; // a texel's centre on every plane
    f.normal = normalize_or_zero(vec3d{1, 1, 1});
    f.dp_dx = direction_of(axis);
    f.dp_dy = {0, 0, 0};
    EXPECT_GT(length(composed(program, f).surfgrad), 0.5) << "the footprint along the axis vanishes";
    for (const PlaneAxis across : all_axes)
      if (across != axis) {
        f.dp_dx = (1.0 / 16) * direction_of(across);
        EXPECT_LT(length(composed(program, f).surfgrad), exact) << "four texels average to nothing";
      }
  }
}

TEST_F(Planars, InObjectSpaceFollowTheObject) {
  Worst worst("normal of the moved object, slopes and heights");
  lab.add("map", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  for (const stack::Content content : {stack::Content::normal, stack::Content::height})
    for (const PlaneAxis axis : all_axes) {
      stack::PlanarLayer layer = planar_layer("map", axis, content);
      layer.map.height = 0.02;
      layer.map.filter = stack::Filter::bilinear;
      const Program program = lab.compile({layer});
      for (long k = 0; k < 200; ++k) {
        auto f = test::random_fragment(random);
        f.normal = normalize_or_zero(f.normal);
        const vec3d g = composed(program, f).surfgrad;
        const double size = random.magnitude(1e-6, 1e6);
        const mat3<double> r = random.rotation();
        const mat3<double> similar{random.sign() * size * r.x, random.sign() * size * r.y, size * r.z};
        worst.add(composed(program, test::moved(f, similar), BackFaces::same, similar).normal,
                  test::transformed_normal(similar, f.normal, g), exact, k);
        const mat3<double> stretch = test::random_stretch(random);
        const auto stretched = composed(program, test::moved(f, stretch), BackFaces::same, stretch);
        // A stretch may lay a slope nearly into the surface: relative to the gradient's size there.
        worst.add(stretched.normal, test::transformed_normal(stretch, f.normal, g),
                  exact * (1 + dot(stretched.surfgrad, stretched.surfgrad)), k);
      }
    }
}

TEST_F(Planars, InWorldSpaceStayWhereTheyAre) {
  Worst worst("normal of an object moved through a world-space projection");
  lab.add("map", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  for (long k = 0; k < 200; ++k) {
    stack::PlanarLayer layer = planar_layer("map", all_axes[random.integer(3)]);
    const Program in_object = lab.compile({layer});
    layer.space = stack::Space::world;
    const Program in_world = lab.compile({layer});
    // The same surface, given as an object at rest and as another one moved to the same place.
    const auto f = test::random_fragment(random);
    const mat3<double> m = random.rotation() * mat3<double>{{2, 0, 0}, {0, -0.5, 0}, {0, 0, 1}};
    const vec3d shift = random.vector3();
    const Placement placement = place({{m.x.x, m.x.y, m.x.z, shift.x},
                                       {m.y.x, m.y.y, m.y.z, shift.y},
                                       {m.z.x, m.z.y, m.z.z, shift.z},
                                       {0, 0, 0, 1}},
                                      {7, 8, 9}); // the camera's place does not matter
    auto at_place = f;
    at_place.object_position = m * f.object_position + shift;
    worst.add(compose(in_world, f, BackFaces::same, placement).normal, composed(in_object, at_place).normal,
              exact, k);
  }
}

TEST_F(Planars, OfAFlattenedObjectAreFlaggedAndFlat) {
  lab.add("map", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
  stack::PlanarLayer layer = planar_layer("map", PlaneAxis::x);
  auto f = test::random_fragment(random);
  const mat3<double> flat{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  const auto c = composed(lab.compile({layer}), f, BackFaces::same, flat);
  EXPECT_TRUE(c.degenerate);
  EXPECT_LT(length(c.surfgrad), exact);
  layer.space = stack::Space::world;
  const auto world = composed(lab.compile({layer}), f, BackFaces::same, flat);
  EXPECT_FALSE(world.degenerate);
  EXPECT_GT(length(world.surfgrad), 0);
}

TEST_F(Planars, StayFiniteInFloatForTheLargestNumbers) {
  // The largest numbers of a document and of a half-float file, and those of a float file.
  for (const float height : {6e4F, 1e30F}) {
    image::Image cliffs = surfgrad::test::random_image(random, 8, 8, 1, image::Depth::float32);
    for (float& texel : cliffs.texels.floats()) texel *= height;
    lab.add("cliffs", cliffs);
    stack::PlanarLayer layer = planar_layer("cliffs", PlaneAxis::y, stack::Content::height);
    layer.map.height = 1e12;
    layer.map.tile = {1e12, -1e12};
    layer.common.scale = 1e12;
    stack::PlanarLayer none = layer;
    none.map.height = 0;
    const Program program = lab.compile({layer, layer, none, stack::ResolveLayer{}, layer});
    for (const double size : {1e-12, 1.0, 1e12})
      for (int k = 0; k < 50; ++k) {
        raster::Fragment<float> f{};
        const vec3d n = random.unit_vector();
        f.object_position = {0.3F, 0.2F, 0.1F};
        f.normal = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
        f.dp_dx = {0.01F, 0, 0};
        f.dp_dy = {0, 0.01F, 0};
        f.front_facing = true;
        const mat3<double> r = random.rotation();
        const auto c =
            compose(program, f, BackFaces::same, test::placed({size * r.x, size * r.y, size * r.z}));
        EXPECT_NEAR(length(c.normal), 1, 1e-6) << "heights " << height << ", scale " << size;
      }
  }
}

} // namespace
} // namespace surfgrad::engine
