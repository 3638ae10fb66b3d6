// After a resolve, and from behind.

#include "lab.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using test::composed;
using test::Lab;

constexpr double rounding = 1e-14; // a few dozen roundings
constexpr int fragments = 200;

struct Passes : ::testing::Test {
  static constexpr std::uint64_t seed = 111;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  Lab lab{};
  std::vector<stack::Layer> kinds = test::one_of_each(lab, random);
};

TEST_F(Passes, ASecondPassIsTheFirstPassOnTheResolvedNormal) {
  surfgrad::test::Worst worst("second pass against a fresh first pass");
  const Program base = lab.compile({test::normal_layer("d", 1)});
  for (const stack::Layer& kind : kinds) {
    const Program twice = lab.compile({test::normal_layer("d", 1), stack::ResolveLayer{}, kind});
    const Program once = lab.compile({kind});
    for (long k = 0; k < fragments; ++k) {
      const auto f = test::leaning_fragment(random);
      auto rebased = f;
      rebased.normal = composed(base, f).normal;
      for (auto& uv : rebased.uvs) // the vertex frame follows the normal; its handedness stays
        uv.tangent = normalize_or_zero(uv.tangent - dot(uv.tangent, rebased.normal) * rebased.normal);
      const auto expected = composed(once, rebased);
      worst.add(composed(twice, f).normal, expected.normal, rounding * (1 + max_abs(expected.surfgrad)), k);
    }
  }
}

TEST_F(Passes, AResolveAfterTheLastLayerOrTwiceInARowChangesNothing) {
  surfgrad::test::Worst worst("idle resolve");
  std::vector<stack::Layer> layers = kinds;
  const Program plain = lab.compile(layers);
  layers.insert(layers.begin(), stack::ResolveLayer{});
  layers.emplace_back(stack::ResolveLayer{});
  layers.emplace_back(stack::ResolveLayer{});
  layers.erase(layers.begin()); // a leading one would begin a later pass for the vertex frame
  const Program idle = lab.compile(layers);
  for (long k = 0; k < fragments; ++k) {
    const auto f = test::leaning_fragment(random);
    worst.add(composed(idle, f).normal, composed(plain, f).normal, rounding, k);
  }
}

TEST_F(Passes, TheSurfaceGradientLeadsFromTheBaseNormalToTheResult) {
  surfgrad::test::Worst worst("normal from the reported gradient");
  const Program program = lab.compile({kinds[0], stack::ResolveLayer{}, kinds[1]});
  for (const bool front : {true, false})
    for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip})
      for (long k = 0; k < fragments; ++k) {
        auto f = test::random_fragment(random);
        f.front_facing = front;
        const auto c = composed(program, f, mode);
        if (dot(c.base_normal, c.normal) < 0.1) continue; // past the horizon no gradient leads there
        const double sign = mode == BackFaces::flip && !front ? -1 : 1;
        worst.add(normalize_or_zero(c.base_normal - sign * c.surfgrad), c.normal, rounding * 100, k);
      }
}

/// Three passes that end in the kind under test; each pass has a layer of its own.
std::vector<stack::Layer> three_passes(const stack::Layer& first, const stack::Layer& second,
                                       const stack::Layer& third) {
  return {first, stack::ResolveLayer{}, second, stack::ResolveLayer{}, third};
}

TEST_F(Passes, FlipOnABackFaceIsTheNegatedFrontAfterAnyNumberOfPasses) {
  for (std::size_t a = 0; a < kinds.size(); ++a)
    for (std::size_t b = 0; b < kinds.size(); ++b) {
      const Program program = lab.compile(three_passes(kinds[a], kinds[b], kinds[(a + b) % kinds.size()]));
      for (long k = 0; k < 50; ++k) {
        auto f = test::leaning_fragment(random);
        const auto front = composed(program, f, BackFaces::flip);
        f.front_facing = false;
        const auto back = composed(program, f, BackFaces::flip);
        // Exactly: negation commutes with every rounding.
        EXPECT_EQ(max_abs(back.normal + front.normal), 0) << "case " << k;
        EXPECT_EQ(max_abs(back.base_normal + front.base_normal), 0) << "case " << k;
      }
    }
}

TEST_F(Passes, SameOnABackFaceIsTheFront) {
  const Program program = lab.compile(three_passes(kinds[0], kinds[1], kinds[2]));
  for (int k = 0; k < fragments; ++k) {
    auto f = test::leaning_fragment(random);
    const auto front = composed(program, f, BackFaces::same);
    f.front_facing = false;
    EXPECT_EQ(max_abs(composed(program, f, BackFaces::same).normal - front.normal), 0);
  }
}

TEST_F(Passes, MirrorOnABackFaceAddsTheSameGradientToTheNegatedNormal) {
  surfgrad::test::Worst worst("mirror");
  for (const stack::Layer& kind : kinds) {
    const Program program = lab.compile({kind});
    for (long k = 0; k < fragments; ++k) {
      auto f = test::random_fragment(random);
      const auto front = composed(program, f, BackFaces::mirror);
      f.front_facing = false;
      const auto back = composed(program, f, BackFaces::mirror);
      const double size = 1 + max_abs(front.surfgrad);
      // The reported gradient comes by way of the normal: its error grows with its square.
      worst.add(back.normal, normalize_or_zero(-front.base_normal - front.surfgrad), rounding * size * size,
                k);
    }
  }
}

} // namespace
} // namespace surfgrad::engine
