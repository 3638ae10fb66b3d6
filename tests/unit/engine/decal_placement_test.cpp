// Where decals lie, how they fade, and what they do where they collapse.

#include "decal_lab.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using stack::DecalBlend;
using stack::DecalShape;
using test::composed;
using test::Random;
using Vector = vec3<double>;

constexpr double stored = 2 * std::numeric_limits<float>::epsilon();

struct DecalPlaces : ::testing::Test {
  static constexpr std::uint64_t seed = 331;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  Random random{seed};
  test::Lab lab{};
  void SetUp() override {
    lab.add("s", test::slope_image({0.5, 0}));
    lab.add("t", test::slope_image({0, 0.5}));
    lab.add("both", test::slope_image({0.5, 0.25}));
    lab.add("a", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
    // Perpendicular to s, so that a capsule bends by it everywhere.
    lab.add("cube", surfgrad::test::constant_image(24, 4, {0.5, 1, 1}));
    lab.add("random cube", surfgrad::test::random_image(random, 24, 4, 3));
  }
  /// What a slope of a half along s or t adds to a surface that faces the decal.
  Vector bend(const char* map, const stack::DecalInstance& placement, Vector outward) {
    stack::DecalLayer layer = test::decal_layer(map);
    layer.instances[0] = placement;
    return 2.0 * composed(lab.compile({layer}), test::surface_at(placement.position, outward)).surfgrad;
  }
};

TEST_F(DecalPlaces, AreUprightSeenAlongTheirDirection) {
  struct Case {
    Vector direction, s, t;
  };
  // Seen from in front of a wall, its image's s runs to the right; on the floor and on the ceiling along +x.
  const double h = std::sqrt(0.5);
  const Case cases[] = {{{0, 0, -2}, {1, 0, 0}, {0, 1, 0}},  {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                        {{-3, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                        {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                        {{0, -1, -1}, {1, 0, 0}, {0, h, -h}}};
  for (const Case& c : cases) {
    stack::DecalInstance placement;
    placement.position = {0.5, -0.25, 2};
    placement.direction = c.direction;
    const Vector outward = -normalize_or_zero(c.direction);
    EXPECT_LT(max_abs(bend("s", placement, outward) - c.s), 4 * stored);
    EXPECT_LT(max_abs(bend("t", placement, outward) - c.t), 4 * stored);
    placement.roll_deg = 90; // counter-clockwise: s where t was
    EXPECT_LT(max_abs(bend("s", placement, outward) - c.t), 4 * stored);
    EXPECT_LT(max_abs(bend("t", placement, outward) + c.s), 4 * stored);
    placement.roll_deg = -30;
    const Vector turned = std::cos(std::numbers::pi / 6) * c.s - 0.5 * c.t;
    EXPECT_LT(max_abs(bend("s", placement, outward) - turned), 4 * stored);
  }
}

TEST_F(DecalPlaces, ByATransformAreThoseByPositionAndDirection) {
  surfgrad::test::Worst worst("decal by its transform");
  for (const auto& shape : stack::words_of<DecalShape>)
    for (long k = 0; k < 50; ++k) {
      const bool round = shape.value == DecalShape::sphere || shape.value == DecalShape::capsule;
      stack::DecalLayer layer = test::decal_layer(round ? "random cube" : "a", shape.value);
      layer.instances[0].direction = {0, 0, -1}; // s, t, outward are x, y, z
      layer.instances[0].position = {0, 0, 0.5};
      layer.instances[0].size = {2, 1.5, 3};
      stack::DecalLayer transformed = layer;
      transformed.instances[0] = {};
      const double scale = random.uniform(0.5, 2);
      const test::DecalAxes axes{{0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      if (shape.value == DecalShape::box) {
        transformed.instances[0].transform = axes.transform({2, 1.5, 3});
      } else {
        transformed.instances[0].transform = axes.transform({scale, scale, scale});
        transformed.instances[0].depth = 1 / scale;
        transformed.instances[0].radius = 0.5 / scale;
        transformed.instances[0].length = 1 / scale;
      }
      auto f = test::random_fragment(random);
      f.position = 0.4 * f.position;
      const auto expected = composed(lab.compile({layer}), f);
      worst.add(composed(lab.compile({transformed}), f).normal, expected.normal,
                1e-12 * (1 + max_abs(expected.surfgrad)), k);
    }
}

TEST_F(DecalPlaces, InObjectSpaceFollowTheObject) {
  // The object moved, turned and scaled evenly: everything with it, the bump as steep as before.
  surfgrad::test::Worst worst("decal that goes with its object");
  for (const auto& shape : stack::words_of<DecalShape>) {
    const bool round = shape.value == DecalShape::sphere || shape.value == DecalShape::capsule;
    stack::DecalLayer layer = test::decal_layer(round ? "random cube" : "a", shape.value);
    layer.space = stack::Space::object;
    layer.common.scale = 0.3;
    layer.instances[0].size = {2, 2, 2};
    layer.instances[0].position = {
        0, shape.value == DecalShape::cone || shape.value == DecalShape::wedge ? 0.5 : 0.0, 0};
    layer.instances[0].radius = 1;
    const Program program = lab.compile({layer});
    for (long k = 0; k < 100; ++k) {
      const mat3<double> r = random.rotation();
      const double scale = random.magnitude(0.1, 10);
      const Vector moved = random.magnitude(1, 1e3) * random.vector3();
      const Vector origin = moved + random.vector3();
      auto f = test::random_fragment(random);
      f.position = 0.5 * f.position;
      auto g = f;
      g.position = r * (scale * f.position) + moved - origin;
      g.normal = r * f.normal;
      g.dp_dx = scale * (r * f.dp_dx);
      g.dp_dy = scale * (r * f.dp_dy);
      const mat3<double> m = r * mat3<double>{{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}};
      const Placement placement = place({{m.x.x, m.x.y, m.x.z, moved.x},
                                         {m.y.x, m.y.y, m.y.z, moved.y},
                                         {m.z.x, m.z.y, m.z.z, moved.z},
                                         {0, 0, 0, 1}},
                                        origin);
      const auto expected = composed(program, f);
      // Positions a thousand away lose three digits, and texels magnify what is left.
      worst.add(compose(program, g, BackFaces::same, placement).normal, r * expected.normal,
                1e-9 * (1 + max_abs(expected.surfgrad)), k);
    }
  }
}

TEST_F(DecalPlaces, FadeToNothingAtTheSurfaceOfTheirShape) {
  for (const auto& shape : stack::words_of<DecalShape>) {
    const bool round = shape.value == DecalShape::sphere || shape.value == DecalShape::capsule;
    // A wedge's s stands still within its segment, a capsule's normal jumps along it: bumps across it only.
    stack::DecalLayer layer = test::decal_layer(round ? "cube" : "t", shape.value);
    layer.falloff = 0.25;
    const bool apex = shape.value == DecalShape::cone || shape.value == DecalShape::wedge;
    layer.instances[0].position = {0.1, 0.2, 0.3};
    layer.instances[0].direction = random.unit_vector();
    const Program program = lab.compile({layer});
    const Vector inside = layer.instances[0].position + (apex ? 0.5 : 0.0) * layer.instances[0].direction +
                          0.01 * random.vector3();
    const auto size_at = [&](Vector p) {
      // A surface across the image takes all of its gradient.
      const double size =
          length(composed(program, test::surface_at(p, -layer.instances[0].direction)).surfgrad);
      return size < 1e-14 ? 0.0 : size; // it comes by way of the normal: rounding is nothing
    };
    double strongest = 0;
    for (int ray = 0; ray < 200; ++ray) {
      const Vector direction = random.unit_vector();
      double in = 0, out = 4;
      if (size_at(inside + out * direction) != 0) ADD_FAILURE() << shape.text;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (in + out);
        (size_at(inside + middle * direction) > 0 ? in : out) = middle;
      }
      const Vector border = inside + in * direction;
      strongest = std::max(strongest, size_at(inside + 0.3 * in * direction));
      // At the apex everything converges.
      if (apex && length(border - layer.instances[0].position) < 0.1) continue;
      // A smoothstep ends with the square of the distance, where a hard edge would keep its size.
      EXPECT_LT(size_at(border - 1e-5 * direction), 3e-4 * size_at(border - 1e-3 * direction)) << shape.text;
    }
    EXPECT_GT(strongest, 0.4) << shape.text;
  }
}

TEST_F(DecalPlaces, OfFarAwayTexelsAreFilteredByTheirOwnFootprint) {
  // Stripes of opposite slopes: gone where a pixel covers many, whatever the mesh's coordinates say.
  image::Image stripes = image::make_image(16, 16, 3, image::Depth::float32);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      stripes.at(x, y, 0) = (x / 2) % 2 == 0 ? 0.25f : 0.75f;
      stripes.at(x, y, 1) = 0.5f;
      stripes.at(x, y, 2) = 1;
    }
  lab.add("stripes", stripes);
  stack::DecalLayer layer = test::decal_layer("stripes");
  const Program program = lab.compile({layer});
  auto f = test::surface_at({0.0625, 0.02, 0.03}, {0, 1, 0});
  const double near = length(composed(program, f).surfgrad);
  f.dp_dx = 400.0 * f.dp_dx;
  f.dp_dy = 400.0 * f.dp_dy;
  EXPECT_GT(near, 0.45);
  EXPECT_LT(length(composed(program, f).surfgrad), 1e-6);
}

TEST_F(DecalPlaces, MakeNoNaNHoweverSmallLargeOrFlatTheyAre) {
  const double nothing[] = {0, 1e-300, 1e-30, 1, 1e12};
  for (const auto& shape : stack::words_of<DecalShape>)
    for (const double size : nothing)
      for (const auto& blend : stack::words_of<DecalBlend>)
        for (const bool heights : {false, true}) {
          const bool round = shape.value == DecalShape::sphere || shape.value == DecalShape::capsule;
          if (round && heights) continue;
          stack::DecalLayer layer = test::decal_layer(round ? "random cube" : "a", shape.value);
          if (heights) layer.map.content = stack::Content::height;
          layer.blend = blend.value;
          layer.instances[0].size = {size, size, size};
          layer.instances[0].depth = size;
          layer.instances[0].radius = size;
          layer.instances[0].length = size;
          layer.instances[0].angle_deg = size == 0 ? 0 : 179.999;
          for (const double falloff : {0.0, 1.0})
            for (const auto space : {stack::Space::world, stack::Space::object}) {
              layer.falloff = falloff;
              layer.space = space;
              const Program program = lab.compile({layer, layer, stack::ResolveLayer{}, layer});
              const mat3<double> singular{{1, 0, 0}, {0, 0, 0}, {0, 0, 1}};
              // The centre or apex itself, beside it, on the axis, and behind the apex.
              for (const Vector p :
                   {Vector{0, 0, 0}, {0, 1e-300, 0}, {1e-17, 0, 0}, {0.3, 0, 0}, {0, 1, 0}, {0, -1, 0}})
                for (const double normal : {0.0, 1.0})
                  for (const double dp : {0.0, 1e-3, 1e12})
                    for (const mat3<double>& m : {test::identity, singular}) {
                      auto f = test::surface_at(p, {0, 0.6, 0.8});
                      f.normal = normal * f.normal;
                      f.dp_dx = (dp * 1e3) * f.dp_dx;
                      f.dp_dy = (dp * 1e3) * f.dp_dy;
                      const auto c = composed(program, f, BackFaces::same, m);
                      const double unit = length(c.normal);
                      EXPECT_TRUE(unit == 0 || std::abs(unit - 1) < 1e-12)
                          << shape.text << " of size " << size;
                      EXPECT_FALSE(std::isnan(max_abs(c.surfgrad)));
                    }
            }
        }
}

TEST_F(DecalPlaces, WithoutADirectionAreFlatAndFlagged) {
  const stack::DecalLayer layer = test::decal_layer("random cube", DecalShape::sphere);
  const auto centre = composed(lab.compile({layer}), test::surface_at({0, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(centre.degenerate);
  EXPECT_EQ(max_abs(centre.surfgrad), 0);
  EXPECT_FALSE(composed(lab.compile({layer}), test::surface_at({0.1, 0, 0}, {0, 1, 0})).degenerate);
  EXPECT_FALSE(composed(lab.compile({layer}), test::surface_at({2, 0, 0}, {0, 1, 0})).degenerate);

  lab.add("empty", surfgrad::test::constant_image(24, 4, {0.5, 0.5, 0.5}));
  const auto empty = composed(lab.compile({test::decal_layer("empty", DecalShape::sphere)}),
                              test::surface_at({0.1, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(empty.degenerate);
  EXPECT_EQ(max_abs(empty.surfgrad), 0);
}

} // namespace
} // namespace surfgrad::engine
