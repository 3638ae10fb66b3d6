// What a parallax layer leaves for the layers after it: frame, footprints, sunlight.

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

struct ParallaxFrame : ::testing::Test {
  static constexpr std::uint64_t seed = 173;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};
  Plane plane{};

  void SetUp() override {
    // A float file: of these the relief and the height map hold the very same numbers.
    lab.add("heights", surfgrad::test::random_image(random, 32, 16, 1, image::Depth::float32));
    lab.add("ramp", test::ramp_image());
    lab.add("normals", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
    lab.add("tilted", surfgrad::test::constant_image(1, 1, {0.7, 0.35, 0.9}));
  }

  /// A view of the middle of the ramp, which is a tilted plane there.
  [[nodiscard]] Sight on_the_ramp(double degrees) {
    Sight sight(evaluate(plane, random.vector2(-2, 2)), degrees, random);
    sight.map.offset = sight.map.offset + vec2<double>{0.5, 0.5} - sight.map(sight.base.uv);
    return sight;
  }
  static stack::ParallaxLayer ramp_layer(double height) {
    stack::ParallaxLayer layer = test::parallax_layer("ramp", height);
    layer.map.wrap = stack::Wrap::clamp;
    return layer;
  }
  /// Upwards where its heights rise along the front's normal, else with `sign` -1.
  [[nodiscard]] vec3<double> normal_of_ramp(const Sight& sight, double height, double sign) const {
    const vec3<double> slope = sight.map.s.x * plane.axes.x + sight.map.s.y * plane.axes.y;
    return normalize_or_zero(plane.axes.z - (sign * height) * slope);
  }
};

TEST_F(ParallaxFrame, IsTheTruePlaneOfTheReliefFromEitherSideInEveryMode) {
  Worst normal("normal"), dp("change of the position"), dst("change of the coordinates");
  long where = 0;
  for (const double degrees : {5.0, 30.0, 60.0, 120.0, 160.0})
    for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip})
      for (const bool occlusion : {true, false})
        for (const bool displaced : {true, false})
          for (int k = 0; k < 10; ++k) {
            const bool behind = degrees > 90;
            const Sight sight = on_the_ramp(degrees);
            stack::ParallaxLayer layer = ramp_layer(0.03);
            layer.level = random.uniform(0.3, 0.7);
            layer.method = occlusion ? stack::ParallaxMethod::occlusion : stack::ParallaxMethod::offset;
            layer.lod = displaced ? stack::ParallaxLod::displaced : stack::ParallaxLod::base;
            const raster::Fragment<double> f = sight.fragment();
            const Moved m = moved(lab.compile({layer}), f, sight.placement(), mode);
            const vec3<double> up =
                normal_of_ramp(sight, layer.height, behind && mode == BackFaces::mirror ? -1 : 1);
            const bool turned_over = behind && mode != BackFaces::same;
            normal.add(m.frame.normal, turned_over ? -up : up, 1e-12, ++where);
            // Listing 17 wants the ray through the pixel, on which one step does not quite end.
            const vec3<double> hit = m.fragment.position + sight.camera.eye;
            const auto on_relief =
                sight.camera.intersect(hit, up, surfgrad::test::Dual<2>::variable(f.raster.x, 0),
                                       surfgrad::test::Dual<2>::variable(f.raster.y, 1));
            const vec3<double> dx = surfgrad::test::partial_of(on_relief, 0);
            const vec3<double> dy = surfgrad::test::partial_of(on_relief, 1);
            const double size = max_abs(dx) + max_abs(dy);
            dp.add(m.frame.dp_dx, dx, 1e-10 * size, where);
            dp.add(m.frame.dp_dy, dy, 1e-10 * size, where);
            dp.add(m.fragment.dp_dx, dx, 1e-10 * size, where);
            const auto along = [&](vec3<double> d) {
              return vec2<double>{dot(d, plane.axes.x), dot(d, plane.axes.y)};
            };
            const surfgrad::test::UvMap* maps[] = {&sight.map, &sight.other};
            for (std::size_t s = 0; s < 2; ++s) {
              const raster::UvFragment<double>& uv = m.fragment.uvs[s];
              dst.add(uv.dst_dx, maps[s]->linear(along(dx)), 1e-9 * size, where);
              dst.add(uv.dst_dy, maps[s]->linear(along(dy)), 1e-9 * size, where);
              EXPECT_EQ(max_abs(uv.footprint_dx - (displaced ? uv.dst_dx : f.uvs[s].dst_dx)), 0);
              EXPECT_EQ(max_abs(uv.footprint_dy - (displaced ? uv.dst_dy : f.uvs[s].dst_dy)), 0);
            }
            EXPECT_FALSE(m.first_pass);
          }
}

