/// Listings 10 and 11 and the curvature term of section 2.6, against the tangent plane's geometry.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/parallax.hpp>

namespace surfgrad::test {
namespace {

// A few dozen roundings of double, 1e-16 each, on input with condition numbers up to ten, divided by
// the ray's slope where the ray is involved.
constexpr double exact = 1e-13;

struct Case {
  SurfacePoint point;
  UvMap st;
  Fragment fragment;
  Frame<double> frame;
  vec3d direction; ///< unit
  double along;    ///< dot(normal, direction)
  double bump_scale;
  vec2d dst_dx, dst_dy;
};

template <class Surface>
Case random_case(const Surface& surface, Random& random) {
  Case c;
  c.point = random_point(surface, random);
  c.st = random_uv_map(random);
  c.fragment = random_camera(c.point, random).fragment(c.point);
  c.frame = frame_at(c.point, c.fragment);
  do {
    c.direction = random.unit_vector();
    c.along = dot(c.direction, c.point.normal);
  } while (std::abs(c.along) < 0.05);
  c.bump_scale = random.uniform(0.05, 2);
  c.dst_dx = c.st.linear(c.fragment.duv_dx);
  c.dst_dy = c.st.linear(c.fragment.duv_dy);
  return c;
}

/// Change of (s, t) when the point moves by a vector of the tangent plane.
vec2d texture_change(const Case& c, vec3d tangential) {
  return c.st.linear(Pinhole::parameters_of(c.point, tangential));
}

TEST(Parallax, ProjectedVectorFollowsTheRayThroughTheHeightRange) { // listing 10
  Random random(1001);
  Worst worst("listing 10: texture step while the ray climbs by bump_scale");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 500; ++i) {
      const Case c = random_case(surface, random);
      // Height 1 is a displacement of bump_scale along the normal; the ray reaches that level after
      // bump_scale / |along|. The signed dot product, as printed: below the plane height falls.
      const double distance = c.bump_scale / c.along;
      const vec3d tangential = distance * (c.direction - c.along * c.point.normal);
      const vec2d got = project_to_texture_space(c.frame, c.direction, c.dst_dx, c.dst_dy, c.bump_scale);
      worst.add(got, texture_change(c, tangential), 10 * exact / std::abs(c.along), i);
    }
  });
}

TEST(Parallax, SkippedProjectionLimitsTheOffset) { // listing 10, skipProj
  Random random(1002);
  Worst worst("listing 10 with skipProj: offset limiting");
  for (long i = 0; i < 500; ++i) {
    const Case c = random_case(Torus{}, random);
    const vec2d got = project_to_texture_space(c.frame, c.direction, c.dst_dx, c.dst_dy, c.bump_scale, true);
    const vec3d tangential = c.bump_scale * (c.direction - c.along * c.point.normal);
    worst.add(got, texture_change(c, tangential), 10 * exact, i);
  }
}

TEST(Parallax, OffsetSurfaceMeetsTheRay) { // listings 10 and 11 together
  Random random(1101);
  Worst worst("p + surface_offset + height * bump_scale * n against the point on the ray");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 500; ++i) {
      const Case c = random_case(surface, random);
      const double height = random.uniform(0, 1);
      const vec2d whole = project_to_texture_space(c.frame, c.direction, c.dst_dx, c.dst_dy, c.bump_scale);
      const vec3d offset = surface_offset(c.frame, c.dst_dx, c.dst_dy, height * whole);
      const vec3d displaced = c.point.position + offset + (height * c.bump_scale) * c.point.normal;
      const vec3d on_ray = c.point.position + (height * c.bump_scale / c.along) * c.direction;
      worst.add(displaced, on_ray, 100 * exact / std::abs(c.along), i);
    }
  });
}

TEST(Parallax, SurfaceOffsetInvertsTheTextureChange) { // listing 11
  Random random(1102);
  Worst worst("surface_offset and screen_offset, round trip through texture space");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 500; ++i) {
      const Case c = random_case(surface, random);
      const vec2d offset = random.vector2();
      const vec3d moved = surface_offset(c.frame, c.dst_dx, c.dst_dy, offset);
      worst.add(dot(moved, c.point.normal), 0, 10 * exact, i);
      worst.add(texture_change(c, moved), offset, 10 * exact, i);
      const vec2d v = screen_offset(c.dst_dx, c.dst_dy, offset);
      worst.add(v.x * c.dst_dx + v.y * c.dst_dy, offset, 10 * exact, i);
    }
  });
}

TEST(Parallax, OffsetNormalFollowsTheCurvature) { // section 2.6
  // The corrected normal errs with the square of the offset, the uncorrected one linearly.
  Random random(1103);
  double smallest = 100;
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    const Case c = random_case(Sphere{}, random);
    const auto by_screen = [&](vec2d duv) { return duv.x * c.point.dn_du + duv.y * c.point.dn_dv; };
    const vec3d dn_dx = by_screen(c.fragment.duv_dx);
    const vec3d dn_dy = by_screen(c.fragment.duv_dy);
    const vec2d direction = random.vector2();
    const auto error = [&](double step) {
      const vec2d offset = step * direction;
      const vec2d v = screen_offset(c.dst_dx, c.dst_dy, offset);
      const vec2d duv = c.st.inverse().linear(offset);
      const vec3d truth = evaluate(Sphere{}, c.point.uv + duv).normal;
      return length(offset_normal(c.frame, dn_dx, dn_dy, v) - truth);
    };
    const double coarse = error(2e-4);
    if (coarse < 1e-9) continue; // a step so short that rounding shows
    const double ratio = coarse / error(1e-4);
    smallest = std::min(smallest, ratio);
    largest = std::max(largest, ratio);
  }
  std::printf("  error ratio when the offset halves: %.3f to %.3f\n", smallest, largest);
  EXPECT_GT(smallest, 3.5);
  EXPECT_LT(largest, 4.5);
}

} // namespace
} // namespace surfgrad::test
