// Where a parallax layer moves a point: onto the displaced surface, on the view ray, nothing before it.

#include "relief.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Plane;
using surfgrad::test::Sphere;
using surfgrad::test::Worst;
using test::Moved;
using test::moved;
using test::Sight;

struct ParallaxPosition : ::testing::Test {
  static constexpr std::uint64_t seed = 171;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};
  Plane plane{};

  void SetUp() override {
    lab.add("heights", surfgrad::test::random_image(random, 32, 16, 1));
    lab.add("flat", surfgrad::test::constant_image(4, 4, {0, 0, 0}));
    lab.add("half", surfgrad::test::constant_image(4, 4, {0.5, 0.5, 0.5}));
    lab.add("ramp", test::ramp_image());
  }

  /// Position in the plane's axes: two along it, then above it.
  [[nodiscard]] vec3<double> in_plane(const Sight& sight, vec3<double> relative) const {
    return plane.axes * (relative + sight.camera.eye - plane.origin);
  }

  /// Whether the point lies on the surface that rises from the front by `sign` * displacement, on the
  /// view ray, under its texture coordinate, with nothing of the surface between it and the viewer.
  void expect_first_met(const Program& program, const Sight& sight, BackFaces mode, double sign, long where,
                        Worst& on_surface, Worst& on_ray, Worst& under) const {
    const raster::Fragment<double> f = sight.fragment();
    const Moved m = moved(program, f, sight.placement(), mode);
    const Parallax& layer = test::parallax_of(program);
    const auto above = [&](vec3<double> q) {
      const double h = test::height_at(program, sight.map(vec2<double>{q.x, q.y}), f);
      return q.z - sign * (h - layer.level) * std::abs(layer.relief.height);
    };
    const vec3<double> q = in_plane(sight, m.fragment.position);
    const double way = length(m.fragment.position - f.position);
    // Rounding of a search over at most some 1e4 texels; a texel is 1/32.
    const double rounding = 1e-10 * (1 + way);
    // Seen from below, heights are depths, which round once more in single precision.
    const double stored = std::numeric_limits<float>::epsilon() * std::abs(layer.relief.height);
    on_surface.add(above(q), 0, rounding + stored, where);
    on_ray.add(cross(m.fragment.position, f.to_viewer), {0, 0, 0}, rounding, where);
    under.add(m.fragment.uvs[0].st, sight.map(vec2<double>{q.x, q.y}), rounding, where);
    under.add(m.fragment.uvs[1].st, sight.other(vec2<double>{q.x, q.y}), rounding, where);
    under.add(m.fragment.object_position - f.object_position, m.fragment.position - f.position, rounding,
              where);
    // Towards the viewer until the relief ends.
    const double side = dot(f.to_viewer, plane.axes.z) < 0 ? -1 : 1;
    const double rate = side * dot(f.to_viewer, plane.axes.z);
    const double top = (side * sign > 0 ? 1 - layer.level : layer.level) * std::abs(layer.relief.height);
    for (int k = 1; k <= 100; ++k) {
      const double t = (top - side * q.z) / rate * k / 100;
      const vec3<double> before = in_plane(sight, m.fragment.position + t * f.to_viewer);
      EXPECT_GE(side * above(before), -rounding - stored) << "hidden by relief before it, case " << where;
    }
  }
};

TEST_F(ParallaxPosition, LiesOnTheReliefWhereTheViewRayFirstMeetsItAtEveryAngle) {
  Worst on_surface("height over the relief"), on_ray("distance from the view ray"), under("coordinates");
  long where = 0;
  for (const double degrees : {0.0, 20.0, 45.0, 60.0, 75.0, 85.0, 88.0, 89.5, 89.9})
    for (const stack::Filter filter : {stack::Filter::bilinear, stack::Filter::trilinear})
      for (const double level : {0.0, 1.0, 0.4})
        for (int k = 0; k < 10; ++k) {
          stack::ParallaxLayer layer = test::parallax_layer("heights", random.uniform(0.02, 0.3));
          layer.map.filter = filter;
          layer.map.tile = {random.uniform(0.3, 2), -random.uniform(0.3, 2)};
          layer.map.rotate_deg = random.uniform(0, 360);
          layer.map.offset = random.vector2(-1, 1);
          layer.level = level;
          const Sight sight(evaluate(plane, random.vector2(-2, 2)), degrees, random);
          expect_first_met(lab.compile({layer}), sight, BackFaces::same, 1, where++, on_surface, on_ray,
                           under);
        }
}

