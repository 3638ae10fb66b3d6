/// Normals and gradients through object transforms: Golubev, equations 13 to 29, 33, 36 and 37.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/derivative.hpp>
#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::test {
namespace {

// A few dozen roundings of double, 1e-16 each, on input with condition numbers up to ten.
constexpr double exact = 1e-13;

/// Well away from singular; about half of them mirror.
mat3d random_transform(Random& random) {
  for (;;) {
    const mat3d m = random.matrix3(-2, 2);
    if (std::abs(determinant(m)) > 0.5) return m;
  }
}

mat3d diagonal(vec3d s) { return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}; }

vec3d random_scale(Random& random) { // non-uniform, of any sign
  return {random.sign() * random.uniform(0.4, 3), random.sign() * random.uniform(0.4, 3),
          random.sign() * random.uniform(0.4, 3)};
}

TEST(Transform, CofactorIsTheScaledInverseTranspose) { // Golubev, equation 20
  Random random(201);
  Worst worst("cof(M) * transpose(M) = det(M), cross(M a, M b) = cof(M) cross(a, b)");
  for (long i = 0; i < 500; ++i) {
    const mat3d m = random_transform(random);
    const mat3d product = cofactor(m) * transpose(m);
    const double det = determinant(m);
    worst.add(product.x, vec3d{det, 0, 0}, 10 * exact, i);
    worst.add(product.y, vec3d{0, det, 0}, 10 * exact, i);
    worst.add(product.z, vec3d{0, 0, det}, 10 * exact, i);
    const vec3d a = random.vector3();
    const vec3d b = random.vector3();
    worst.add(cross(m * a, m * b), cofactor(m) * cross(a, b), 10 * exact, i);
  }
}

TEST(Transform, NormalStaysPerpendicularAndOutward) { // equations 25, 36 with the sign of det
  Random random(202);
  Worst worst("transform_normal: perpendicular to the moved tangents");
  int mirrored = 0;
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const mat3d m = random_transform(random);
    mirrored += determinant(m) < 0;
    const vec3d n = transform_normal(m, p.normal);
    worst.add(dot(n, m * p.dp_du), 0, 10 * exact, i);
    worst.add(dot(n, m * p.dp_dv), 0, 10 * exact, i);
    // The point just outside moves to M (p + e n), which must lie on the side of the new normal.
    EXPECT_GT(dot(m * p.normal, n), 0) << "case " << i;
    // The inverse transpose: cof(M) / det(M), a positive multiple of which the result must be.
    worst.add(n, std::abs(determinant(m)) * ((1 / determinant(m)) * (cofactor(m) * p.normal)), 10 * exact, i);
  }
  EXPECT_GT(mirrored, 100);
}

TEST(Transform, PerturbedNormalIsThatOfTheScaledGeometry) { // equations 16 to 25 and 33
  Random random(203);
  Worst worst("transform_normal(M, N - G) against the cross product of the moved tangents");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 400; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const vec2d dh = random.vector2();
      const mat3d m = random_transform(random);
      const vec3d t = m * (p.dp_du + dh.x * p.normal); // equation 17, h dN/du neglected
      const vec3d b = m * (p.dp_dv + dh.y * p.normal);
      // Outward: M maps what is outside the surface to what is outside its image.
      vec3d expected = normalize_or_zero(cross(t, b));
      if (dot(expected, m * p.normal) < 0) expected = -expected;
      const vec3d g = from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, dh);
      worst.add(normalize_or_zero(transform_normal(m, p.normal - g)), expected, 10 * exact, i);
    }
  });
}

TEST(Transform, GradientMovesThroughThePerturbedNormal) {
  Random random(204);
  Worst worst("from_perturbed_normal(n_world, transform_normal(M, N - G))");
  double naive = 0;
  for (long i = 0; i < 1000; ++i) {
    const SurfacePoint p = random_point(Sphere{}, random);
    const vec3d g = from_parametric_derivative(p.normal, p.dp_du, p.dp_dv, 0.3 * random.vector2());
    const mat3d m = random_transform(random);
    const vec3d n_world = normalize_or_zero(transform_normal(m, p.normal));
    const vec3d moved = transform_normal(m, p.normal - g);
    const double along = dot(n_world, normalize_or_zero(moved));
    if (along < 0.05) continue; // past the tangent plane no gradient leads there
    const vec3d g_world = from_perturbed_normal(n_world, moved);
    worst.add(dot(g_world, n_world), 0, 10 * exact / along, i);
    worst.add(resolve_normal(make_frame(n_world), g_world), normalize_or_zero(moved), 10 * exact / along, i);
    naive = std::max(naive, std::abs(dot(normalize_or_zero(transform_normal(m, g)), n_world)));
  }
  // A gradient alone leaves the tangent plane, which is why it must not be transformed.
  EXPECT_GT(naive, 0.3);
}