TEST_F(ParallaxFrame, APlaneThatFacesAwayIsReflectedWhereAsked) {
  for (const bool reflect : {false, true})
    for (int k = 0; k < 20; ++k) {
      Sight sight = on_the_ramp(60);
      // Heights that rise towards the viewer show the side that is not seen.
      const vec3<double> towards = normalize_or_zero(sight.camera.eye - sight.base.position);
      const vec2<double> uphill{dot(towards, plane.axes.x), dot(towards, plane.axes.y)};
      sight.map.s = {3 * uphill.x, 3 * uphill.y};
      sight.map.t = {uphill.y, -uphill.x};
      sight.map.offset = {0, 0};
      sight.map.offset = vec2<double>{0.5, 0.5} - sight.map(sight.base.uv);
      stack::ParallaxLayer layer = ramp_layer(0.5);
      layer.level = 0.5;
      layer.method = stack::ParallaxMethod::offset; // the first crossing always faces the viewer
      layer.facing = reflect ? stack::Facing::reflect : stack::Facing::keep;
      const raster::Fragment<double> f = sight.fragment();
      const vec3<double> away = normal_of_ramp(sight, 0.5, 1);
      const Moved m = moved(lab.compile({layer}), f, sight.placement());
      EXPECT_LT(max_abs(m.frame.normal - away), 1e-12);
      ASSERT_LT(dot(away, f.to_viewer), -0.1);
      const vec3<double> expected = reflect ? away - (2 * dot(away, f.to_viewer)) * f.to_viewer : away;
      EXPECT_LT(std::abs(dot(m.frame.dp_dx, expected)), 1e-12);
      EXPECT_LT(std::abs(dot(m.frame.dp_dy, expected)), 1e-12);
      // From the front the pixel's axes turn as they do on the mesh; from behind the other way round.
      const double turn =
          dot(cross(m.frame.dp_dx, m.frame.dp_dy), expected) * dot(cross(f.dp_dx, f.dp_dy), f.normal);
      EXPECT_EQ(turn > 0, reflect);
    }
}

TEST_F(ParallaxFrame, WhereNobodyLooksTheReliefLiesOverItsOwnPoints) {
  Worst normal("normal in a bake"), rest("the rest in a bake");
  for (const stack::ParallaxMethod method : {stack::ParallaxMethod::offset, stack::ParallaxMethod::occlusion})
    for (long k = 0; k < 50; ++k) {
      stack::ParallaxLayer layer = test::parallax_layer("heights", 0.2);
      layer.map.filter = stack::Filter::bilinear;
      layer.method = method;
      layer.level = random.uniform(0, 1);
      stack::HeightMapLayer heights;
      heights.map = layer.map;
      heights.height = layer.height;
      heights.taps = stack::Taps::bicubic;
      raster::Fragment<double> f = test::random_fragment(random);
      f.to_viewer = {0, 0, 0};
      // A triangle that is smooth nowhere: then the height map's own footprint is that of its plane.
      f.normal = cross(f.dp_dx, f.dp_dy);
      const Program program = lab.compile({layer});
      const Placement placement = test::placed(test::identity);
      const Moved m = moved(program, f, placement);
      const vec3<double> n = normalize_or_zero(f.normal);
      normal.add(m.frame.normal, test::composed(lab.compile({heights}), f).normal, 1e-12, k);
      const double rise = (test::height_at(program, f.uvs[0].st, f) - layer.level) * layer.height;
      rest.add(m.fragment.position, f.position + rise * n, 1e-12, k);
      rest.add(m.fragment.uvs[0].st, f.uvs[0].st, 1e-300, k);
      rest.add(m.fragment.uvs[1].dst_dx, f.uvs[1].dst_dx, 1e-12, k);
      rest.add(m.frame.dp_dx - f.dp_dx, dot(m.frame.dp_dx, n) * n, 1e-12, k);
      rest.add(dot(m.frame.dp_dx, m.frame.normal), 0, 1e-12, k);
      EXPECT_EQ(m.sunlight, 1);
    }
}