TEST_F(ParallaxPosition, LiesOnTheReliefFromEitherSideInEveryMode) {
  Worst on_surface("height over the relief"), on_ray("distance from the view ray"), under("coordinates");
  long where = 0;
  for (const double degrees : {10.0, 50.0, 80.0, 89.0, 91.0, 100.0, 130.0, 170.0})
    for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip})
      for (const double scale : {1.0, -1.0})
        for (int k = 0; k < 10; ++k) {
          stack::ParallaxLayer layer = test::parallax_layer("heights", random.uniform(0.02, 0.3));
          layer.level = random.uniform(0, 1);
          layer.common.scale = scale;
          const Sight sight(evaluate(plane, random.vector2(-2, 2)), degrees, random);
          // Mirrored, what is seen from behind rises there too.
          const double sign = mode == BackFaces::mirror && degrees > 90 ? -scale : scale;
          expect_first_met(lab.compile({layer}), sight, mode, sign, where++, on_surface, on_ray, under);
        }
}

TEST_F(ParallaxPosition, OneStepGoesByTheHeightUnderTheFragment) {
  Worst way("way of one step"), height("height at its end");
  for (long k = 0; k < 200; ++k) {
    stack::ParallaxLayer layer = test::parallax_layer("heights", 0.1);
    layer.method = stack::ParallaxMethod::offset;
    layer.map.filter = stack::Filter::bilinear;
    layer.limit_offset = k % 2 == 0;
    layer.level = random.uniform(0, 1);
    const Program program = lab.compile({layer});
    const Sight sight(evaluate(plane, random.vector2(-2, 2)), random.uniform(0, 180), random);
    const raster::Fragment<double> f = sight.fragment();
    const vec3<double> q = in_plane(sight, moved(program, f, sight.placement()).fragment.position);
    const vec3<double> v = plane.axes * f.to_viewer;
    const double stretch = layer.limit_offset ? (v.z < 0 ? -1 : 1) : 1 / v.z;
    const double rise = (test::height_at(program, f.uvs[0].st, f) - layer.level) * layer.height;
    way.add(q - vec3<double>{sight.base.uv.x, sight.base.uv.y, q.z},
            vec3<double>{rise * stretch * v.x, rise * stretch * v.y, 0}, 1e-11 * (1 + std::abs(stretch)), k);
    const double end = test::height_at(program, sight.map(vec2<double>{q.x, q.y}), f);
    height.add(q.z, (end - layer.level) * layer.height, 1e-10 * (1 + std::abs(stretch)), k);
  }
}

TEST_F(ParallaxPosition, HeightsOfZeroChangeNothing) {
  Worst same("what zero heights change");
  for (const double degrees : {5.0, 70.0, 89.0, 120.0})
    for (const bool masked : {false, true})
      for (long k = 0; k < 20; ++k) {
        // Either no height, or no weight.
        stack::ParallaxLayer layer = test::parallax_layer(masked ? "heights" : "flat", 0.2);
        if (masked) layer.common.mask = test::mask_of("flat");
        layer.self_shadow = true;
        const Sight sight(evaluate(plane, random.vector2(-2, 2)), degrees, random);
        const raster::Fragment<double> f = sight.fragment();
        const Moved m = moved(lab.compile({layer}), f,
                              sight.placement(normalize_or_zero(plane.axes.z + 0.5 * random.vector3())));
        same.add(m.fragment.position, f.position, 1e-15, k);
        same.add(m.frame.normal, f.normal, 1e-15, k);
        for (std::size_t s = 0; s < 2; ++s) {
          const raster::UvFragment<double>& uv = f.uvs[s];
          same.add(m.fragment.uvs[s].st, uv.st, 1e-15, k);
          const double rounding = 1e-11 * (max_abs(uv.dst_dx) + max_abs(uv.dst_dy));
          same.add(m.fragment.uvs[s].dst_dx, uv.dst_dx, rounding, k);
          same.add(m.fragment.uvs[s].dst_dy, uv.dst_dy, rounding, k);
        }
        same.add(m.fragment.dp_dx, f.dp_dx, 1e-11 * max_abs(f.dp_dx), k);
        same.add(m.fragment.dp_dy, f.dp_dy, 1e-11 * max_abs(f.dp_dy), k);
        EXPECT_EQ(m.sunlight, 1);
        EXPECT_FALSE(m.degenerate);
      }
}

TEST_F(ParallaxPosition, TheMaskWeighsTheDisplacement) {
  stack::ParallaxLayer layer = test::parallax_layer("heights", 0.2);
  layer.level = 0.3;
  stack::ParallaxLayer half = layer;
  half.height = 0.2 * 0.5 * 0.5;
  layer.common.opacity = 0.5;
  layer.common.mask = test::mask_of("half");
  const Sight sight(evaluate(plane, {0.3, 0.2}), 60, random);
  const Moved weighed = moved(lab.compile({layer}), sight.fragment(), sight.placement());
  const Moved lower = moved(lab.compile({half}), sight.fragment(), sight.placement());
  EXPECT_LT(max_abs(weighed.fragment.position - lower.fragment.position), 1e-14);
  EXPECT_LT(max_abs(weighed.frame.normal - lower.frame.normal), 1e-14);
}

