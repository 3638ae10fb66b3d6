// Every layer kind on all six sides of a body, under everything that may happen to a body: turned,
// scaled, mirrored, unwrapped differently, rasterised upside down, seen from behind.

#include "every_kind.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::engine {
namespace {

using test::Body;
using test::KindCase;
using test::Seen;
using test::UnwrappedAs;

constexpr mat3<double> identity = test::identity;

mat3<double> scaled(double s, const mat3<double>& m) { return {s * m.x, s * m.y, s * m.z}; }

/// Largest distance between the normals of two views, the first brought along by `follow`.
template <class Follow>
double worst_difference(const std::vector<Seen>& a, const std::vector<Seen>& b, const Follow& follow) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = max_abs(normalize_or_zero(follow(a[i].normal)) - b[i].normal);
    if (!(d <= worst)) worst = std::isnan(d) ? HUGE_VAL : d;
  }
  return worst;
}

struct EveryKind : ::testing::TestWithParam<KindCase> {
  Body bent{0.3};

  /// Composed with the layers as a body of this scale wants them: heights in scene units grow with it.
  [[nodiscard]] std::vector<Seen> seen(const test::View& view, double scale = 1) const {
    return bent.seen(GetParam(), view, scale, UnwrappedAs::drawn);
  }
};

/// Rounding of a chain of some hundred operations on numbers of order one, in double.
constexpr double rounding = 1e-11;

TEST_P(EveryKind, BumpsEverySide) {
  const std::vector<Seen> plain = seen({});
  ASSERT_EQ(plain.size(), Body::point_count);
  // On each of the six sides some point must show the bump: else the other tests compare nothing.
  for (int side = 0; side < 6; ++side) {
    double most = 0;
    for (const Seen& s : plain)
      if (s.side == side) most = std::max(most, max_abs(s.normal - s.base_normal));
    EXPECT_GT(most, 0.01) << "side " << side;
  }
  for (const Seen& s : plain) EXPECT_NEAR(length(s.normal), 1, 1e-12);
}

TEST_P(EveryKind, TurnsWithTheBody) {
  const mat3<double> turn{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}};
  const double worst = worst_difference(seen({}), seen({.linear = turn}), [&](auto n) { return turn * n; });
  std::printf("  %s turned: worst %.2g\n", GetParam().name, worst);
  EXPECT_LT(worst, rounding);
}

TEST_P(EveryKind, LooksTheSameAtEveryScale) {
  for (const double s : {1e-3, 0.37, 40.0}) {
    const double worst =
        worst_difference(seen({}), seen({.linear = scaled(s, identity)}, s), [](auto n) { return n; });
    std::printf("  %s scaled by %g: worst %.2g\n", GetParam().name, s, worst);
    EXPECT_LT(worst, rounding) << s;
  }
}

TEST_P(EveryKind, MirrorsWithTheBody) {
  for (const mat3<double>& mirror :
       {mat3<double>{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, mat3<double>{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
        mat3<double>{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, mat3<double>{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}}) {
    const double worst =
        worst_difference(seen({}), seen({.linear = mirror}), [&](auto n) { return mirror * n; });
    std::printf("  %s mirrored: worst %.2g\n", GetParam().name, worst);
    EXPECT_LT(worst, rounding);
  }
}

TEST_P(EveryKind, StretchesWithTheBodyWhereItIsDisplacedInObjectSpace) {
  if (!GetParam().stretches) GTEST_SKIP() << "measured in the scene, not in the object";
  for (const mat3<double>& stretch : {mat3<double>{{3, 0, 0}, {0, 0.5, 0}, {0, 0, 1}},
                                      mat3<double>{{-0.4, 0, 0}, {0, 2, 0.5}, {0, 0, 1}}}) {
    // Straight: normals that differ from vertex to vertex are interpolated unit after the transform.
    const Body straight(0);
    const auto of = [&](const test::View& view) {
      return straight.seen(GetParam(), view, 1, UnwrappedAs::drawn);
    };
    const double worst = worst_difference(of({}), of({.linear = stretch}),
                                          [&](auto n) { return transform_normal(stretch, n); });
    std::printf("  %s stretched: worst %.2g\n", GetParam().name, worst);
    EXPECT_LT(worst, rounding);
  }
}

TEST_P(EveryKind, StaysFiniteUnderEveryTransform) {
  for (const mat3<double>& m :
       {mat3<double>{{3, 0, 0}, {0, 0.01, 0}, {0, 0, -7}},
        mat3<double>{{1, 0.9, 0.9}, {0.9, 1, 0.9}, {0, 0, 1}}, mat3<double>{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}},
        mat3<double>{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}})
    for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip})
      for (const Seen& s :
           seen({.linear = m, .projects_through = identity, .from_behind = true, .mode = mode})) {
        const double size = length(s.normal);
        EXPECT_TRUE(size == 0 || std::abs(size - 1) < 1e-9) << size;
        EXPECT_TRUE(size > 0 || s.degenerate);
      }
}

TEST_P(EveryKind, DoesNotDependOnHowTheBodyIsUnwrapped) {
  const Body straight(0);
  const auto as = [&](UnwrappedAs how) { return straight.seen(GetParam(), {}, 1, how); };
  for (const UnwrappedAs how : {UnwrappedAs::mirrored, UnwrappedAs::turned, UnwrappedAs::both}) {
    const double worst = worst_difference(as(UnwrappedAs::drawn), as(how), [](auto n) { return n; });
    std::printf("  %s unwrapped differently: worst %.2g\n", GetParam().name, worst);
    // Vertex tangents are made and stored in single precision.
    EXPECT_LT(worst, GetParam().vertex_tangents ? 1e-6 : rounding);
  }
}

TEST_P(EveryKind, DoesNotDependOnTheDirectionOfScreenRows) {
  if (GetParam().one_sided) GTEST_SKIP() << "takes its taps towards +y of the screen";
  const double worst = worst_difference(seen({}), seen({.rows_run_down = true}), [](auto n) { return n; });
  std::printf("  %s with rows running down: worst %.2g\n", GetParam().name, worst);
  EXPECT_LT(worst, rounding);
}

TEST_P(EveryKind, ShowsItsBackAsTheModeSays) {
  const std::vector<Seen> front = seen({});
  const std::vector<Seen> same = seen({.from_behind = true, .mode = BackFaces::same});
  const std::vector<Seen> mirror = seen({.from_behind = true, .mode = BackFaces::mirror});
  const std::vector<Seen> flip = seen({.from_behind = true, .mode = BackFaces::flip});
  // A vertex frame leans off the tangent plane; what it adds along the normal changes side with it.
  if (GetParam().vertex_tangents || GetParam().moves) GTEST_SKIP() << "has tests of its own";
  EXPECT_LT(worst_difference(front, same, [](auto n) { return n; }), rounding);
  EXPECT_LT(worst_difference(front, flip, [](auto n) { return -n; }), rounding);
  for (std::size_t i = 0; i < front.size(); ++i)
    EXPECT_LT(max_abs(normalize_or_zero(-front[i].base_normal - front[i].surfgrad) - mirror[i].normal),
              rounding);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryKind, ::testing::ValuesIn(test::every_kind()),
                         [](const auto& kind) { return std::string(kind.param.name); });

} // namespace
} // namespace surfgrad::engine