TEST_F(ParallaxFrame, DetailOnTheReliefIsAsContinuousAsTheReliefIs) {
  image::Image waves = image::make_image(64, 64, 1, image::Depth::float32);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double turn = 2 * std::numbers::pi / 64;
      waves.texels[static_cast<std::size_t>(64 * y + x)] =
          static_cast<float>(0.5 + 0.25 * std::sin(turn * x) + 0.25 * std::sin(turn * y));
    }
  lab.add("waves", waves);
  stack::NormalMapLayer detail = test::normal_layer("normals", 0, stack::Basis::derived);
  detail.map.tile = {4, 4};
  const Program program = lab.compile({test::parallax_layer("waves", 0.05), detail});
  const Program without = lab.compile({test::parallax_layer("waves", 0.05)});
  const Sight middle(evaluate(plane, {0.2, 0.1}), 35, random);
  const auto at = [&](const Program& layers, double x) {
    Sight sight = middle;
    const vec3<double> hit = sight.camera.intersect(
        plane.origin, plane.axes.z, middle.fragment().raster.x + x, middle.fragment().raster.y);
    sight.base = evaluate(plane, plane.parameters(hit));
    return compose(layers, sight.fragment(), BackFaces::same, sight.placement()).normal;
  };
  const auto largest_step = [&](double pixels) {
    double largest = 0;
    for (double x = 0; x < 40; x += pixels)
      largest = std::max(largest, length(at(program, x + pixels) - at(program, x)));
    return largest;
  };
  const double coarse = largest_step(0.2);
  const double fine = largest_step(0.02);
  std::printf("  largest step between neighbours %.3g, ten times finer %.3g\n", coarse, fine);
  EXPECT_LT(fine, 0.15 * coarse);
  double most = 0;
  for (double x = 0; x < 40; ++x) most = std::max(most, length(at(program, x) - at(without, x)));
  EXPECT_GT(most, 0.1) << "the detail must show";
}

TEST_F(ParallaxFrame, WithoutANormalOfItsOwnTheVertexFrameServesAsItIs) {
  stack::ParallaxLayer layer = test::parallax_layer("heights", 0.1);
  layer.normal = stack::ParallaxNormal::none;
  const vec3<double> m{2 * 0.7f - 1.0, 2 * 0.35f - 1.0, 2 * 0.9f - 1.0};
  const Program program = lab.compile({layer, test::normal_layer("tilted")});
  Worst decode("standard decode on a flat base");
  for (long k = 0; k < 50; ++k) {
    const Sight sight(evaluate(plane, random.vector2(-2, 2)), 50, random);
    raster::Fragment<double> f = sight.fragment();
    f.normal = 0.8 * f.normal;
    f.uvs[0].tangent = random.vector3();
    f.uvs[0].sign = random.sign();
    const vec3<double> expected =
        m.x * f.uvs[0].tangent + (m.y * f.uvs[0].sign) * cross(f.normal, f.uvs[0].tangent) + m.z * f.normal;
    // Slopes are stored in float.
    decode.add(compose(program, f, BackFaces::same, sight.placement()).normal, normalize_or_zero(expected),
               4 * std::numeric_limits<float>::epsilon(), k);
  }
  const Sphere sphere{2};
  const Sight round(evaluate(sphere, {0.3, 0.4}), 50, random);
  const Moved on_sphere = moved(lab.compile({layer}), round.fragment(), round.placement());
  EXPECT_TRUE(on_sphere.first_pass);
  EXPECT_GT(max_abs(on_sphere.frame.normal - round.base.normal), 1e-3) << "curvature turns it";
  EXPECT_LT(max_abs(on_sphere.frame.normal - normalize_or_zero(on_sphere.fragment.normal)), 1e-14);
}

