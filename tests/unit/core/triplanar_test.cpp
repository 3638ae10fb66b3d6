/// Listings 13 and 14, section 2.8 and Golubev's sections 4 and 5.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/derivative.hpp>
#include <surfgrad/resolve.hpp>
#include <surfgrad/triplanar.hpp>
#include <vector>

namespace surfgrad::test {
namespace {

// A few dozen roundings of double, 1e-16 each, on input of order one.
constexpr double exact = 1e-13;

std::vector<TriplanarConvention> all_conventions() {
  std::vector<TriplanarConvention> list;
  for (const Handedness h : {Handedness::left, Handedness::right})
    for (const TextureOrigin o : {TextureOrigin::lower_left, TextureOrigin::upper_left})
      for (const TriplanarPlanes p : {TriplanarPlanes::mikkelsen, TriplanarPlanes::golubev})
        list.push_back({h, o, p});
  return list;
}

/// Three different height maps; the derivatives that a fetch from each would give.
template <class T>
T height_x(vec2<T> st) {
  return wavy(st);
}
template <class T>
T height_y(vec2<T> st) {
  return wavy(vec2<T>{st.y * T(0.8) + T(0.1), st.x});
}
template <class T>
T height_z(vec2<T> st) {
  return wavy(vec2<T>{st.x * T(1.2), st.y - T(0.3)});
}

struct Derivatives {
  vec2d x, y, z;
};
Derivatives sampled(const TriplanarCoordinates<double>& st) {
  return {gradient_of([](auto q) { return height_x(q); }, st.x_plane),
          gradient_of([](auto q) { return height_y(q); }, st.y_plane),
          gradient_of([](auto q) { return height_z(q); }, st.z_plane)};
}

TEST(Triplanar, GradientIsThatOfEquation7InEveryConvention) { // listing 13, Golubev 46 to 49
  Random random(1301);
  for (const TriplanarConvention& convention : all_conventions()) {
    Worst worst("triplanar gradient, convention " + std::to_string(int(convention.handedness)) +
                std::to_string(int(convention.origin)) + std::to_string(int(convention.planes)));
    for (long i = 0; i < 300; ++i) {
      const vec3d p = random.vector3(-2, 2);
      const vec3d w = triplanar_weights(random.unit_vector());
      // Equation 7, built from the very coordinates that the map is sampled at.
      const auto height = [&](auto q) {
        using T = decltype(q.x);
        const auto st = triplanar_coordinates(q, convention);
        return T(w.x) * height_x(st.x_plane) + T(w.y) * height_y(st.y_plane) + T(w.z) * height_z(st.z_plane);
      };
      const Derivatives d = sampled(triplanar_coordinates(p, convention));
      worst.add(triplanar_gradient(w, d.x, d.y, d.z, convention), gradient_of(height, p), exact, i);
    }
  }
}

TEST(Triplanar, ConventionsSampleThePrintedCoordinates) {
  const vec3d p{2, 3, 5};
  using Tc = TriplanarConvention;
  const auto expect = [&](Tc c, vec2d x, vec2d y, vec2d z) {
    const TriplanarCoordinates<double> st = triplanar_coordinates(p, c);
    EXPECT_EQ(st.x_plane.x, x.x);
    EXPECT_EQ(st.x_plane.y, x.y);
    EXPECT_EQ(st.y_plane.x, y.x);
    EXPECT_EQ(st.y_plane.y, y.y);
    EXPECT_EQ(st.z_plane.x, z.x);
    EXPECT_EQ(st.z_plane.y, z.y);
  };
  expect(Tc{}, {5, 3}, {2, 5}, {2, 3});                                  // equation 7
  expect(Tc{.handedness = Handedness::right}, {-5, 3}, {2, -5}, {2, 3}); // section 2.8
  expect(Tc{.origin = TextureOrigin::upper_left}, {5, -3}, {2, -5}, {2, -3});
  expect(Tc{.planes = TriplanarPlanes::golubev}, {3, 5}, {5, 2}, {2, 3}); // Golubev 46
}

TEST(Triplanar, DefaultOverloadIsListing13AsPrinted) {
  Random random(1302);
  Worst worst("listing 13 as printed");
  for (long i = 0; i < 300; ++i) {
    const vec3d n = random.unit_vector();
    const vec3d w = triplanar_weights(n);
    const vec2d dx = random.vector2();
    const vec2d dy = random.vector2();
    const vec2d dz = random.vector2();
    const vec3d grad{w.z * dz.x + w.y * dy.x, w.z * dz.y + w.x * dx.y, w.x * dx.x + w.y * dy.y};
    worst.add(triplanar_gradient(w, dx, dy, dz), grad, exact, i);
    worst.add(from_triplanar(n, w, dx, dy, dz), grad - dot(n, grad) * n, exact, i);
  }
}

TEST(Triplanar, RightHandNegatesTheThirdComponent) { // section 2.8
  Random random(1303);
  Worst worst("right-hand coordinate frame");
  for (long i = 0; i < 100; ++i) {
    const vec3d w = triplanar_weights(random.unit_vector());
    const vec2d dx = random.vector2();
    const vec2d dy = random.vector2();
    const vec2d dz = random.vector2();
    const vec3d left = triplanar_gradient(w, dx, dy, dz);
    const vec3d right = triplanar_gradient(w, dx, dy, dz, {.handedness = Handedness::right});
    worst.add(right, vec3d{left.x, left.y, -left.z}, 0, i);
  }
}

TEST(Triplanar, EqualsTheWeightedSumOfThreeParametricGradients) { // section 2.8's remark
  Random random(1304);
  Worst worst("weighted sum of three listing-8 gradients");
  for (const TriplanarConvention& convention : all_conventions()) {
    for (long i = 0; i < 300; ++i) {
      const SurfacePoint p = random_point(Torus{}, random);
      const Fragment f = random_camera(p, random).fragment(p);
      const Frame<double> frame = frame_at(p, f);
      const vec3d w = triplanar_weights(p.normal);
      const TriplanarCoordinates<double> at = triplanar_coordinates(p.position, convention);
      const TriplanarCoordinates<double> dx = triplanar_coordinates(f.dp_dx, convention); // linear
      const TriplanarCoordinates<double> dy = triplanar_coordinates(f.dp_dy, convention);
      const Derivatives d = sampled(at);
      const auto one = [&](vec2d deriv, vec2d dst_dx, vec2d dst_dy) {
        return from_texel_derivative(frame, deriv, vec2d{1, 1}, dst_dx, dst_dy);
      };
      const vec3d sum = w.x * one(d.x, dx.x_plane, dy.x_plane) + w.y * one(d.y, dx.y_plane, dy.y_plane) +
                        w.z * one(d.z, dx.z_plane, dy.z_plane);
      worst.add(from_triplanar(p.normal, w, d.x, d.y, d.z, convention), sum, 1e-9, i);
    }
  }
}

TEST(Triplanar, PlanarMatrixIsTheVolumeProjection) { // Golubev, equations 39 to 44 and 50
  Random random(1305);
  Worst worst("equation 44's matrix, equation 31 with the tangents of equation 42, and equation 30");
  for (long i = 0; i < 500; ++i) {
    const vec3d n = random.unit_vector();
    if (std::abs(n.z) < 0.1) continue; // equation 42 divides by it
    const vec2d d = random.vector2();
    const vec3d matrix{(1 - n.x * n.x) * d.x - n.x * n.y * d.y, -n.x * n.y * d.x + (1 - n.y * n.y) * d.y,
                       -n.x * n.z * d.x - n.y * n.z * d.y};
    worst.add(from_volume_gradient(n, planar_gradient(PlaneAxis::z, d)), matrix, exact, i);
    const vec3d t{1, 0, -n.x / n.z};
    const vec3d b{0, 1, -n.y / n.z};
    worst.add(from_parametric_derivative(n, t, b, d), matrix, 10 * exact / std::abs(n.z), i);
  }
}

TEST(Triplanar, BlendsAlreadyPerturbedNormals) { // Golubev, equation 45; weights that sum to 1
  Random random(1306);
  Worst worst("equation 45");
  for (long i = 0; i < 500; ++i) {
    const vec3d n = random.unit_vector();
    const vec3d w = triplanar_weights(n);
    const auto near_normal = [&] { return n + 0.5 * random.vector3(); };
    const vec3d n1 = near_normal();
    const vec3d n2 = near_normal();
    const vec3d n3 = near_normal();
    const double a1 = dot(n1, n);
    const double a2 = dot(n2, n);
    const double a3 = dot(n3, n);
    if (std::min({a1, a2, a3}) < 0.1) continue;
    const vec3d expected = n - (w.z / a1) * n1 - (w.x / a2) * n2 - (w.y / a3) * n3;
    const vec3d sum = w.z * from_perturbed_normal(n, n1) + w.x * from_perturbed_normal(n, n2) +
                      w.y * from_perturbed_normal(n, n3);
    worst.add(sum, expected, 10 * exact, i);
  }
}

TEST(Triplanar, WorksOnAResolvedNormal) { // section 2.8: after one resolve, on its normal
  Random random(1307);
  Worst worst("triplanar projection as a second pass");
  for (long i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const Frame<double> first = frame_at(p, f);
    const vec3d n = resolve_normal(first, from_volume_gradient(first.normal, random.vector3()));
    const Frame<double> second = rebase_frame(first, n);
    const vec3d w = triplanar_weights(second.normal);
    const vec2d dx = random.vector2();
    const vec2d dy = random.vector2();
    const vec2d dz = random.vector2();
    const vec3d g = from_triplanar(second.normal, w, dx, dy, dz);
    const vec3d volume = triplanar_gradient(w, dx, dy, dz);
    worst.add(dot(g, n), 0, exact, i);
    const vec3d expected = n - volume + dot(n, volume) * n;
    worst.add(resolve_normal(second, g), (1 / length(expected)) * expected, exact, i);
  }
}

TEST(Triplanar, WeightsAreThePrintedFormula) { // listing 14
  Random random(1401);
  Worst worst("listing 14 in extended precision, k = 1 to 100");
  for (long i = 0; i < 4000; ++i) {
    const vec3d n = random.unit_vector();
    const double k = i % 4 == 0 ? random.uniform(1, 100) : 1 + static_cast<double>(i % 100);
    const vec3d w = triplanar_weights(n, k);
    long double p[3];
    long double sum = 0;
    const double component[3] = {n.x, n.y, n.z};
    for (int c = 0; c < 3; ++c) {
      // The offset as double has it; the printed text underflows in float, hence extended precision.
      p[c] = std::pow(std::max(0.0L, std::abs(static_cast<long double>(component[c])) - 0.2),
                      static_cast<long double>(k));
      sum += p[c];
    }
    const double bound = (5 + 4 * k) * epsilon_v<double>; // as documented
    worst.add(w.x, static_cast<double>(p[0] / sum), bound, i);
    worst.add(w.y, static_cast<double>(p[1] / sum), bound, i);
    worst.add(w.z, static_cast<double>(p[2] / sum), bound, i);
    EXPECT_NEAR(w.x + w.y + w.z, 1, 3 * epsilon_v<double>);
  }
}

TEST(Triplanar, WeightsFollowPermutationsAndSigns) {
  Random random(1402);
  for (int i = 0; i < 500; ++i) {
    const vec3d n = random.unit_vector();
    const double k = random.uniform(1, 100);
    const vec3d w = triplanar_weights(n, k);
    const vec3d turned = triplanar_weights(vec3d{n.y, n.z, n.x}, k);
    const vec3d negated = triplanar_weights(-n, k);
    // The sum of three terms rounds differently in another order: one rounding of each quotient.
    EXPECT_NEAR(turned.x, w.y, 2 * epsilon_v<double>);
    EXPECT_NEAR(turned.y, w.z, 2 * epsilon_v<double>);
    EXPECT_NEAR(turned.z, w.x, 2 * epsilon_v<double>);
    EXPECT_EQ(negated.x, w.x);
    EXPECT_EQ(negated.z, w.z);
  }
}

TEST(Triplanar, WeightsDoNotUnderflowAtHighSharpness) {
  const vec3<float> w = triplanar_weights(vec3<float>{0.6f, 0.6f, 0.52915f}, 100.0f);
  EXPECT_NEAR(w.x, 0.5f, 1e-4f); // 0.4^100 is 1e-40: 0 / 0 if taken before the division
  EXPECT_NEAR(w.x + w.y + w.z, 1.0f, 1e-6f);
}

} // namespace
} // namespace surfgrad::test
