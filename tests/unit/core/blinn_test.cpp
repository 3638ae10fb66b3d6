/// Blinn's perturbed normal and the normal of the surface that is really displaced.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::test {
namespace {

template <class Surface>
void compose_like_blinn(const Surface& surface, Random& random, Worst& worst) {
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(surface, random);
    const UvMap st = random_uv_map(random); // sheared; half of them mirrored
    const Fragment f = random_camera(p, random).fragment(p);
    // Two heights, composed as gradients; Blinn's formula gets their sum.
    const double scale = random.uniform(0.2, 1.5);
    const vec2d first = gradient_of([&](auto q) { return wavy(q); }, st(p.uv));
    const vec2d second = gradient_of([&](auto uv) { return wavy(surface.position(uv.x, uv.y)); }, p.uv);
    const Frame<double> frame = frame_at(p, f);
    const vec3d g =
        scale * from_texel_derivative(frame, first, vec2d{1, 1}, st.linear(f.duv_dx), st.linear(f.duv_dy)) +
        from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, second);

    const auto [t, b] = st.tangents(p);
    const UvMap inverse = st.inverse();
    const vec2d second_st{second.x * inverse.s.x + second.y * inverse.t.x,
                          second.x * inverse.s.y + second.y * inverse.t.y};
    const vec2d h = scale * first + second_st;
    // T + h_s N and B + h_t N: the derivatives of P + h N where h dN is dropped.
    const vec3d blinn = normalize_or_zero(cross(t + h.x * p.normal, b + h.y * p.normal));
    const double side = st.determinant() < 0 ? -1 : 1; // mirrored coordinates turn T x B inwards
    worst.add(resolve_normal(frame, g), side * blinn, 1e-9, i);
  }
}

TEST(Blinn, ComposedNormalEqualsTheCrossProductOfTheDisplacedTangents) {
  Random random(1978);
  {
    Worst worst("Blinn's normal on a sphere");
    compose_like_blinn(Sphere{}, random, worst);
  }
  {
    Worst worst("Blinn's normal on a torus");
    compose_like_blinn(Torus{}, random, worst);
  }
  {
    Worst worst("Blinn's normal on a plane");
    compose_like_blinn(Plane{}, random, worst);
  }
}

/// Normal of P + h N by dual numbers, with the curvature that Blinn neglects.
template <class Surface, class Height>
vec3d displaced_normal(const Surface& surface, vec2d uv, Height height) {
  const Dual<2> u = Dual<2>::variable(uv.x, 0);
  const Dual<2> v = Dual<2>::variable(uv.y, 1);
  const vec3<Dual<2>> p = surface.position(u, v) + height(vec2<Dual<2>>{u, v}) * surface.normal(u, v);
  return normalize_or_zero(cross(partial_of(p, 0), partial_of(p, 1)));
}

TEST(Blinn, ShapeOperatorAccountsForTheWholeNeglect) {
  // The displaced surface's normal is normalize(N - (I + h dN)^-1 g), dN the shape operator.
  Random random(1979);
  Worst worst("displaced normal with the shape operator");
  const auto check = [&](const auto& surface) {
    for (long i = 0; i < 300; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const auto height = [](auto q) { return decltype(q.x)(0.2) * wavy(q); };
      const double h = height(p.uv);
      const vec3d g = from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, gradient_of(height, p.uv));
      // In the basis dp_du, dp_dv: (I + h dN) maps dp_du to dp_du + h dn_du. Solve for the preimage
      // through the moved basis: g' has the same products with the moved tangents as g with the old.
      const vec3d a = p.dp_du + h * p.dn_du;
      const vec3d b = p.dp_dv + h * p.dn_dv;
      const vec3d corrected =
          from_parametric_derivative(p.normal, a, b, vec2d{dot(g, p.dp_du), dot(g, p.dp_dv)});
      const vec3d resolved = resolve_normal(make_frame(p.normal), corrected);
      worst.add(resolved, displaced_normal(surface, p.uv, height), 1e-9, i);
    }
  };
  check(Sphere{});
  check(Torus{});
}

TEST(Blinn, NeglectFallsWithTheSquareOfTheAmplitude) {
  Random random(1980);
  double mean[3] = {0, 0, 0};
  for (int i = 0; i < 400; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    double amplitude = 0.02;
    for (double& sum : mean) {
      const auto height = [amplitude](auto q) { return decltype(q.x)(amplitude) * wavy(q); };
      const vec3d g = from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, gradient_of(height, p.uv));
      const vec3d truth = displaced_normal(Torus{}, p.uv, height);
      sum += length(cross(resolve_normal(make_frame(p.normal), g), truth)) / 400 * 57.29577951;
      amplitude /= 2;
    }
  }
  std::printf("  neglect as the amplitude halves: %.5f, %.5f, %.5f degrees\n", mean[0], mean[1], mean[2]);
  EXPECT_NEAR(mean[0] / mean[1], 4, 0.2);
  EXPECT_NEAR(mean[1] / mean[2], 4, 0.2);
}

} // namespace
} // namespace surfgrad::test