TEST(Transform, TangentNormalMatrixEqualsTheGradientRoute) { // equations 13 to 15, 28 and 29
  Random random(205);
  Worst worst("equations 28 and 29: M_world * M_tile * N_t / n_t.z");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 400; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const vec3d n = random.sign() * p.normal; // either side of cross(dp_du, dp_dv)
      const mat3d rotation = random.rotation();
      const vec3d scale = random_scale(random);
      const mat3d world = tangent_normal_matrix(rotation, scale, p.dp_du, p.dp_dv, n);
      const vec2d tile = random.vector2(0.5, 3);
      const vec2d slope = random.vector2();
      const vec3d tangent_normal = normal_from_derivative(slope);
      const vec3d implicit = (1 / tangent_normal.z) *
                             vec3d{tile.x * tangent_normal.x, tile.y * tangent_normal.y, tangent_normal.z};
      const vec3d by_matrix = normalize_or_zero(world * implicit);
      const vec3d g = from_parametric_derivative(n, p.dp_du, p.dp_dv, tile * slope);
      const vec3d by_gradient = transform_normal(rotation * diagonal(scale), n - g);
      worst.add(by_matrix, normalize_or_zero(by_gradient), 10 * exact, i);
      const mat3d general = tangent_normal_matrix(rotation, diagonal(scale), p.dp_du, p.dp_dv, n);
      worst.add(general * implicit, world * implicit, 0, i);
    }
  });
}

TEST(Transform, TangentNormalMatrixEqualsTheScaledGeometry) {
  Random random(206);
  Worst worst("equation 29 against displaced, scaled and rotated tangents");
  for (long i = 0; i < 600; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const mat3d rotation = random.rotation();
    const vec3d scale = random_scale(random);
    const vec2d dh = random.vector2();
    const mat3d m = rotation * diagonal(scale);
    vec3d expected =
        normalize_or_zero(cross(m * (p.dp_du + dh.x * p.normal), m * (p.dp_dv + dh.y * p.normal)));
    if (dot(expected, m * p.normal) < 0) expected = -expected;
    const mat3d world = tangent_normal_matrix(rotation, scale, p.dp_du, p.dp_dv, p.normal);
    worst.add(normalize_or_zero(world * vec3d{-dh.x, -dh.y, 1}), expected, 10 * exact, i);
  }
}

TEST(Transform, TransposeBringsTheNormalBackToTangentSpace) { // equations 26 and 27
  Random random(207);
  Worst worst("equation 27: transpose(M_tangent) N_o against G, up to its length");
  const mat3d identity{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const vec2d slope = random.vector2();
    const vec3d implicit{-slope.x, -slope.y, 1};
    const mat3d m = tangent_normal_matrix(identity, identity, p.dp_du, p.dp_dv, p.normal);
    const double size = length(m * implicit);
    const vec3d object_normal = normalize_or_zero(m * implicit);
    const vec3d back{dot(p.dp_du, object_normal), dot(p.dp_dv, object_normal), dot(p.normal, object_normal)};
    worst.add(size * back, implicit, 10 * exact, i);
  }
}

TEST(Transform, CollapsedParametersCarryTheNormalOnly) {
  const mat3d identity{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const mat3d m =
      tangent_normal_matrix(identity, vec3d{2, 1, 1}, vec3d{1, 0, 0}, vec3d{-2, 0, 0}, vec3d{0, 0, 1});
  EXPECT_EQ(max_abs(m * vec3d{1, 1, 0}), 0);
  EXPECT_EQ((m * vec3d{0.3, -0.2, 1}).z, 2);
}

} // namespace
} // namespace surfgrad::test
