/// Algebra that holds for every surface gradient: linearity, rotation, orthogonality, round trips.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/derivative.hpp>
#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>
#include <surfgrad/triplanar.hpp>
#include <vector>

namespace surfgrad::test {
namespace {

// A few dozen roundings of double, 1e-16 each, on input with condition numbers up to ten.
constexpr double exact = 1e-13;

/// Everything that the gradient functions take, at a random point of a torus.
struct Inputs {
  SurfacePoint point;
  Fragment fragment;
  vec2d dst_dx, dst_dy, deriv, deriv_y, deriv_z;
  vec3d volume;
};
Inputs random_inputs(Random& random) {
  const SurfacePoint p = random_point(Torus{}, random);
  const UvMap st = random_uv_map(random);
  const Fragment f = random_camera(p, random).fragment(p);
  return {p,
          f,
          st.linear(f.duv_dx),
          st.linear(f.duv_dy),
          random.vector2(),
          random.vector2(),
          random.vector2(),
          random.vector3()};
}

/// Gradients of each kind; those before from_perturbed_normal are linear in the derivatives.
std::vector<vec3d> gradients(const Inputs& in) {
  const vec3d n = in.point.normal;
  const Frame<double> frame = make_frame(n, in.fragment.dp_dx, in.fragment.dp_dy);
  const TangentFrame<double> basis = tangent_basis(frame, in.dst_dx, in.dst_dy);
  const vec2d size{4, 8};
  return {from_tbn(in.deriv, basis.tangent, basis.bitangent),
          from_parametric_derivative(n, in.point.dp_du, in.point.dp_dv, in.deriv),
          from_height_derivative(frame, in.deriv),
          from_texel_derivative(frame, in.deriv, size, in.dst_dx, in.dst_dy),
          from_volume_gradient(n, in.volume),
          from_triplanar(n, vec3d{0.5, 0.3, 0.2}, in.deriv, in.deriv_y, in.deriv_z)};
}

TEST(Identities, GradientsAreLinear) { // equations 2 and 3, Golubev 34 and 35
  Random random(31);
  Worst worst("linearity");
  for (long i = 0; i < 500; ++i) {
    const Inputs a = random_inputs(random);
    Inputs b = a;
    b.deriv = random.vector2();
    b.deriv_y = random.vector2();
    b.deriv_z = random.vector2();
    b.volume = random.vector3();
    const double s = random.uniform(-2, 2);
    const double t = random.uniform(-2, 2);
    Inputs mixed = a;
    mixed.deriv = s * a.deriv + t * b.deriv;
    mixed.deriv_y = s * a.deriv_y + t * b.deriv_y;
    mixed.deriv_z = s * a.deriv_z + t * b.deriv_z;
    mixed.volume = s * a.volume + t * b.volume;
    const auto ga = gradients(a);
    const auto gb = gradients(b);
    const auto gm = gradients(mixed);
    for (std::size_t k = 0; k < gm.size(); ++k) {
      const vec3d expected = s * ga[k] + t * gb[k];
      worst.add(gm[k], expected, exact * (1 + 4 * max_abs(ga[k]) + 4 * max_abs(gb[k])), i);
    }
  }
}

TEST(Identities, GradientsArePerpendicularToTheNormal) {
  Random random(32);
  Worst worst("dot(g, n)");
  for (long i = 0; i < 1000; ++i) {
    const Inputs in = random_inputs(random);
    for (const vec3d g : gradients(in)) worst.add(dot(g, in.point.normal), 0, exact * (1 + max_abs(g)), i);
  }
}

TEST(Identities, GradientsTurnWithTheScene) {
  Random random(33);
  Worst worst("rotation");
  for (long i = 0; i < 500; ++i) {
    const Inputs in = random_inputs(random);
    const mat3d r = random.rotation();
    Inputs turned = in;
    for (vec3d* v : {&turned.point.normal, &turned.point.dp_du, &turned.point.dp_dv, &turned.fragment.dp_dx,
                     &turned.fragment.dp_dy, &turned.volume})
      *v = r * *v;
    const auto before = gradients(in);
    const auto after = gradients(turned);
    // The last kind projects along the axes of space, which do not turn with the scene.
    for (std::size_t k = 0; k + 1 < before.size(); ++k)
      worst.add(after[k], r * before[k], exact * (1 + 10 * max_abs(before[k])), i);
  }
}

TEST(Identities, ResolvedNormalGivesTheGradientBack) {
  Random random(34);
  Worst worst("from_perturbed_normal(n, resolve(n, g)) = g");
  for (long i = 0; i < 1000; ++i) {
    const Inputs in = random_inputs(random);
    const Frame<double> frame = make_frame(in.point.normal);
    for (const vec3d g : gradients(in)) {
      const double size = 1 + dot(g, g); // the resolve divides by sqrt(1 + g^2), the way back multiplies
      worst.add(from_perturbed_normal(frame.normal, resolve_normal(frame, g)), g, exact * size, i);
    }
  }
}

TEST(Identities, SumDoesNotDependOnTheOrderOfLayers) {
  Random random(35);
  Worst worst("order of layers");
  for (long i = 0; i < 500; ++i) {
    const Inputs in = random_inputs(random);
    const auto g = gradients(in);
    vec3d forward{0, 0, 0};
    vec3d backward{0, 0, 0};
    double size = 1;
    for (std::size_t k = 0; k < g.size(); ++k) {
      forward = forward + g[k];
      backward = backward + g[g.size() - 1 - k];
      size += max_abs(g[k]);
    }
    const Frame<double> frame = make_frame(in.point.normal);
    worst.add(resolve_normal(frame, forward), resolve_normal(frame, backward), exact * size, i);
    // A layer and its twin of scale -1 cancel exactly.
    for (const vec3d layer : g) worst.add(layer + scale_bump(-1.0, layer), vec3d{0, 0, 0}, 0, i);
  }
}

} // namespace
} // namespace surfgrad::test
