// The rules of a pass: add and mix, weights, and what must cancel.

#include "lab.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace surfgrad::engine {
namespace {

using test::composed;
using test::Lab;
using test::normal_layer;

/// A few dozen roundings of gradients of size up to about ten.
constexpr double rounding = 1e-13;

constexpr int fragments = 300;

template <class Layer>
Layer with(Layer layer, double scale, double opacity, stack::Blend blend) {
  layer.common.scale = scale;
  layer.common.opacity = opacity;
  layer.common.blend = blend;
  return layer;
}

struct Composing : ::testing::Test {
  static constexpr std::uint64_t seed = 101;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  Lab lab{};
  std::vector<stack::Layer> kinds = test::one_of_each(lab, random);

  void SetUp() override { lab.add("flat", surfgrad::test::constant_image(4, 4, {0.5, 0.5, 1})); }
};

TEST_F(Composing, AddLayersCommute) {
  surfgrad::test::Worst worst("normals of permuted layers");
  const Program straight = lab.compile(kinds);
  std::vector<stack::Layer> layers = kinds;
  for (int trial = 0; trial < 30; ++trial) {
    for (std::size_t i = layers.size() - 1; i > 0; --i)
      std::swap(layers[i], layers[static_cast<std::size_t>(random.integer(static_cast<int>(i) + 1))]);
    const Program permuted = lab.compile(layers);
    for (long k = 0; k < 20; ++k) {
      const auto f = test::leaning_fragment(random);
      // An object-space map may lie nearly in the surface: relative to the gradient's size.
      const auto c = composed(straight, f);
      worst.add(composed(permuted, f).normal, c.normal, rounding * (1 + max_abs(c.surfgrad)), k);
    }
  }
}

TEST_F(Composing, AFlatAddLayerChangesNothing) {
  const Program plain = lab.compile(kinds);
  for (const stack::Basis basis : {stack::Basis::mikktspace, stack::Basis::derived}) {
    std::vector<stack::Layer> layers = kinds;
    layers.insert(layers.begin() + 1, with(normal_layer("flat", 1, basis), 3, 1, stack::Blend::add));
    const Program flat = lab.compile(layers);
    for (int k = 0; k < fragments; ++k) {
      const auto f = test::leaning_fragment(random);
      EXPECT_EQ(max_abs(composed(flat, f).normal - composed(plain, f).normal), 0);
    }
  }
}

TEST_F(Composing, AFlatMixLayerScalesTheSumByOneLessItsWeight) {
  surfgrad::test::Worst worst("gradient under a flat mix layer");
  const double w = 0.375;
  const Program plain = lab.compile({kinds[0], kinds[1]});
  const Program mixed =
      lab.compile({kinds[0], kinds[1], with(normal_layer("flat"), 2, w, stack::Blend::mix)});
  for (long k = 0; k < fragments; ++k) {
    const auto f = test::random_fragment(random);
    const vec3<double> g = composed(plain, f).surfgrad;
    worst.add(composed(mixed, f).surfgrad, (1 - w) * g, rounding * (1 + dot(g, g)),
              k); // by way of the normal
  }
}

TEST_F(Composing, ALayerAndItsOppositeCancel) {
  surfgrad::test::Worst worst("normal with a twin of scale -1");
  for (const stack::Layer& kind : kinds) {
    const stack::Layer twin = std::visit(
        [](auto l) -> stack::Layer {
          if constexpr (!std::is_same_v<decltype(l), stack::ResolveLayer>) l.common.scale = -l.common.scale;
          return l;
        },
        kind);
    const stack::Layer other = normal_layer("d", 1);
    const Program alone = lab.compile({other});
    const Program both = lab.compile({kind, other, twin});
    for (long k = 0; k < fragments; ++k) {
      const auto f = test::random_fragment(random);
      // On an object at rest, and on one that is stretched, sheared and mirrored.
      for (const mat3<double>& m : {test::identity, mat3<double>{{3, 0.4, 0}, {0, -0.5, 0}, {0.2, 0, 1}}}) {
        const double size = max_abs(composed(lab.compile({kind}), f, BackFaces::same, m).surfgrad);
        worst.add(composed(both, f, BackFaces::same, m).normal, composed(alone, f, BackFaces::same, m).normal,
                  rounding * (1 + size) * (1 + size), k);
      }
    }
  }
}

TEST_F(Composing, MixFollowsItsFormulaInDocumentOrder) {
  surfgrad::test::Worst worst("gradient of add, mix, mix");
  const double w1 = 0.3;
  const double w2 = 0.6;
  const auto layer = [](const char* map, int uv, double scale, double w, stack::Blend blend) {
    return with(normal_layer(map, uv), scale, w, blend);
  };
  const auto add = layer("a", 0, 1.5, 0.8, stack::Blend::add);
  const auto mix_b = layer("b", 1, 2, w1, stack::Blend::mix);
  const auto mix_d = layer("d", 0, -1, w2, stack::Blend::mix);
  const Program program = lab.compile({add, mix_b, mix_d});
  const Program swapped = lab.compile({add, mix_d, mix_b});
  const Program a = lab.compile({layer("a", 0, 1, 1, stack::Blend::add)});
  const Program b = lab.compile({layer("b", 1, 1, 1, stack::Blend::add)});
  const Program d = lab.compile({layer("d", 0, 1, 1, stack::Blend::add)});
  double largest_difference = 0;
  for (long k = 0; k < fragments; ++k) {
    const auto f = test::random_fragment(random);
    vec3<double> g = (0.8 * 1.5) * composed(a, f).surfgrad;
    g = (1 - w1) * g + (w1 * 2) * composed(b, f).surfgrad;
    g = (1 - w2) * g + (w2 * -1) * composed(d, f).surfgrad;
    const vec3<double> got = composed(program, f).surfgrad;
    worst.add(got, g, 10 * rounding * (1 + dot(g, g)), k);
    largest_difference = std::max(largest_difference, max_abs(got - composed(swapped, f).surfgrad));
  }
  EXPECT_GT(largest_difference, 0.1) << "mix layers must not commute";
}

TEST_F(Composing, OpacityScaleAndMaskAreFactors) {
  surfgrad::test::Worst worst("gradient against its factors");
  lab.add("quarter", surfgrad::test::constant_image(4, 4, {0.25, 1, 1}));
  stack::NormalMapLayer layer = normal_layer("a");
  const Program plain = lab.compile({layer});
  layer = with(layer, -3, 0.5, stack::Blend::add);
  layer.common.mask = test::mask_of("quarter");
  const Program weighed = lab.compile({layer});
  for (long k = 0; k < fragments; ++k) {
    const auto f = test::random_fragment(random);
    const vec3<double> g = composed(plain, f).surfgrad;
    worst.add(composed(weighed, f).surfgrad, (-3 * 0.5 * 0.25) * g, rounding * (1 + dot(g, g)), k);
  }
}

TEST_F(Composing, AMaskReadsItsOwnChannelAndTextureCoordinate) {
  image::Image mask = image::make_image(2, 1, 4, image::Depth::float32);
  mask.texels = {0.125f, 0.25f, 0.375f, 0.5f, 0.625f, 0.75f, 0.875f, 1.0f};
  lab.add("channels", mask);
  const Program plain = lab.compile({normal_layer("a")});
  surfgrad::test::Worst worst("gradient under each channel of a mask");
  for (int channel = 0; channel < 4; ++channel) {
    stack::NormalMapLayer layer = normal_layer("a");
    layer.common.mask = test::mask_of("channels", static_cast<stack::MaskChannel>(channel));
    layer.common.mask->uv = 1;
    layer.common.mask->filter = stack::Filter::nearest;
    const Program masked = lab.compile({layer});
    for (long k = 0; k < fragments; ++k) {
      auto f = test::random_fragment(random);
      const int texel = static_cast<int>(k % 2);
      f.uvs[1].st = {0.25 + 0.5 * texel, 0.5};
      const double w = 0.125 * (1 + channel + 4 * texel);
      const vec3<double> g = composed(plain, f).surfgrad;
      worst.add(composed(masked, f).surfgrad, w * g, rounding * (1 + dot(g, g)), k);
    }
  }
}

TEST_F(Composing, ANormalMapInItsVertexFrameIsTheStandardDecode) {
  // normalize(x T + y B + z N) of the raw interpolated vectors: what every engine computes.
  lab.add("one", surfgrad::test::constant_image(1, 1, {0.7, 0.35, 0.9}));
  const vec3<double> m{2 * 0.7f - 1.0, 2 * 0.35f - 1.0, 2 * 0.9f - 1.0};
  const Program program = lab.compile({normal_layer("one")});
  surfgrad::test::Worst worst("standard decode");
  for (long k = 0; k < fragments; ++k) {
    const auto f = test::leaning_fragment(random);
    const auto& uv = f.uvs[0];
    const vec3<double> expected =
        m.x * uv.tangent + (m.y * uv.sign) * cross(f.normal, uv.tangent) + m.z * f.normal;
    // Slopes are stored in float.
    worst.add(composed(program, f).normal, normalize_or_zero(expected), std::numeric_limits<float>::epsilon(),
              k);
  }
}

} // namespace
} // namespace surfgrad::engine