TEST_F(ParallaxFrame, FunctionsOfTheObjectsSpaceAreSampledOnTheRelief) {
  const mat3<double> stretch{{2, 0, 0}, {0, 1, 0.5}, {0, 0, -0.25}};
  const Program program = lab.compile({test::parallax_layer("heights", 0.1)});
  const Sight sight(evaluate(plane, {0.1, 0.2}), 50, random);
  const raster::Fragment<double> f = sight.fragment();
  Placement placement = test::placed(stretch);
  const Placement view = sight.placement();
  placement.relative_from_screen = view.relative_from_screen;
  const Moved m = moved(program, f, placement);
  EXPECT_GT(max_abs(m.fragment.position - f.position), 1e-3);
  EXPECT_LT(max_abs(stretch * (m.fragment.object_position - f.object_position) -
                    (m.fragment.position - f.position)),
            1e-14);
}

/// A wall, or with a negative scale a ditch, of 4 texels of 64 across s, seen from straight above.
struct ParallaxShadow : ParallaxFrame {
  static constexpr double height = 0.1;

  void SetUp() override {
    image::Image wall = image::make_image(64, 1, 1, image::Depth::float32);
    for (std::size_t i = 30; i < 34; ++i) wall.texels[i] = 1;
    lab.add("wall", wall);
  }
  /// Sunlight at texel x of the wall's row under a sun so high over the horizon, from the side of larger
  /// s, or of smaller.
  [[nodiscard]] double sunlight(double texel, double degrees, double from, double scale = 1,
                                stack::ParallaxMethod method = stack::ParallaxMethod::occlusion) {
    stack::ParallaxLayer layer = test::parallax_layer("wall", height);
    layer.self_shadow = true;
    layer.common.scale = scale;
    layer.method = method;
    Sight sight(evaluate(plane, {(texel + 0.5) / 64, 0.5}), 0, random);
    sight.map = {{1, 0}, {0, 1}};
    const double angle = degrees * std::numbers::pi / 180;
    const vec3<double> sun = std::cos(angle) * from * plane.axes.x + std::sin(angle) * plane.axes.z;
    return moved(lab.compile({layer}), sight.fragment(), sight.placement(sun)).sunlight;
  }
};

TEST_F(ParallaxShadow, OfAWallIsAsLongAsItsHeightOverTheSunsTangent) {
  for (const auto method : {stack::ParallaxMethod::occlusion, stack::ParallaxMethod::offset})
    for (const double degrees : {20.0, 35.0, 50.0}) {
      // From the wall's upper edge, texel 33's centre (30's from the other side).
      const double length = 64 * height / std::tan(degrees * std::numbers::pi / 180);
      for (const double from : {-1.0, 1.0}) {
        const double end = from < 0 ? 33 + length : 30 - length;
        const auto lit = [&](double texels_beyond) {
          return sunlight(end - from * texels_beyond, degrees, from, 1, method);
        };
        EXPECT_EQ(lit(-0.01), 0) << degrees;
        EXPECT_EQ(lit(0.01), 1) << degrees;
        EXPECT_EQ(lit(-length / 2), 0) << degrees;
        EXPECT_EQ(lit(10), 1) << degrees;
      }
      EXPECT_EQ(sunlight(31.5, degrees, 1, 1, method), 1) << "on top of the wall";
    }
}

