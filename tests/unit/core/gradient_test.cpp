/// Listings 2, 5, 7, 8 and 12 against their definitions, in double on analytic surfaces.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/derivative.hpp>
#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::test {
namespace {

// A few dozen roundings of double, 1e-16 each, on input with condition numbers up to ten.
constexpr double exact = 1e-13;

TEST(Gradient, TbnResolveEqualsTraditionalTransform) { // equation 6
  Random random(601);
  Worst worst("equation 6: resolve of from_tbn against normalize(t mx + b my + n mz)");
  for (long i = 0; i < 2000; ++i) {
    const vec3d n = random.unit_vector();
    const vec3d t = random.vector3(); // neither unit nor perpendicular: equation 6 asks for neither
    const vec3d b = random.vector3();
    const vec3d m{random.uniform(), random.uniform(), random.uniform(0.1, 1)};
    const vec3d expected = normalize_or_zero(m.x * t + m.y * b + m.z * n);
    const vec3d g = from_tbn(derivative_from_normal(m), t, b);
    worst.add(resolve_normal(make_frame(n), g), expected, exact, i);
  }
}

TEST(Gradient, MikktspaceResolveEqualsTransformOfRawVectors) { // section 2.2
  Random random(602);
  Worst worst("section 2.2: unnormalised interpolants");
  for (long i = 0; i < 2000; ++i) {
    const vec3d n = random.uniform(0.3, 3) * random.unit_vector();
    const vec3d t = random.vector3();
    const double sign = random.sign() * random.uniform(0.5, 1);
    const vec3d m{random.uniform(), random.uniform(), random.uniform(0.1, 1)};
    const vec3d b = (sign > 0 ? 1.0 : -1.0) * cross(n, t);
    const vec3d expected = normalize_or_zero(m.x * t + m.y * b + m.z * n);
    const TangentFrame<double> basis = mikktspace_basis(n, t, sign);
    const vec3d g = from_tbn(derivative_from_normal(m), basis.tangent, basis.bitangent);
    worst.add(resolve_normal(make_frame(n), g), expected, exact, i);
  }
}

TEST(Gradient, PerturbedNormalComesBack) { // listing 7, dot > 0
  Random random(603);
  Worst worst("listing 7: resolve(from_perturbed_normal(n, v)) against v");
  for (long i = 0; i < 2000; ++i) {
    const vec3d n = random.unit_vector();
    const vec3d v = random.unit_vector();
    const double along = dot(n, v);
    if (along < 0.05) continue;
    const vec3d g = from_perturbed_normal(n, random.magnitude(1e-12, 1e12) * v);
    worst.add(resolve_normal(make_frame(n), g), v, exact / along, i);
    worst.add(dot(g, n), 0, exact / along, i);
  }
}

TEST(Gradient, PerturbedNormalBelowThePlanePerturbsTowardsIt) { // listing 7, dot < 0
  Random random(604);
  Worst worst("listing 7 below the tangent plane");
  for (long i = 0; i < 2000; ++i) {
    const vec3d n = random.unit_vector();
    const vec3d v = random.unit_vector();
    const double along = dot(n, v);
    if (along > -0.05) continue;
    // The mirror image above the plane: same tangential part, so "towards v"; the opposite of the
    // sign of Golubev's equation 38.
    const vec3d mirrored = v - (2 * along) * n;
    const vec3d g = from_perturbed_normal(n, v);
    worst.add(resolve_normal(make_frame(n), g), mirrored, exact / -along, i);
    const vec3d golubev = n - (1 / along) * v;
    worst.add(g, -golubev, exact / -along, i);
  }
}

TEST(Gradient, ParametricGradientIsTheGradient) { // listing 8, equation 3 of the 2010 paper
  Random random(605);
  Worst worst("listing 8: dot(g, dp/du) = dh/du, dot(g, n) = 0");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 500; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const UvMap st = random_uv_map(random);
      const auto height = [&](auto uv) { return wavy(st(uv)); };
      const vec2d dh = gradient_of(height, p.uv);
      // The normal may lie on either side of cross(dp_du, dp_dv).
      const vec3d n = random.sign() * p.normal;
      const vec3d g = from_parametric_derivative(n, p.dp_du, p.dp_dv, dh);
      worst.add(dot(g, p.dp_du), dh.x, exact, i);
      worst.add(dot(g, p.dp_dv), dh.y, exact, i);
      worst.add(dot(g, n), 0, exact, i);
    }
  });
}

