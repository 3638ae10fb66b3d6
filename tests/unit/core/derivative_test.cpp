/// Listings 4 and 9, equations 4 and 5, and the bicubic derivative.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/derivative.hpp>
#include <surfgrad/gradient.hpp>

namespace surfgrad::test {
namespace {

constexpr double eps = epsilon_v<double>;

TEST(Derivative, ThreeChannelsFollowEquation4) {
  Random random(401);
  Worst worst("equation 4, any length");
  for (long i = 0; i < 2000; ++i) {
    const vec2d d = random.vector2(-100, 100);
    const double length = random.magnitude(1e-6, 1e6);
    const vec3d m{-d.x * length, -d.y * length, length};
    // Building m rounds once, the division once.
    worst.add(derivative_from_normal(m), d, 2 * eps * max_abs(d), i);
  }
}

TEST(Derivative, TwoChannelsFollowEquation5) {
  Random random(402);
  Worst worst("equation 5 against equation 4 on unit normals");
  for (long i = 0; i < 2000; ++i) {
    const vec3d up = random.unit_vector();
    const vec3d m{up.x, up.y, std::abs(up.z)};
    if (m.z < 0.01) continue;
    const vec2d d = derivative_from_normal(m);
    // m is unit to 2 eps, which 1 - x^2 - y^2 = z^2 sees divided by z^2; the documented bound adds to it.
    const double relative = 2 * eps + 3 * eps / (m.z * m.z);
    worst.add(derivative_from_normal(vec2d{m.x, m.y}), d, relative * max_abs(d), i);
  }
}

TEST(Derivative, SlopesAreClampedTo128InTheirDirection) {
  Random random(403);
  Worst worst("clamped slopes");
  for (long i = 0; i < 500; ++i) {
    const double angle = random.uniform(-3.14, 3.14);
    const vec2d direction{std::cos(angle), std::sin(angle)};
    const double steepest = max_abs(direction);
    const vec2d expected = (-max_slope / steepest) * direction;
    worst.add(derivative_from_normal(vec3d{direction.x, direction.y, 1e-9}), expected, 4 * eps * max_slope,
              i);
    worst.add(derivative_from_normal(1.0000001 * direction), expected, 4 * eps * max_slope, i);
  }
  EXPECT_EQ(derivative_from_normal(vec3d{1, 0, 0}).x, -128);
  EXPECT_EQ(derivative_from_normal(vec2d{0, -1}).y, 128);
  EXPECT_NEAR(std::atan(double{max_slope}) * 180 / 3.14159265358979324, 89.55, 0.005);
}

TEST(Derivative, ThreeChannelClampMeetsListing4AtTheLimit) {
  // The two decodes agree for unit normals up to and beyond the clamp: both divide by the same limit.
  Random random(404);
  Worst worst("both decodes near the clamp");
  for (long i = 0; i < 500; ++i) {
    const double angle = random.uniform(-3.14, 3.14);
    const double z = random.uniform(0.0, 0.02);
    const double r = std::sqrt(1 - z * z);
    const vec3d m{r * std::cos(angle), r * std::sin(angle), z};
    const vec2d three = derivative_from_normal(m);
    const vec2d two = derivative_from_normal(vec2d{m.x, m.y});
    // z^2 comes back with an absolute error of 2 eps, at least (max / 128)^2 >= 3e-5 in size.
    worst.add(two, three, 128 * 4 * eps / 3e-5, i);
  }
}

TEST(Derivative, NormalFromDerivativeInverts) {
  Random random(405);
  Worst worst("normal_from_derivative and back");
  for (long i = 0; i < 2000; ++i) {
    const vec2d d = random.vector2(-120, 120);
    const vec3d m = normal_from_derivative(d);
    EXPECT_NEAR(dot(m, m), 1, 8 * eps);
    worst.add(derivative_from_normal(m), d, 6 * eps * max_abs(d), i); // 4 in m, one in the division
  }
}

TEST(Derivative, ThreeTapsConvergeWithTheFirstOrder) { // listing 9
  // Halving the pixel halves the error of the gradient per unit of length: a forward difference.
  Random random(406);
  double smallest = 10;
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const vec3d truth = from_parametric_derivative(p.normal, p.dp_du, p.dp_dv,
                                                   gradient_of([](auto q) { return wavy(q); }, p.uv));
    const auto error = [&](double step) {
      const vec2d x = step * f.duv_dx;
      const vec2d y = step * f.duv_dy;
      const Frame<double> frame = make_frame(p.normal, step * f.dp_dx, step * f.dp_dy);
      const vec2d dh = derivative_from_heights(wavy(p.uv), wavy(p.uv + x), wavy(p.uv + y));
      return length(from_height_derivative(frame, dh) - truth);
    };
    const double coarse = error(1e-2);
    const double fine = error(5e-3);
    EXPECT_LT(coarse, 1e-3);
    if (coarse < 1e-8) continue; // an inflection: the second order shows
    smallest = std::min(smallest, coarse / fine);
    largest = std::max(largest, coarse / fine);
  }
  std::printf("  error ratio when the step halves: %.4f to %.4f\n", smallest, largest);
  EXPECT_GT(smallest, 1.8);
  EXPECT_LT(largest, 2.2);
}

/// Uniform cubic B-spline by the recursion of Cox and de Boor, knots at the integers: independent of
/// the closed form under test.
template <class T>
T spline(const mat4d& texels, vec2<T> q) {
  struct Basis {
    static T value(int i, int degree, T x) {
      if (degree == 0) return x.value >= i && x.value < i + 1 ? T(1.0) : T(0.0);
      return (x - T(i)) / T(degree) * value(i, degree - 1, x) +
             (T(i + degree + 1) - x) / T(degree) * value(i + 1, degree - 1, x);
    }
  };
  const double rows[4][4] = {{texels.x.x, texels.x.y, texels.x.z, texels.x.w},
                             {texels.y.x, texels.y.y, texels.y.z, texels.y.w},
                             {texels.z.x, texels.z.y, texels.z.z, texels.z.w},
                             {texels.w.x, texels.w.y, texels.w.z, texels.w.w}};
  T sum(0.0);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      // The texel at index i is the coefficient of the basis function centred there.
      sum = sum + T(rows[j][i]) * Basis::value(i - 3, 3, q.x) * Basis::value(j - 3, 3, q.y);
  return sum;
}

TEST(Derivative, BicubicIsTheDerivativeOfTheSpline) {
  Random random(407);
  Worst worst("derivative_from_bicubic against de Boor's recursion");
  for (long i = 0; i < 1000; ++i) {
    const auto row = [&] {
      const vec2d a = random.vector2();
      const vec2d b = random.vector2();
      return vec4<double>{a.x, a.y, b.x, b.y};
    };
    const mat4d texels{row(), row(), row(), row()};
    const vec2d fraction = random.vector2(0, 1);
    const vec2d expected = gradient_of([&](auto q) { return spline(texels, q); }, fraction);
    worst.add(derivative_from_bicubic(texels, fraction), expected, 16 * eps, i); // 8 eps of each evaluation
  }
}

TEST(Derivative, BicubicReproducesQuadratics) {
  // The spline with the samples of x^2 as coefficients is x^2 + 1/3: its slope is exact.
  const auto h = [](double s, double t) { return 0.5 * s * s - 0.25 * s * t + 0.75 * t * t + s - 2 * t; };
  const auto row = [&](double t) { return vec4<double>{h(-1, t), h(0, t), h(1, t), h(2, t)}; };
  const mat4d texels{row(-1), row(0), row(1), row(2)};
  for (double s = 0; s <= 1; s += 0.125) {
    for (double t = 0; t <= 1; t += 0.125) {
      const vec2d d = derivative_from_bicubic(texels, vec2d{s, t});
      EXPECT_NEAR(d.x, s - 0.25 * t + 1, 8 * 8 * eps); // the largest texel is below 8
      EXPECT_NEAR(d.y, -0.25 * s + 1.5 * t - 2, 8 * 8 * eps);
    }
  }
}

TEST(Derivative, BicubicIsContinuousAcrossTexels) {
  // At fraction 1 the window moves on by one texel: the same derivative from the new window.
  const mat4d left{{1, 3, -2, 4}, {0, 2, 5, -1}, {2, 2, 1, 0}, {-3, 1, 4, 2}};
  const mat4d right{{3, -2, 4, 7}, {2, 5, -1, -7}, {2, 1, 0, 7}, {1, 4, 2, -7}};
  for (double t = 0; t <= 1; t += 0.25) {
    const vec2d a = derivative_from_bicubic(left, vec2d{1, t});
    const vec2d b = derivative_from_bicubic(right, vec2d{0, t});
    EXPECT_NEAR(a.x, b.x, 8 * 7 * eps);
    EXPECT_NEAR(a.y, b.y, 8 * 7 * eps);
  }
}

} // namespace
} // namespace surfgrad::test
