/// Listing 1 and section 2.10: resolving once, and several times on double-sided surfaces.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <algorithm>
#include <surfgrad/derivative.hpp>
#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::test {
namespace {

// A few dozen roundings of double, 1e-16 each, on input with condition numbers up to ten.
constexpr double exact = 1e-13;

/// A sum of a tangent-basis layer and a volume layer.
vec3d layers(const Frame<double>& frame, const Fragment& f, vec2d deriv, vec3d gradient) {
  const TangentFrame<double> basis = tangent_basis(frame, f.duv_dx, f.duv_dy);
  return from_tbn(deriv, basis.tangent, basis.bitangent) + from_volume_gradient(frame.normal, gradient);
}

TEST(Resolve, IsEquation1) {
  Random random(101);
  Worst worst("equation 1");
  for (long i = 0; i < 1000; ++i) {
    const vec3d n = random.unit_vector();
    const vec3d g = from_volume_gradient(n, random.magnitude(1e-3, 1e3) * random.vector3());
    const vec3d expected = (1 / length(n - g)) * (n - g);
    worst.add(resolve_normal(make_frame(n), g), expected, exact, i);
  }
}

TEST(Resolve, ZeroGradientKeepsTheNormal) { // Ong: a flat layer changes nothing
  Random random(102);
  Worst worst("flat layers");
  for (long i = 0; i < 200; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const Frame<double> frame = frame_at(p, f);
    const vec2d flat = derivative_from_normal(vec3d{0, 0, random.uniform(0.1, 1)});
    const vec3d other = layers(frame, f, random.vector2(), random.vector3());
    const TangentFrame<double> basis = tangent_basis(frame, f.duv_dx, f.duv_dy);
    const vec3d with_flat = other + from_tbn(flat, basis.tangent, basis.bitangent);
    worst.add(resolve_normal(frame, with_flat), resolve_normal(frame, other), 0, i);
    worst.add(resolve_normal(frame, vec3d{0, 0, 0}), p.normal, exact, i);
  }
}

TEST(Resolve, BackFaceModesOfOnePass) { // section 2.10
  Random random(103);
  Worst worst("same, mirror, flip after one pass");
  for (long i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Sphere{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const vec2d deriv = random.vector2();
    const vec3d gradient = random.vector3();
    const auto resolved = [&](bool front, BackFaces mode) {
      const Frame<double> frame = make_frame(p.normal, f.dp_dx, f.dp_dy, front, mode);
      return resolve_normal(frame, layers(frame, f, deriv, gradient));
    };
    const vec3d front = resolved(true, BackFaces::flip);
    worst.add(resolved(false, BackFaces::same), front, exact, i);
    worst.add(resolved(false, BackFaces::flip), -front, exact, i);
    // Mirror: the tangential part stays, the part along the normal changes side.
    const vec3d mirror = resolved(false, BackFaces::mirror);
    worst.add(mirror, front - (2 * dot(front, p.normal)) * p.normal, exact, i);
    worst.add(flip_from_mirror(mirror, -p.normal), -front, exact, i);
  }
}

TEST(Resolve, FlippedBackFaceAfterThreePassesIsMinusTheFront) { // section 2.11, rebase_frame
  Random random(104);
  Worst worst("flip after three passes");
  double without_sign = 0;
  for (long i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    Frame<double> front = make_frame(p.normal, f.dp_dx, f.dp_dy, true, BackFaces::flip);
    Frame<double> back = make_frame(p.normal, f.dp_dx, f.dp_dy, false, BackFaces::flip);
    Frame<double> wrong = back;
    for (int pass = 0; pass < 3; ++pass) {
      const vec2d deriv = random.vector2();
      const vec3d gradient = random.vector3();
      front = rebase_frame(front, resolve_normal(front, layers(front, f, deriv, gradient)));
      back = rebase_frame(back, resolve_normal(back, layers(back, f, deriv, gradient)));
      wrong = rebase_frame(wrong, resolve_normal(wrong, layers(wrong, f, deriv, gradient)));
      wrong.resolve_sign = 1;
    }
    worst.add(back.normal, -front.normal, 10 * exact, i); // three passes, each of which is as exact
    without_sign += std::acos(std::clamp(-dot(wrong.normal, front.normal), -1.0, 1.0)) / 300;
  }
  std::printf("  losing resolve_sign in the second pass would cost %.1f degrees on average\n",
              without_sign * 180 / 3.14159265358979324);
  EXPECT_GT(without_sign, 0.2);
}

TEST(Resolve, ReflectingAtTheEndDiffersAfterASecondVolumePass) {
  // Section 2.10's alternative: equal for one pass, not across a post-resolve volume layer.
  Random random(105);
  double difference = 0;
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint p = random_point(Sphere{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const vec3d first = random.vector3();
    const vec3d second = random.vector3();
    const auto two_passes = [&](bool is_front, BackFaces mode) {
      Frame<double> frame = make_frame(p.normal, f.dp_dx, f.dp_dy, is_front, mode);
      frame = rebase_frame(frame, resolve_normal(frame, from_volume_gradient(frame.normal, first)));
      return resolve_normal(frame, from_volume_gradient(frame.normal, second));
    };
    const vec3d by_mode = two_passes(false, BackFaces::flip);
    const vec3d by_reflection = flip_from_mirror(two_passes(false, BackFaces::mirror), -p.normal);
    EXPECT_NEAR(length(by_mode + two_passes(true, BackFaces::flip)), 0, exact);
    difference = std::max(difference, length(by_mode - by_reflection));
  }
  EXPECT_GT(difference, 0.1);
}

} // namespace
} // namespace surfgrad::test