TEST(Gradient, TexelAndScreenDerivativesGiveTheGradient) { // listing 8 as printed
  Random random(606);
  Worst worst("listing 8 by texels and by pixels");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 500; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const UvMap st = random_uv_map(random);
      const Fragment f = random_camera(p, random).fragment(p);
      const auto height = [&](auto uv) { return wavy(st(uv)); };
      const vec2d dh_duv = gradient_of(height, p.uv);
      const vec2d size{512, 256};
      const vec2d dh_dst = gradient_of([](auto q) { return wavy(q); }, st(p.uv));
      const vec2d dh_dtexel{dh_dst.x / size.x, dh_dst.y / size.y};
      const Frame<double> frame = frame_at(p, f);
      const vec3d by_texel =
          from_texel_derivative(frame, dh_dtexel, size, st.linear(f.duv_dx), st.linear(f.duv_dy));
      const vec3d by_pixel =
          from_height_derivative(frame, vec2d{dot(dh_duv, f.duv_dx), dot(dh_duv, f.duv_dy)});
      for (const vec3d g : {by_texel, by_pixel}) {
        worst.add(dot(g, p.dp_du), dh_duv.x, 10 * exact, i);
        worst.add(dot(g, p.dp_dv), dh_duv.y, 10 * exact, i);
        worst.add(dot(g, p.normal), 0, 10 * exact, i);
      }
    }
  });
}

TEST(Gradient, IsTheSumOfTheCoordinatesGradients) { // Gustavson, equation 2, in its exact form
  Random random(610);
  Worst worst("h_s grad_S(s) + h_t grad_S(t)");
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const UvMap st = random_uv_map(random);
    const vec3d grad_s = gradient_of([&](auto q) { return st(Torus{}.parameters(q)).x; }, p.position);
    const vec3d grad_t = gradient_of([&](auto q) { return st(Torus{}.parameters(q)).y; }, p.position);
    const vec2d slope = random.vector2();
    const vec3d sum =
        slope.x * from_volume_gradient(p.normal, grad_s) + slope.y * from_volume_gradient(p.normal, grad_t);
    const auto [dp_ds, dp_dt] = st.tangents(p);
    worst.add(sum, from_parametric_derivative(p.normal, dp_ds, dp_dt, slope), 10 * exact, i);
  }
}

TEST(Gradient, TilingMultipliesPhysicalSlopes) { // section 2.5, Golubev 13 to 15
  Random random(607);
  Worst worst("tiling (a, b) multiplies the slopes");
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const UvMap tiling{{random.uniform(0.5, 4), 0}, {0, random.uniform(0.5, 4)}};
    const vec2d slope = random.vector2();
    const vec3d tiled = from_parametric_derivative(p.normal, p.dp_du, p.dp_dv,
                                                   vec2d{tiling.s.x * slope.x, tiling.t.y * slope.y});
    const auto [dp_ds, dp_dt] = tiling.tangents(p);
    worst.add(tiled, from_parametric_derivative(p.normal, dp_ds, dp_dt, slope), exact, i);
  }
}

TEST(Gradient, VolumeGradientLosesItsNormalPartOnly) { // listing 12, Golubev 30 and 32
  Random random(608);
  Worst worst("listing 12: derivatives along the surface");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 500; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const vec3d gradient = gradient_of([](auto q) { return wavy(q); }, p.position);
      const vec3d g = from_volume_gradient(p.normal, gradient);
      const vec2d along = gradient_of([&](auto uv) { return wavy(surface.position(uv.x, uv.y)); }, p.uv);
      worst.add(dot(g, p.dp_du), along.x, exact, i);
      worst.add(dot(g, p.dp_dv), along.y, exact, i);
      worst.add(dot(g, p.normal), 0, exact, i);
    }
  });
}

TEST(Gradient, ScalingTheBumpScalesTheHeight) { // listings 2 and 3, Golubev 34
  Random random(609);
  Worst worst("scale_bump of gradient and of derivative");
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(Sphere{}, random);
    const double scale = random.uniform(-3, 3);
    const vec2d dh = gradient_of([](auto uv) { return wavy(uv); }, p.uv);
    const vec2d scaled = gradient_of([&](auto uv) { return decltype(uv.x)(scale) * wavy(uv); }, p.uv);
    const vec3d expected = from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, scaled);
    worst.add(scale_bump(scale, from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, dh)), expected, exact,
              i);
    worst.add(from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, scale_bump(scale, dh)), expected, exact,
              i);
  }
}

} // namespace
} // namespace surfgrad::test
