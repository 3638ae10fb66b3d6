// Lists of decals: sums before the normal, weights, and decals that replace.

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

/// A few hundred roundings of gradients of size up to about ten.
constexpr double rounding = 1e-12;

struct DecalBlends : ::testing::Test {
  static constexpr std::uint64_t seed = 321;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  Random random{seed};
  test::Lab lab{};
  void SetUp() override {
    lab.add("a", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
    lab.add("cube", surfgrad::test::random_image(random, 24, 4, 3));
    lab.add("flat", surfgrad::test::constant_image(4, 4, {0.5, 0.5, 1}));
    lab.add("mask", surfgrad::test::random_image(random, 8, 8, 1));
  }

  stack::DecalLayer list(DecalShape shape, int count, stack::Space space, int blends) {
    const bool round = shape == DecalShape::sphere || shape == DecalShape::capsule;
    stack::DecalLayer layer = test::decal_layer(round ? "cube" : "a", shape);
    layer.space = space;
    layer.common.scale = 0.6;
    layer.common.mask = test::mask_of("mask");
    layer.instances.assign(static_cast<std::size_t>(count), {});
    for (stack::DecalInstance& decal : layer.instances) {
      decal.direction = random.unit_vector();
      decal.position = random.vector3();
      if (shape == DecalShape::cone || shape == DecalShape::wedge)
        decal.position = decal.position - normalize_or_zero(decal.direction);
      decal.roll_deg = random.uniform(-180, 180);
      decal.size = random.vector3(1, 3);
      decal.depth = 2;
      decal.radius = random.uniform(0.5, 1.5);
      decal.opacity = random.uniform(0.1, 0.9);
      if (random.integer(2) == 0) decal.scale = random.uniform(-1, 1);
      decal.blend = stack::words_of<DecalBlend>[random.bits() % static_cast<unsigned>(blends)].value;
    }
    return layer;
  }
  /// The same decals, a layer each: every one is projected on its own.
  static std::vector<stack::Layer> one_by_one(const stack::DecalLayer& layer) {
    std::vector<stack::Layer> layers;
    for (const stack::DecalInstance& decal : layer.instances) {
      stack::DecalLayer one = layer;
      one.instances = {decal};
      layers.emplace_back(one);
    }
    return layers;
  }
};

TEST_F(DecalBlends, AHundredSummedFirstAreAHundredProjectedOneByOne) {
  // Section 2.9. With 1 blend all are add; with 3 every kind occurs, in order.
  const mat3<double> uneven{{2, 0.3, 0}, {0, -0.5, 0}, {0, 0.1, 1}};
  long bumped = 0;
  for (const auto& shape : stack::words_of<DecalShape>)
    for (const auto space : {stack::Space::world, stack::Space::object})
      for (const int blends : {1, 2, 3}) {
        surfgrad::test::Worst worst("100 of shape " + std::string(shape.text) + ", " +
                                    std::to_string(blends) + " blends");
        const stack::DecalLayer layer = list(shape.value, 100, space, blends);
        const std::vector<stack::Layer> under{test::normal_layer("a"), layer};
        std::vector<stack::Layer> apart = one_by_one(layer);
        apart.insert(apart.begin(), test::normal_layer("a"));
        const Program together = lab.compile(under);
        const Program separate = lab.compile(apart);
        for (long k = 0; k < 40; ++k) {
          const auto f = test::random_fragment(random);
          const auto expected = composed(separate, f, BackFaces::same, uneven);
          worst.add(composed(together, f, BackFaces::same, uneven).normal, expected.normal,
                    rounding * (1 + max_abs(expected.surfgrad)), k);
          bumped += max_abs(expected.surfgrad) > 0.3;
        }
      }
  EXPECT_GT(bumped, 600);
}

TEST_F(DecalBlends, FollowTheFormulaOfTheirWeights) {
  surfgrad::test::Worst worst("gradient of add, mix and replace");
  const vec2<double> slope{0.5, -0.25};
  lab.add("slope", test::slope_image(slope));
  lab.add("half", surfgrad::test::constant_image(1, 1, {0.5, 0, 0}));
  const test::DecalAxes axes = test::random_axes(random, {0, 0, 0});
  for (const DecalBlend blend : {DecalBlend::add, DecalBlend::mix, DecalBlend::replace}) {
    stack::DecalLayer layer = test::decal_layer("slope");
    layer.falloff = 0;
    layer.blend = blend;
    layer.common.scale = 1.5;
    layer.common.opacity = 0.75;
    layer.common.mask = test::mask_of("half");
    layer.instances[0].transform = axes.transform({4, 4, 4});
    stack::DecalLayer own = layer; // says in the instance what the other says in the layer
    own.common.scale = -3;
    own.common.opacity = 1;
    own.blend = DecalBlend::add;
    own.instances[0].scale = 1.5;
    own.instances[0].opacity = 0.75;
    own.instances[0].blend = blend;
    const Program below = lab.compile({test::normal_layer("a")});
    const Program both = lab.compile({test::normal_layer("a"), layer});
    const Program in_instance = lab.compile({test::normal_layer("a"), own});
    for (long k = 0; k < 200; ++k) {
      auto f = test::random_fragment(random);
      // Facing the decal: towards the horizon rounding grows beyond any bound.
      f.normal = normalize_or_zero(axes.outward + 0.6 * random.unit_vector());
      const Vector n = f.normal;
      for (auto& uv : f.uvs) uv.tangent = normalize_or_zero(uv.tangent - dot(uv.tangent, n) * n);
      const double w = 0.75 * 0.5;
      const Vector before = composed(below, f).surfgrad;
      const Vector volume = slope.x * axes.s + slope.y * axes.t;
      const Vector along = 1.5 * (volume - dot(volume, n) * n);
      Vector g = before + w * along;
      if (blend == DecalBlend::mix) g = (1 - w) * before + w * along;
      if (blend == DecalBlend::replace)
        g = (1 - w) * before + w * from_perturbed_normal(n, axes.outward - 1.5 * volume);
      // By way of the normal: its error grows with the square of the gradient.
      const double bound = 1e-12 * (1 + dot(g, g) + dot(before, before));
      worst.add(composed(both, f).surfgrad, g, bound, k);
      worst.add(composed(in_instance, f).surfgrad, composed(both, f).surfgrad, 0, k);
    }
  }
}

TEST_F(DecalBlends, AFlatOneThatReplacesLeavesItsOwnDirection) {
  surfgrad::test::Worst worst("normal under a flat decal that replaces");
  const mat3<double> odd{{0.5, 0.2, 0}, {0, -2, 0.3}, {0.1, 0, 1}};
  for (const bool object : {false, true})
    for (const DecalShape shape : {DecalShape::box, DecalShape::cone, DecalShape::wedge})
      for (long k = 0; k < 100; ++k) {
        const Vector direction = random.unit_vector();
        stack::DecalLayer layer = test::decal_layer("flat", shape);
        layer.space = object ? stack::Space::object : stack::Space::world;
        layer.falloff = 0;
        layer.blend = DecalBlend::replace;
        layer.instances[0].direction = random.magnitude(1e-3, 1e3) * direction;
        layer.instances[0].position = shape == DecalShape::box ? Vector{0, 0, 0} : -4.0 * direction;
        layer.instances[0].size = {20, 20, 20};
        layer.instances[0].angle_deg = 100;
        layer.instances[0].depth = 20;
        const mat3<double> m = object ? odd : test::identity;
        const Vector outward = normalize_or_zero(transform_normal(m, -direction));
        auto f = test::random_fragment(random);
        f.normal = normalize_or_zero(outward + 0.8 * random.unit_vector());
        // Whatever lies below, and whether or not other decals of the layer come before.
        stack::DecalLayer after = layer;
        after.instances.insert(after.instances.begin(), layer.instances[0]);
        after.instances[0].blend = DecalBlend::add;
        for (const auto& layers : {std::vector<stack::Layer>{layer}, {test::normal_layer("a"), after}})
          worst.add(composed(lab.compile(layers), f, BackFaces::same, m).normal, outward, 1e-14, k);
      }
}

TEST_F(DecalBlends, AMixedOneOfNoBumpsScalesWhatLiesBelow) {
  surfgrad::test::Worst worst("gradient under a flat mix decal");
  stack::DecalLayer layer = test::decal_layer("flat");
  layer.falloff = 0;
  layer.blend = DecalBlend::mix;
  layer.common.opacity = 0.375;
  layer.instances[0].size = {9, 9, 9};
  const Program plain = lab.compile({test::normal_layer("a")});
  const Program mixed = lab.compile({test::normal_layer("a"), layer});
  for (long k = 0; k < 200; ++k) {
    const auto f = test::random_fragment(random);
    const Vector g = composed(plain, f).surfgrad;
    worst.add(composed(mixed, f).surfgrad, 0.625 * g, 1e-13 * (1 + dot(g, g)), k);
  }
}

TEST_F(DecalBlends, LayersThatDecalsDoNotReachStayAsTheyAre) {
  const Program plain = lab.compile({test::normal_layer("a")});
  for (const auto& shape : stack::words_of<DecalShape>) {
    stack::DecalLayer away = list(shape.value, 20, stack::Space::world, 3);
    for (stack::DecalInstance& decal : away.instances) decal.position = decal.position + Vector{9, 0, 0};
    stack::DecalLayer none = away;
    none.instances.clear();
    for (const auto& layer : {away, none}) {
      const Program program = lab.compile({test::normal_layer("a"), layer});
      for (int k = 0; k < 50; ++k) {
        const auto f = test::random_fragment(random);
        EXPECT_EQ(max_abs(composed(program, f).normal - composed(plain, f).normal), 0);
      }
    }
  }
}

} // namespace
} // namespace surfgrad::engine
