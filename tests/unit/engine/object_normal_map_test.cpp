// Whole normals from a map, in the object's or the world's space, under every kind of transform.

#include "lab.hpp"
#include "support/meshes.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using test::composed;

/// Directions are stored in float and rounded once.
constexpr double stored = 2 * std::numeric_limits<float>::epsilon();

struct Case {
  const char* name;
  mat3<double> linear;
};

std::vector<Case> transforms(test::Random& random) {
  using surfgrad::test::scaling;
  return {{"identity", test::identity},
          {"rotation and uniform scale", random.rotation() * scaling({3, 3, 3})},
          {"non-uniform scale", random.rotation() * scaling({0.5, 2, 1}) * random.rotation()},
          {"mirror", random.rotation() * scaling({-1, 1, 1})},
          {"all axes negated", scaling({-2, -1, -0.5})}};
}

struct ObjectNormalMaps : ::testing::Test {
  static constexpr std::uint64_t seed = 141;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};

  /// A program of one texel that holds n, and n as it was stored.
  std::pair<Program, vec3<double>> of(vec3<double> n, stack::Space space) {
    test::Lab lab;
    const image::Image texel = surfgrad::test::constant_image(1, 1, 0.5 * n + vec3<double>{0.5, 0.5, 0.5});
    lab.add("map", texel);
    return {lab.compile({test::object_layer("map", space)}),
            normalize_or_zero(vec3<double>{2.0 * texel.texels[0] - 1, 2.0 * texel.texels[1] - 1,
                                           2.0 * texel.texels[2] - 1})};
  }
};

TEST_F(ObjectNormalMaps, GiveTheTransformedNormalOfTheObject) {
  for (const Case& c : transforms(random)) {
    SCOPED_TRACE(c.name);
    surfgrad::test::Worst worst(c.name);
    for (long k = 0; k < 200; ++k) {
      const vec3<double> n = random.unit_vector();
      const auto [program, v] = of(n, stack::Space::object);
      auto f = test::random_fragment(random);
      // The surface's own normal somewhere within 60 degrees of the map's.
      const vec3<double> expected = normalize_or_zero(transform_normal(c.linear, v));
      f.normal = normalize_or_zero(expected + 0.8 * random.unit_vector());
      const auto got = composed(program, f, BackFaces::same, c.linear);
      worst.add(got.normal, expected, 4 * stored, k); // a scale of 1:4 magnifies rounding
      EXPECT_FALSE(got.degenerate);
    }
  }
}

TEST_F(ObjectNormalMaps, InWorldSpaceAreLeftAlone) {
  surfgrad::test::Worst worst("world space");
  for (const Case& c : transforms(random))
    for (long k = 0; k < 200; ++k) {
      const auto [program, v] = of(random.unit_vector(), stack::Space::world);
      auto f = test::random_fragment(random);
      f.normal = normalize_or_zero(v + 0.8 * random.unit_vector());
      worst.add(composed(program, f, BackFaces::same, c.linear).normal, v, 4 * stored, k);
    }
}

TEST_F(ObjectNormalMaps, OfTheMeshsOwnNormalsAddNothing) {
  surfgrad::test::Worst worst("gradient of the own normal");
  for (const Case& c : transforms(random))
    for (long k = 0; k < 200; ++k) {
      const auto [program, v] = of(random.unit_vector(), stack::Space::object);
      auto f = test::random_fragment(random);
      f.normal = 2.5 * transform_normal(c.linear, v);
      worst.add(composed(program, f, BackFaces::same, c.linear).surfgrad, {0, 0, 0}, 8 * stored, k);
    }
}

TEST_F(ObjectNormalMaps, WithGreenDownNegateY) {
  test::Lab lab;
  lab.add("map", surfgrad::test::constant_image(1, 1, {0.5, 0.75, 1}));
  stack::ObjectNormalMapLayer layer = test::object_layer("map");
  layer.map.green = stack::Green::down;
  auto f = test::random_fragment(random);
  f.normal = {0, 0, 1};
  const auto c = composed(lab.compile({layer}), f);
  EXPECT_LT(max_abs(c.normal - normalize_or_zero(vec3<double>{0, -0.5, 1})), 2 * stored);
}

TEST_F(ObjectNormalMaps, WithoutADirectionAreFlatAndFlagged) {
  const auto [program, v] = of({0, 0, 0}, stack::Space::object);
  const auto f = test::random_fragment(random);
  const auto c = composed(program, f);
  EXPECT_TRUE(c.degenerate);
  EXPECT_LT(max_abs(c.normal - normalize_or_zero(f.normal)), 1e-15);
}

} // namespace
} // namespace surfgrad::engine
