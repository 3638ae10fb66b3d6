/// Listing 17, projected texture derivatives and the mip level.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/screen.hpp>

namespace surfgrad::test {
namespace {

TEST(Screen, DerivativesAreThoseOfTheRayPlaneIntersection) { // listing 17
  Random random(1701);
  // Depth near the far plane changes by near / distance^2 a unit: rounding is amplified up to 1e4 times.
  Worst worst("listing 17 against dual numbers of the ray and plane");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 400; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const Pinhole camera = random_camera(p, random);
      const Fragment f = camera.fragment(p);
      const double near_clip = random.magnitude(1e-3, 0.5);
      const mat4d m = camera.world_from_screen(near_clip, random.magnitude(10, 1e4));
      const double length_of_normal = random.sign() * random.magnitude(0.01, 100);
      const ScreenDerivatives<double> d =
          screen_derivatives(p.position, length_of_normal * p.normal, m, f.pixel.x, f.pixel.y);
      const double size = max_abs(f.dp_dx) + max_abs(f.dp_dy);
      worst.add(d.dp_dx, f.dp_dx, 1e-11 * size, i);
      worst.add(d.dp_dy, f.dp_dy, 1e-11 * size, i);
      // Already perpendicular, so that they are sigma_x and sigma_y too (section 2.11).
      worst.add(dot(d.dp_dx, p.normal), 0, 1e-11 * size, i);
    }
  });
}

TEST(Screen, DerivativesWithRandomProjectiveMatrices) { // any matrix, not only cameras
  Random random(1702);
  Worst worst("listing 17 against the cut of a line and a plane, random matrices");
  long compared = 0;
  for (long i = 0; i < 2000; ++i) {
    const auto row = [&] {
      const vec2d a = random.vector2();
      const vec2d b = random.vector2();
      return vec4<double>{a.x, a.y, b.x, b.y};
    };
    const mat4d m{row(), row(), row(), row()};
    const vec3d n = random.unit_vector();
    const vec4<double> plane{n.x, n.y, n.z, -dot(n, random.vector3())};
    const vec2d q{random.uniform(-2, 2), random.uniform(-2, 2)};
    // The homogeneous point where the line through depths 0 and 1 under (x, y) meets the plane.
    const auto lift = [](vec4<double> v) {
      return vec4<Dual<2>>{Dual<2>(v.x), Dual<2>(v.y), Dual<2>(v.z), Dual<2>(v.w)};
    };
    const mat4<Dual<2>> matrix{lift(m.x), lift(m.y), lift(m.z), lift(m.w)};
    const Dual<2> x = Dual<2>::variable(q.x, 0);
    const Dual<2> y = Dual<2>::variable(q.y, 1);
    const vec4<Dual<2>> a = matrix * vec4<Dual<2>>{x, y, Dual<2>(0.0), Dual<2>(1.0)};
    const vec4<Dual<2>> b = matrix * vec4<Dual<2>>{x, y, Dual<2>(1.0), Dual<2>(1.0)};
    const Dual<2> fa = dot(lift(plane), a);
    const Dual<2> fb = dot(lift(plane), b);
    const Dual<2> along = fa / (fa - fb);
    const vec4<Dual<2>> h = a + along * (b + Dual<2>(-1.0) * a);
    const vec3<Dual<2>> hit{h.x / h.w, h.y / h.w, h.z / h.w};
    // Both divisions amplify rounding: by 1 / |w| twice and by 1 / |fa - fb| twice.
    const double amplification = 1 / std::min(std::abs(h.w.value), std::abs(fa.value - fb.value));
    if (!(amplification < 100)) continue;
    ++compared;
    const ScreenDerivatives<double> d = screen_derivatives(value_of(hit), n, m, q.x, q.y);
    const double bound = 1e-15 * amplification * amplification * (1 + max_abs(value_of(hit))) * 10;
    worst.add(d.dp_dx, partial_of(hit, 0), bound, i);
    worst.add(d.dp_dy, partial_of(hit, 1), bound, i);
  }
  EXPECT_GT(compared, 1000);
}

TEST(Screen, NormalFacingAwayMayBeReflected) { // section 2.11's remark
  // A plane tilted slightly away from the viewer still has the derivatives of its plane; reflected
  // towards the observer it is the plane that the observer can see.
  Random random(1703);
  const SurfacePoint p = evaluate(Plane{}, vec2d{0.1, 0.2});
  const Pinhole camera = random_camera(p, random);
  const vec3d v = normalize_or_zero(camera.eye - p.position);
  const vec3d away = normalize_or_zero(p.normal - (dot(p.normal, v) + 0.05) * v);
  ASSERT_LT(dot(away, v), 0);
  const vec3d reflected = away - (2 * dot(v, away)) * v;
  EXPECT_GT(dot(reflected, v), 0);
  const vec2d pixel = camera.project(p.position);
  const ScreenDerivatives<double> d =
      screen_derivatives(p.position, reflected, camera.world_from_screen(0.1, 100), pixel.x, pixel.y);
  EXPECT_NEAR(dot(d.dp_dx, reflected), 0, 1e-10);
  EXPECT_NEAR(dot(d.dp_dy, reflected), 0, 1e-10);
}

TEST(Screen, ProjectedDerivativesAreTheChainRule) {
  Random random(1704);
  Worst worst("projected_derivatives against dual numbers");
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const auto s = [](auto q) { return wavy(q); };
    const auto t = [](auto q) { return wavy(decltype(q){q.y, q.z, q.x}); };
    const TextureDerivatives<double> d =
        projected_derivatives(gradient_of(s, p.position), gradient_of(t, p.position), f.dp_dx, f.dp_dy);
    const auto along = [&](auto function) {
      return gradient_of(
          [&](auto q) {
            using T = decltype(q.x);
            return function(Plane::lift<T>(p.position) + q.x * Plane::lift<T>(f.dp_dx) +
                            q.y * Plane::lift<T>(f.dp_dy));
          },
          vec2d{0, 0});
    };
    const vec2d ds = along(s);
    const vec2d dt = along(t);
    worst.add(d.dst_dx, vec2d{ds.x, dt.x}, 1e-14, i); // three products of order 0.1
    worst.add(d.dst_dy, vec2d{ds.y, dt.y}, 1e-14, i);
  }
}

TEST(Screen, LodIsTheLogarithmOfTheLongerAxis) { // section 3
  Random random(1705);
  Worst worst("texture_lod");
  for (long i = 0; i < 3000; ++i) {
    const double scale = random.magnitude(1e-12, 1e12);
    const vec2d x = scale * random.vector2();
    const vec2d y = scale * random.magnitude(1e-3, 1e3) * random.vector2();
    const vec2d size{512, 256};
    const double truth =
        std::log2(std::max(std::hypot(size.x * x.x, size.y * x.y), std::hypot(size.x * y.x, size.y * y.y)));
    worst.add(texture_lod(x, y, size), truth, 4 * epsilon_v<double> * std::max(1.0, std::abs(truth)), i);
  }
  EXPECT_EQ(texture_lod(vec2d{1.0 / 512, 0}, vec2d{0, 1.0 / 512}, vec2d{512, 512}), 0);
  EXPECT_NEAR(texture_lod(vec2d{4.0 / 512, 0}, vec2d{0, 1.0 / 512}, vec2d{512, 512}), 2, 1e-15);
}

} // namespace
} // namespace surfgrad::test