TEST_F(ParallaxPosition, CarvesFromLevelOneAndRisesFromLevelZero) {
  for (const double level : {0.0, 1.0}) {
    stack::ParallaxLayer layer = test::parallax_layer("heights", 0.2);
    layer.level = level;
    double lowest = 1, highest = -1;
    for (int k = 0; k < 200; ++k) {
      const Sight sight(evaluate(plane, random.vector2(-2, 2)), 50, random);
      const double z =
          in_plane(sight, moved(lab.compile({layer}), sight.fragment(), sight.placement()).fragment.position)
              .z;
      lowest = std::min(lowest, z);
      highest = std::max(highest, z);
    }
    EXPECT_GE(lowest, -0.2 * level - 1e-12);
    EXPECT_LE(highest, 0.2 * (1 - level) + 1e-12);
    EXPECT_GT(highest - lowest, 0.1);
  }
}

/// Distance of the moved point from a sphere of constant relief, and the angle between the base normal
/// there and the true one, by the sphere's radius.
TEST_F(ParallaxPosition, OnACurvedBaseTheErrorFallsWithTheRadiusAndTheCurvatureTermTurnsTheNormal) {
  double last_distance = 0;
  for (const double radius : {1.0, 2.0, 4.0, 8.0, 16.0}) {
    const Sphere sphere{radius};
    test::Random same(172); // the same views of every sphere
    double distance = 0, flat_angle = 0, turned_angle = 0;
    for (int k = 0; k < 200; ++k) {
      stack::ParallaxLayer layer = test::parallax_layer("half", 0.2);
      const Sight sight(random_point(sphere, same), 60, same);
      const auto run = [&](bool curvature) {
        layer.curvature = curvature;
        return moved(lab.compile({layer}), sight.fragment(), sight.placement());
      };
      const Moved turned = run(true);
      const vec3<double> q = turned.fragment.position + sight.camera.eye;
      const vec3<double> outwards = normalize_or_zero(q);
      distance = std::max(distance, std::abs(length(q) - (radius + 0.1)));
      flat_angle = std::max(flat_angle, length(run(false).frame.normal - outwards));
      turned_angle = std::max(turned_angle, length(turned.frame.normal - outwards));
    }
    std::printf(
        "  radius %4g, height 0.1 at 60 degrees: off the surface by %.2e, normal off by %.3f degrees, "
        "%.4f with the curvature term\n",
        radius, distance, flat_angle * 180 / std::numbers::pi, turned_angle * 180 / std::numbers::pi);
    // The tangent plane leaves a sphere by way^2 / (2 radius), to first order.
    const double way = 0.1 * std::tan(std::numbers::pi / 3);
    EXPECT_LT(distance, 1.1 * way * way / (2 * radius));
    if (radius > 1) {
      EXPECT_NEAR(last_distance / distance, 2, 0.2);
    }
    last_distance = distance;
    // Without the term way / (radius + height). With it: the next order, of which the height's neglect is
    // the largest part.
    EXPECT_GT(flat_angle, 0.95 * way / (radius + 0.1));
    EXPECT_LT(turned_angle, 0.12 / radius * flat_angle);
  }
}

TEST_F(ParallaxPosition, NothingMovesBehindTheHorizonOfTheNormal) {
  // An interpolated normal may face away where the triangle does not.
  for (const stack::ParallaxMethod method :
       {stack::ParallaxMethod::offset, stack::ParallaxMethod::occlusion}) {
    stack::ParallaxLayer layer = test::parallax_layer("heights", 0.2);
    layer.method = method;
    const Sight sight(evaluate(plane, {0.1, 0.2}), 88, random);
    raster::Fragment<double> f = sight.fragment();
    f.normal = normalize_or_zero(f.normal - 0.2 * f.to_viewer);
    ASSERT_LT(dot(f.normal, f.to_viewer), 0);
    const Moved m = moved(lab.compile({layer}), f, sight.placement());
    EXPECT_EQ(max_abs(m.fragment.position - f.position), 0);
    EXPECT_EQ(max_abs(m.fragment.uvs[0].st - f.uvs[0].st), 0);
    EXPECT_NEAR(length(m.frame.normal), 1, 1e-12);
  }
}

} // namespace
} // namespace surfgrad::engine