TEST_F(ParallaxShadow, FallsIntoADitch) {
  // Its edge at texel 34's centre; a low sun leaves the floor, 31 to 33, dark, a high one lights it.
  for (const auto method : {stack::ParallaxMethod::occlusion, stack::ParallaxMethod::offset}) {
    EXPECT_EQ(sunlight(31.5, 45, 1, -1, method), 0);
    EXPECT_EQ(sunlight(31.5, 80, 1, -1, method), 1);
    const double shadow = 64 * height / std::tan(75 * std::numbers::pi / 180);
    EXPECT_EQ(sunlight(34 - shadow + 0.01, 75, 1, -1, method), 0);
    EXPECT_EQ(sunlight(34 - shadow - 0.01, 75, 1, -1, method), 1);
    EXPECT_EQ(sunlight(40, 10, 1, -1, method), 1) << "outside";
  }
}

TEST_F(ParallaxShadow, IsEverywhereWhereTheSunIsBehindTheMesh) {
  EXPECT_EQ(sunlight(50, 30, 1), 1);
  for (const double texel : {29.5, 32.0, 33.7, 50.0}) EXPECT_EQ(sunlight(texel, -1, 1), 0);
}

TEST_F(ParallaxFrame, StaysFiniteWhereverTheInputIsDegenerate) {
  stack::NormalMapLayer detail = test::normal_layer("normals", 1, stack::Basis::derived);
  const vec3<double> none{0, 0, 0};
  int flagged = 0;
  for (const auto method : {stack::ParallaxMethod::occlusion, stack::ParallaxMethod::offset})
    for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip})
      for (int k = 0; k < 400; ++k) {
        stack::ParallaxLayer layer = test::parallax_layer("heights", random.magnitude(1e-12, 1e12));
        layer.common.scale = random.sign() * random.magnitude(1e-12, 1e12);
        layer.method = method;
        layer.level = random.uniform(0, 1);
        layer.limit_offset = method == stack::ParallaxMethod::offset && random.integer(2) == 0;
        layer.lod = random.integer(2) == 0 ? stack::ParallaxLod::base : stack::ParallaxLod::displaced;
        layer.normal = random.integer(2) == 0 ? stack::ParallaxNormal::none : stack::ParallaxNormal::height;
        layer.facing = stack::Facing::reflect;
        layer.self_shadow = true;
        const Sight sight(evaluate(plane, {0, 0}), random.uniform(0, 180), random);
        raster::Fragment<double> f = sight.fragment();
        const int what = random.integer(9);
        if (what == 0) f.uvs[0].dst_dx = {0, 0};
        if (what == 1) f.uvs[0].dst_dy = 2.0 * f.uvs[0].dst_dx;
        if (what == 2) f.normal = none;
        if (what == 3) f.dp_dx = none;
        if (what == 4) f.dp_dx = f.dp_dy = f.normal = none;
        if (what == 5) f.normal = normalize_or_zero(cross(f.to_viewer, f.dp_dx));
        if (what == 6) f.to_viewer = none;
        if (what == 7) f.dn_dx = random.magnitude(1, 1e12) * random.vector3();
        const Placement placement = sight.placement(random.unit_vector());
        const bool collapsed = what < 2 || what == 3 || what == 4;
        const Moved m = moved(lab.compile({layer}), f, placement, mode);
        EXPECT_EQ(m.degenerate, collapsed) << what;
        flagged += m.degenerate ? 1 : 0;
        const auto c = compose(lab.compile({layer, detail}), f, mode, placement);
        const double size = length(c.normal);
        EXPECT_TRUE(size == 0 || std::abs(size - 1) < 1e-9) << what << " " << size;
        EXPECT_TRUE(size > 0 || c.degenerate) << what;
        for (const vec3<double>& v : {m.fragment.position, m.fragment.object_position, m.fragment.dp_dx,
                                      m.fragment.dp_dy, c.surfgrad})
          EXPECT_TRUE(std::isfinite(v.x + v.y + v.z)) << what;
        for (std::size_t s = 0; s < 2; ++s)
          for (const vec2<double>& v :
               {m.fragment.uvs[s].st, m.fragment.uvs[s].dst_dx, m.fragment.uvs[s].dst_dy})
            EXPECT_TRUE(std::isfinite(v.x + v.y)) << what;
        EXPECT_TRUE(m.sunlight == 0 || m.sunlight == 1);
      }
  EXPECT_GT(flagged, 100);
}

} // namespace
} // namespace surfgrad::engine
