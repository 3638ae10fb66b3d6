// Height maps against the surfaces they describe: displaced ones, and slopes that do not scale.

#include "height_fragments.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace surfgrad::engine {
namespace {

using stack::HeightMode;
using stack::Taps;
using stack::Units;
using surfgrad::test::gradient_of;
using test::composed;
using test::for_each_point;
using test::height_layer;
using test::waves;

/// A few dozen roundings of gradients of order one; map texels are exact floats on both sides.
constexpr double rounding = 1e-12;

double degrees_between(vec3<double> a, vec3<double> b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

stack::HeightMapLayer with_taps(stack::HeightMapLayer layer, Taps taps) {
  layer.taps = taps;
  return layer;
}
stack::HeightMapLayer with_tile(stack::HeightMapLayer layer, vec2<double> tile) {
  layer.map.tile = tile;
  return layer;
}

struct HeightMaps : ::testing::Test {
  static constexpr std::uint64_t seed = 171;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};

  /// (dh/ds', dh/dt') of the B-spline of an image, by differences of its values.
  static vec2<double> spline_derivative(const image::Image& image, vec2<double> st) {
    const image::Map map = image::make_height_map(image, 0);
    const double step = 1e-5; // error: step^2 times the third derivative, and 1e-16 / step
    const auto h = [&](double ds, double dt) {
      return image::sample_bicubic(map, st + vec2<double>{ds, dt}, image::Wraps{}, true).value;
    };
    return {(h(step, 0) - h(-step, 0)) / (2 * step), (h(0, step) - h(0, -step)) / (2 * step)};
  }
};

TEST_F(HeightMaps, ConvergeToBlinnsNormal) {
  constexpr double height = 0.1;
  constexpr Taps kinds[] = {Taps::one, Taps::three, Taps::bicubic};
  std::vector<std::array<double, 3>> mean;
  for (const int size : {32, 64, 128, 256}) {
    lab.add("waves", test::height_image(size, size, [](auto st) { return waves(st); }));
    std::vector<Program> programs;
    for (const Taps taps : kinds)
      programs.push_back(lab.compile({with_taps(height_layer("waves", height), taps)}));
    std::array<double, 3> sum{};
    for_each_point(random, 300, [&](const auto& p, const auto& uv, auto f) {
      f = test::with_footprint(f, 0.5, size);
      const vec2<double> dh = gradient_of([](auto q) { return waves(q); }, uv(p.uv));
      const vec3<double> truth = test::blinn_normal(p, uv, height * dh);
      for (std::size_t k = 0; k < 3; ++k)
        sum[k] += degrees_between(composed(programs[k], f).normal, truth) / 900;
    });
    std::printf("  %3d texels, half a texel a pixel: one tap %.4f, three %.4f, bicubic %.5f degrees mean\n",
                size, sum[0], sum[1], sum[2]);
    mean.push_back(sum);
  }
  for (std::size_t i = 1; i < mean.size(); ++i) {
    // Taps have an error of the first order in the size of a pixel and a texel, the spline of the second.
    EXPECT_NEAR(mean[i - 1][0] / mean[i][0], 2, 0.3);
    EXPECT_NEAR(mean[i - 1][1] / mean[i][1], 2, 0.3);
    EXPECT_NEAR(mean[i - 1][2] / mean[i][2], 4, 0.4);
    EXPECT_LT(mean[i][2], mean[i][1]);
    EXPECT_LT(mean[i][1], mean[i][0]);
  }
}

TEST_F(HeightMaps, BicubicIsTheNormalOfTheSplineSurface) {
  surfgrad::test::Worst worst("normal of the displaced spline");
  const image::Image image = surfgrad::test::random_image(random, 16, 8, 1);
  lab.add("heights", image);
  const Program program = lab.compile({with_taps(height_layer("heights", 0.02), Taps::bicubic)});
  long k = 0;
  for_each_point(random, 200, [&](const auto& p, const auto& uv, auto f) {
    f = test::with_footprint(f, 0.9, 16);
    const vec3<double> truth = test::blinn_normal(p, uv, 0.02 * spline_derivative(image, uv(p.uv)));
    worst.add(composed(program, f).normal, truth, 1e-7, k++); // the differences' own error
  });
}

TEST_F(HeightMaps, TilesMultiplyPhysicalDerivativesAndLeaveScaleFreeSlopesAlone) {
  surfgrad::test::Worst physical("gradient, physical, tiled");
  surfgrad::test::Worst scale_free("gradient, scale-free, tiled");
  const image::Image image = surfgrad::test::random_image(random, 16, 16, 1);
  lab.add("heights", image);
  const double height = 0.02;
  for (const vec2<double> tile : {vec2<double>{1, 1}, {3, 3}, {2, 0.5}, {-2, 3}, {0.25, -4}}) {
    const auto use = [&](HeightMode mode) {
      return lab.compile({with_tile(with_taps(height_layer("heights", height, mode), Taps::bicubic), tile)});
    };
    const Program p = use(HeightMode::physical);
    const Program s = use(HeightMode::scale_free);
    for (long k = 0; k < 100; ++k) {
      // A unit square of texture on the unit square of a plane: slopes are derivatives.
      raster::Fragment<double> f{};
      f.normal = {0, 0, 1};
      f.dp_dx = {0.001, 0.0003, 0};
      f.dp_dy = {-0.0002, 0.0012, 0};
      f.front_facing = true;
      f.uvs[0].st = random.vector2(-2, 2);
      f.uvs[0].dst_dx = f.uvs[0].footprint_dx = {f.dp_dx.x, f.dp_dx.y};
      f.uvs[0].dst_dy = f.uvs[0].footprint_dy = {f.dp_dy.x, f.dp_dy.y};
      const vec2<double> dh = height * spline_derivative(image, tile * f.uvs[0].st);
      const vec3<double> g = composed(p, f).surfgrad;
      physical.add(vec2<double>{g.x, g.y}, tile * dh, 1e-6, k); // the differences' own error
      const vec3<double> h = composed(s, f).surfgrad;
      const vec2<double> side{tile.x < 0 ? -1.0 : 1.0, tile.y < 0 ? -1.0 : 1.0};
      scale_free.add(vec2<double>{h.x, h.y}, side * dh, 1e-6, k);
    }
  }
}

TEST_F(HeightMaps, AreDisplacedInTheSceneOrInTheObject) {
  const image::Image image = surfgrad::test::random_image(random, 16, 16, 1);
  lab.add("heights", image);
  const double height = 0.03;
  const mat3<double> turn = random.rotation();
  const std::pair<const char*, mat3<double>> transforms[] = {
      {"turned", turn},
      {"three times as large", turn * test::scaling({3, 3, 3})},
      {"non-uniform", turn * test::scaling({0.5, 2, 1}) * random.rotation()},
      {"mirrored", turn * test::scaling({1, -1, 1})},
      {"non-uniform and mirrored", test::scaling({-0.7, 1.5, 1}) * random.rotation()}};
  for (const auto& [name, m] : transforms) {
    surfgrad::test::Worst scene(std::string("units of the scene, ") + name);
    surfgrad::test::Worst object(std::string("units of the object, ") + name);
    surfgrad::test::Worst definition(std::string("transform_normal, ") + name);
    stack::HeightMapLayer layer = with_taps(height_layer("heights", height), Taps::bicubic);
    const Program by_scene = lab.compile({layer});
    layer.units = Units::object;
    const Program by_object = lab.compile({layer});
    const double turned = determinant(m) < 0 ? -1 : 1;
    long k = 0;
    for_each_point(random, 60, [&](const auto& p, const auto& uv, auto f) {
      f = test::with_footprint(f, 0.5, 16);
      const auto world = test::moved(f, m);
      const vec2<double> dh = height * spline_derivative(image, uv(p.uv));
      const auto [t, b] = uv.tangents(p);
      const double side = turned * (uv.determinant() < 0 ? -1 : 1);
      const auto across = [&](vec3<double> a, vec3<double> c) {
        return side * normalize_or_zero(cross(a, c));
      };
      // 1e-6: the differences' own error, times the aspect of the transform
      const vec3<double> n = world.normal;
      scene.add(composed(by_scene, world, BackFaces::same, m).normal,
                across(m * t + dh.x * n, m * b + dh.y * n), 1e-6, k);
      const vec3<double> displaced = across(m * (t + dh.x * p.normal), m * (b + dh.y * p.normal));
      const vec3<double> got = composed(by_object, world, BackFaces::same, m).normal;
      object.add(got, displaced, 1e-6, k);
      const vec3<double> unmoved = composed(by_object, f).normal;
      definition.add(got, normalize_or_zero(transform_normal(m, unmoved)), rounding, k);

      // Seen from behind: flip shows the same surface, mirror one that is displaced the other way.
      auto behind = world;
      behind.front_facing = false;
      object.add(composed(by_object, behind, BackFaces::flip, m).normal, -displaced, 1e-6, k);
      object.add(composed(by_object, behind, BackFaces::mirror, m).normal,
                 -across(m * (t - dh.x * p.normal), m * (b - dh.y * p.normal)), 1e-6, k);
      ++k;
    });
  }
}

TEST_F(HeightMaps, UniformScaleDividesSceneSlopesAndKeepsTheOthers) {
  surfgrad::test::Worst worst("gradients of a scaled object");
  lab.add("heights", surfgrad::test::random_image(random, 16, 16, 1));
  for (const Taps taps : {Taps::three, Taps::bicubic}) {
    stack::HeightMapLayer layer = with_taps(height_layer("heights", 0.02), taps);
    const Program by_scene = lab.compile({layer});
    layer.units = Units::object;
    const Program by_object = lab.compile({layer});
    layer.units = Units::scene;
    layer.mode = HeightMode::scale_free;
    const Program scale_free = lab.compile({layer});
    for (const double scale : {1e-6, 0.5, 2.0, 1e6}) {
      const mat3<double> m = test::scaling({scale, scale, scale});
      layer.mode = HeightMode::physical;
      layer.height = 0.02 * scale;
      const Program scaled_heights = lab.compile({layer});
      layer.height = 0.02;
      long k = 0;
      for_each_point(random, 30, [&](const auto&, const auto&, const auto& f) {
        const auto g = [&](const Program& program, bool large) {
          return large ? composed(program, test::moved(f, m), BackFaces::same, m).surfgrad
                       : composed(program, f).surfgrad;
        };
        const vec3<double> small = g(by_scene, false);
        if (scale > 1e-3) // else the slopes are so steep that the normal keeps little of them
          worst.add(g(by_scene, true), (1 / scale) * small,
                    rounding * (1 + dot(small, small) / (scale * scale)), k);
        const double bound = rounding * (1 + dot(small, small));
        worst.add(g(by_object, true), small, bound, k);
        worst.add(g(scaled_heights, true), small, bound, k);
        const vec3<double> slopes = g(scale_free, false);
        worst.add(g(scale_free, true), slopes, rounding * (1 + dot(slopes, slopes)), k);
        ++k;
      });
    }
  }
}

TEST_F(HeightMaps, OneTapIsConstantOverABlockOfTwoByTwoPixels) {
  surfgrad::test::Worst worst("one tap within a block");
  surfgrad::test::Worst differences("one tap against the block's heights");
  const image::Image image = surfgrad::test::random_image(random, 16, 16, 1);
  lab.add("heights", image);
  const image::Map map = image::make_height_map(image, 0);
  const Program program = lab.compile({with_taps(height_layer("heights", 0.02), Taps::one)});
  const vec2<double> dx{0.01, 0.003};
  const vec2<double> dy{-0.002, 0.02};
  const auto at = [&](int x, int y) {
    raster::Fragment<double> f{};
    f.raster = {x + 0.5, y + 0.5};
    f.normal = {0, 0, 1};
    f.dp_dx = {1e-2, 0, 0};
    f.dp_dy = {0, 1e-2, 0};
    f.front_facing = true;
    f.uvs[0].st = static_cast<double>(x) * dx + static_cast<double>(y) * dy;
    f.uvs[0].dst_dx = f.uvs[0].footprint_dx = dx;
    f.uvs[0].dst_dy = f.uvs[0].footprint_dy = dy;
    return f;
  };
  const auto height = [&](int x, int y) {
    return 0.02 *
           image::sample<1>(map, at(x, y).uvs[0].st, -1.0, image::Wraps{}, image::Filter::bilinear, true)[0];
  };
  vec3<double> last{0, 0, 0};
  for (int y = 0; y < 40; y += 2)
    for (int x = 0; x < 40; x += 2) {
      const vec3<double> first = composed(program, at(x, y)).surfgrad;
      for (const auto& [i, j] : {std::pair{1, 0}, {0, 1}, {1, 1}})
        worst.add(composed(program, at(x + i, y + j)).surfgrad, first, rounding, 40 * y + x);
      differences.add(vec2<double>{first.x, first.y},
                      100.0 * vec2<double>{height(x + 1, y) - height(x, y), height(x, y + 1) - height(x, y)},
                      rounding, 40 * y + x);
      EXPECT_GT(max_abs(first - last), 1e-6) << "blocks differ";
      last = first;
    }
}

TEST_F(HeightMaps, TheSplineFadesIntoTheTapsWithTheMipLevel) {
  const image::Image image = surfgrad::test::random_image(random, 16, 16, 1);
  lab.add("heights", image);
  const Program bicubic = lab.compile({with_taps(height_layer("heights", 0.02), Taps::bicubic)});
  const Program three = lab.compile({height_layer("heights", 0.02)});
  surfgrad::test::Worst far("from half a level on");
  surfgrad::test::Worst near("magnified");
  double jump[2] = {0, 0};
  double distance = 0;
  long k = 0;
  for_each_point(random, 20, [&](const auto& p, const auto& uv, const auto& f) {
    const auto g = [&](const Program& program, double lod) {
      return composed(program, test::with_footprint(f, std::exp2(lod), 16)).surfgrad;
    };
    for (const double lod : {0.5 + 1e-9, 0.7, 1.5, 3.0}) far.add(g(bicubic, lod), g(three, lod), rounding, k);
    const vec2<double> dh = 0.02 * spline_derivative(image, uv(p.uv));
    const auto [t, b] = uv.tangents(p);
    const double size = max_abs(g(three, 0.2));
    for (const double lod : {0.05 - 1e-9, 0.0, -1.0, -5.0}) // 1e-6: the differences' own error
      near.add(g(bicubic, lod), from_parametric_derivative(p.normal, t, b, dh), 1e-6 * (1 + size * size), k);
    ++k;
    distance = std::max(distance, max_abs(g(bicubic, 0.05) - g(bicubic, 0.5)));
    for (int fine = 0; fine < 2; ++fine) {
      const int steps = fine == 1 ? 4000 : 2000;
      for (int i = 0; i < steps; ++i)
        jump[fine] = std::max(jump[fine], max_abs(g(bicubic, -0.25 + 1.0 * (i + 1) / steps) -
                                                  g(bicubic, -0.25 + 1.0 * i / steps)));
    }
  });
  std::printf("  largest change over the fade %.3g, in 1/2000 of a level %.3g, in 1/4000 %.3g\n", distance,
              jump[0], jump[1]);
  EXPECT_NEAR(jump[0] / jump[1], 2, 0.1) << "a jump would stay as it is";
}

} // namespace
} // namespace surfgrad::engine
