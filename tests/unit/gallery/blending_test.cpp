// The older ways must be what their names say, or the gallery would prove nothing.

#include "gallery/blending.hpp"
#include "support/random.hpp"

#include <surfgrad/derivative.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::gallery {
namespace {

constexpr vec3<double> flat{0, 0, 1};

vec3<double> random_normal(test::Random& random) {
  return normal_from_derivative(vec2<double>{random.uniform(-2, 2), random.uniform(-2, 2)});
}

double distance(vec3<double> a, vec3<double> b) { return length(a - b); }

// A handful of operations on unit vectors, none of which cancels.
constexpr double rounding = 1e-14;

TEST(Blending, FlatMapsChangeNothingInWhiteoutAndReoriented) {
  test::Random random(11);
  for (int i = 0; i < 1000; ++i) {
    const vec3<double> n = random_normal(random);
    EXPECT_LT(distance(blend_whiteout(n, flat), n), rounding);
    EXPECT_LT(distance(blend_whiteout(flat, n), n), rounding);
    EXPECT_LT(distance(blend_reoriented(n, flat), n), rounding);
    EXPECT_LT(distance(blend_reoriented(flat, n), n), rounding);
  }
}

TEST(Blending, FlatMapsFlattenInLinearAndUdn) {
  test::Random random(12);
  for (int i = 0; i < 1000; ++i) {
    const vec3<double> n = random_normal(random);
    const auto slope = [](vec3<double> v) { return std::hypot(v.x, v.y) / v.z; };
    // The mean with +z lies half way: its angle is half of the normal's.
    EXPECT_NEAR(std::atan(slope(blend_linear(flat, n))), 0.5 * std::atan(slope(n)), rounding);
    // UDN over a flat base leaves the sine where the tangent should be.
    EXPECT_NEAR(slope(blend_udn(flat, n)), std::hypot(n.x, n.y), rounding);
    EXPECT_LT(distance(blend_udn(n, flat), n), rounding);
  }
}

TEST(Blending, ReorientedTurnsTheDetailWithTheBase) {
  test::Random random(13);
  for (int i = 0; i < 1000; ++i) {
    const vec3<double> base = random_normal(random);
    const vec3<double> detail = random_normal(random);
    const vec3<double> turned = blend_reoriented(base, detail);
    // A rotation keeps the angle to the axis that it takes along.
    EXPECT_NEAR(dot(turned, base), detail.z, rounding);
    // The axis of the shortest rotation stays where it is.
    const vec3<double> axis = normalize_or_zero(cross(flat, base));
    EXPECT_NEAR(dot(turned, axis), dot(detail, axis), rounding);
  }
}

TEST(Blending, MapsAreBlendedTexelByTexel) {
  image::Image a = image::make_image(2, 1, 3, image::Depth::unorm16);
  image::Image b = a;
  const vec3<double> tilted = normalize_or_zero(vec3<double>{0.6, 0, 0.8});
  scene::set_normal(a, 0, 0, flat);
  scene::set_normal(a, 1, 0, tilted);
  scene::set_normal(b, 0, 0, tilted);
  scene::set_normal(b, 1, 0, flat);
  const image::Image map = blended_map(a, b, blend_whiteout);
  // One step of a 16-bit code to read the inputs, one to write the result.
  for (int x = 0; x < 2; ++x) EXPECT_NEAR(2.0 * map.at(x, 0, 0) - 1, 0.6, 4.0 / 65535);
}

} // namespace
} // namespace surfgrad::gallery
