// Noise layers on surfaces: the normal of a height that is a function of space, under every transform.

#include "lab.hpp"
#include "support/surfaces.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace surfgrad::engine {
namespace {

using stack::NoiseFunction;
using stack::NoiseKind;
using stack::NoiseLayer;
using stack::VolumeFunction;
using surfgrad::test::Dual;
using surfgrad::test::mat3d;
using surfgrad::test::Random;
using surfgrad::test::Sphere;
using surfgrad::test::SurfacePoint;
using surfgrad::test::Torus;
using surfgrad::test::vec2d;
using surfgrad::test::vec3d;
using surfgrad::test::Worst;
using test::composed;
using test::Lab;
using test::placed;

constexpr std::uint64_t seed = 20240702;

NoiseLayer noise_layer(NoiseKind function, double frequency, double scale = 1) {
  NoiseLayer layer;
  layer.noise.function = function;
  layer.noise.frequency = frequency;
  layer.noise.octaves = 3;
  layer.common.scale = scale;
  return layer;
}

/// A smooth function of space with the gradient that dual numbers give it.
NoiseLayer wavy_layer(double scale = 1) {
  NoiseLayer layer;
  layer.common.scale = scale;
  layer.custom = VolumeFunction([](vec3<double> p) {
    const auto wavy = [](auto q) { return surfgrad::test::wavy(q); };
    return Noise<double>{wavy(p), surfgrad::test::gradient_of(wavy, p)};
  });
  return layer;
}

/// A fragment of an object with this transform, of no size, seen from nowhere.
raster::Fragment<double> fragment_at(const SurfacePoint& p, const mat3d& m = test::identity) {
  raster::Fragment<double> f{};
  f.object_position = p.position;
  f.position = m * p.position;
  f.normal = normalize_or_zero(transform_normal(m, p.normal));
  f.front_facing = true;
  return f;
}

vec3d composed_normal(const NoiseLayer& layer, const SurfacePoint& p, const mat3d& m = test::identity) {
  return composed(Lab().compile({layer}), fragment_at(p, m), BackFaces::same, m).normal;
}

double degrees_between(vec3d a, vec3d b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// Derivative by Richardson extrapolation of central differences. Of the noises' values, whose third
/// derivatives jump at cell borders, this step leaves about 1e-9.
template <class Function>
auto derivative(Function f) {
  constexpr double step = 0x1p-19;
  const auto wide = (1 / (2 * step)) * (f(step) - f(-step));
  const auto narrow = (1 / step) * (f(step / 2) - f(-step / 2));
  return (1.0 / 3.0) * (4.0 * narrow - wide);
}

template <class Visit>
void for_each_curved_surface(Visit visit) {
  visit(Sphere{1.0});
  visit(Torus{2.0, 1.0});
}

/// Functions without kinks, on which differences of values can be trusted everywhere.
std::vector<NoiseLayer> smooth_layers() {
  NoiseLayer dented = noise_layer(NoiseKind::fractal_sum, 1.2, 0.7);
  dented.noise.power = 3;
  NoiseLayer moved = noise_layer(NoiseKind::simplex, 1.5, -0.4);
  moved.noise.offset = {0.2, -0.7, 1.3};
  return {noise_layer(NoiseKind::perlin, 2, 0.5), moved, noise_layer(NoiseKind::fractal_sum, 1, 0.6), dented};
}

// ---------------------------------------------------------------------------- truth on surfaces

TEST(NoiseLayer, EqualsBlinnsNormalOfTheHeight) {
  Random random(seed);
  Worst exact("Blinn's normal, function of space by dual numbers");
  Worst differences("Blinn's normal, noises by differences of their values");
  const Program wavy = Lab().compile({wavy_layer(0.8)});
  for_each_curved_surface([&](const auto& surface) {
    for (long i = 0; i < 300; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const auto blinn = [&p](vec2d h) {
        return normalize_or_zero(cross(p.dp_du + h.x * p.normal, p.dp_dv + h.y * p.normal));
      };
      const vec2d slopes = surfgrad::test::gradient_of(
          [&](auto uv) { return surfgrad::test::wavy(surface.position(uv.x, uv.y)); }, p.uv);
      exact.add(composed(wavy, fragment_at(p)).normal, blinn(0.8 * slopes), 1e-9, i);
      for (const NoiseLayer& layer : smooth_layers()) {
        const auto height = [&](double u, double v) {
          return layer.common.scale * evaluate(layer.noise, surface.position(u, v), 0.0).value;
        };
        const vec2d h{derivative([&](double d) { return height(p.uv.x + d, p.uv.y); }),
                      derivative([&](double d) { return height(p.uv.x, p.uv.y + d); })};
        differences.add(composed_normal(layer, p), blinn(h), 1e-7, i);
      }
    }
  });
}

/// Normal of P + scale * f(P) * N, where P are points of the surface.
template <class Surface>
vec3d displaced_normal(const Surface& surface, const NoiseLayer& layer, vec2d uv) {
  const auto displaced = [&](double u, double v) {
    const vec3d p = surface.position(u, v);
    return p + (layer.common.scale * evaluate(layer.noise, p, 0.0).value) * surface.normal(u, v);
  };
  return normalize_or_zero(cross(derivative([&](double d) { return displaced(uv.x + d, uv.y); }),
                                 derivative([&](double d) { return displaced(uv.x, uv.y + d); })));
}

TEST(NoiseLayer, DisplacedSurfaceDiffersByItsCurvatureAlone) {
  Random random(seed);
  double worst = 0;
  for_each_curved_surface([&](const auto& surface) {
    for (int i = 0; i < 300; ++i) {
      const SurfacePoint p = random_point(surface, random);
      for (NoiseLayer layer : smooth_layers()) {
        layer.common.scale *= 0.1;
        const double h = layer.common.scale * evaluate(layer.noise, p.position, 0.0).value;
        const vec3d g = composed(Lab().compile({layer}), fragment_at(p))
                            .surfgrad; // N - (I + h dN)^-1 g, by the moved basis
        const vec3d corrected = from_parametric_derivative(
            p.normal, p.dp_du + h * p.dn_du, p.dp_dv + h * p.dn_dv, vec2d{dot(g, p.dp_du), dot(g, p.dp_dv)});
        const double error =
            degrees_between(normalize_or_zero(p.normal - corrected), displaced_normal(surface, layer, p.uv));
        worst = std::max(worst, error);
      }
    }
  });
  std::printf("  worst error with the shape operator: %.2g degrees\n", worst);
  EXPECT_LT(worst, 1e-5);
}

TEST(NoiseLayer, NeglectOfCurvatureFallsWithTheSquareOfTheAmplitude) {
  for_each_curved_surface([](const auto& surface) {
    double mean[3] = {0, 0, 0};
    constexpr int count = 400;
    Random random(seed);
    for (int i = 0; i < count; ++i) {
      const SurfacePoint p = random_point(surface, random);
      double amplitude = 0.01; // of the radius, 1
      for (double& sum : mean) {
        const NoiseLayer layer = noise_layer(NoiseKind::fractal_sum, 4, amplitude);
        sum += degrees_between(composed_normal(layer, p), displaced_normal(surface, layer, p.uv)) / count;
        amplitude /= 2;
      }
    }
    std::printf("  neglect at 1, 0.5 and 0.25 %% amplitude: %.5f, %.5f, %.5f degrees\n", mean[0], mean[1],
                mean[2]);
    EXPECT_LT(mean[0], 0.5);
    EXPECT_NEAR(mean[0] / mean[1], 4, 0.2);
    EXPECT_NEAR(mean[1] / mean[2], 4, 0.2);
  });
}

// --------------------------------------------------------------------------------------- transforms

TEST(NoiseLayer, ObjectSpaceFollowsRotationMirroringAndUniformScale) {
  Random random(seed);
  Worst worst("normal of the scaled object against the scaled normal");
  for (long i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const mat3d r = random.rotation();
    const double s = random.sign() * random.magnitude(1e-6, 1e6);
    const mat3d m{s * r.x, s * r.y, s * r.z};
    for (const NoiseLayer& layer : smooth_layers())
      // A displacement of the object, then transformed with it (Golubev, equation 33).
      worst.add(composed_normal(layer, p, m),
                normalize_or_zero(transform_normal(m, composed_normal(layer, p))), 1e-12, i);
  }
}

TEST(NoiseLayer, ObjectSpaceIsDisplacedThereThenTransformed) {
  Random random(seed);
  Worst blinn("Blinn's normal of the object, transformed");
  Worst transformed("composed normal of the object, transformed");
  double bend = 0;
  for (int i = 0; i < 1000; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    mat3d m = random.matrix3(-2, 2); // stretched, sheared; half of them mirrored
    while (std::abs(determinant(m)) < 0.5) m = random.matrix3(-2, 2);
    const double scale = random.uniform(-0.3, 0.3);
    const vec2d h =
        scale * surfgrad::test::gradient_of(
                    [&](auto uv) { return surfgrad::test::wavy(Torus{}.position(uv.x, uv.y)); }, p.uv);
    // The displaced tangents go through M like everything else of the object.
    const vec3d t = m * (p.dp_du + h.x * p.normal);
    const vec3d b = m * (p.dp_dv + h.y * p.normal);
    const vec3d truth = normalize_or_zero((determinant(m) < 0 ? -1.0 : 1.0) * cross(t, b));
    const vec3d n = fragment_at(p, m).normal;
    if (dot(truth, n) < 0.1) continue; // leaning over: mirrored at the surface
    const vec3d got = composed_normal(wavy_layer(scale), p, m);
    blinn.add(got, truth, 1e-9, i);
    transformed.add(got, normalize_or_zero(transform_normal(m, composed_normal(wavy_layer(scale), p))), 1e-9,
                    i);
    bend = std::max(bend, degrees_between(got, n));
  }
  EXPECT_GT(bend, 45) << "degrees: a bump that is strong beside the transform";
}

TEST(NoiseLayer, FlippedBackFacesShowTheSameSurfaceUnderAnyTransform) {
  Random random(seed);
  const Program program = Lab().compile({wavy_layer(0.2), stack::ResolveLayer{}, wavy_layer(-0.1)});
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const mat3d m = random.matrix3(-2, 2);
    raster::Fragment<double> f = fragment_at(p, m);
    const vec3d front = composed(program, f, BackFaces::flip, m).normal;
    f.front_facing = false;
    EXPECT_EQ(max_abs(composed(program, f, BackFaces::flip, m).normal + front), 0);
  }
}

TEST(NoiseLayer, ALeaningSlopeMayTurnTheNormalUnderTheSurface) {
  // Sheared so that N leans along +x; a slope up in -x of more than 45 degrees then turns under.
  const mat3d shear{{1, 0, 1}, {0, 1, 0}, {0, 0, 1}};
  NoiseLayer layer;
  layer.custom = VolumeFunction([](vec3<double> p) { return -3 * p.x; }, 0.5);
  SurfacePoint p{};
  p.normal = {0, 0, 1};
  const vec3d below = normalize_or_zero(transform_normal(shear, vec3d{3, 0, 1}));
  ASSERT_LT(below.z, 0);
  EXPECT_LT(max_abs(composed_normal(layer, p, shear) - below), 1e-12);
}

TEST(NoiseLayer, WorldSpaceIgnoresTheObjectsScale) {
  Random random(seed);
  NoiseLayer layer = noise_layer(NoiseKind::fractal_sum, 2, 0.5);
  layer.space = stack::Space::world;
  const Program program = Lab().compile({layer});
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const mat3d r = random.rotation();
    const double s = random.magnitude(0.1, 10);
    const mat3d m{s * r.x, s * r.y, s * r.z};
    const vec3d shift = random.vector3();
    Placement placement = place({{m.x.x, m.x.y, m.x.z, shift.x},
                                 {m.y.x, m.y.y, m.y.z, shift.y},
                                 {m.z.x, m.z.y, m.z.z, shift.z},
                                 {0, 0, 0, 1}},
                                {0.3, 0.4, 0.5});
    const auto got = compose(program, fragment_at(p, m), BackFaces::same, placement);
    SurfacePoint in_world = p;
    in_world.position = m * p.position + shift;
    in_world.normal = normalize_or_zero(transform_normal(m, p.normal));
    EXPECT_LT(max_abs(got.normal - composed_normal(layer, in_world)), 1e-12);
  }
}

TEST(NoiseLayer, SamplesTheUndisplacedPosition) {
  Random random(seed);
  const Program program = Lab().compile({noise_layer(NoiseKind::perlin, 3, 0.5)});
  raster::Fragment<double> f = test::random_fragment(random);
  const vec3d normal = composed(program, f).normal;
  f.position = f.position + vec3d{0.1, 0.2, 0.3};
  EXPECT_EQ(max_abs(composed(program, f).normal - normal), 0);
  f.object_position = f.object_position + vec3d{0.1, 0.2, 0.3};
  EXPECT_GT(max_abs(composed(program, f).normal - normal), 1e-3);
}

// --------------------------------------------------------------------------------- filter, methods

TEST(NoiseLayer, FadesWithTheLongerSideOfThePixelInTheFunctionsSpace) {
  Random random(seed);
  NoiseLayer object = noise_layer(NoiseKind::perlin, 2);
  NoiseLayer world = object;
  world.space = stack::Space::world;
  const mat3d ten{{10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  const auto bump = [&](const NoiseLayer& layer, double dp_dx, double dp_dy) {
    raster::Fragment<double> f = test::random_fragment(random);
    f.object_position = {0.13, 0.27, 0.41};
    f.normal = {0, 0, 1};
    f.dp_dx = {dp_dx, 0, 0};
    f.dp_dy = {0, dp_dy, 0};
    return length(composed(Lab().compile({layer}), f, BackFaces::same, ten).surfgrad);
  };
  // Three quarters of a cell: 0.375 units of the space.
  EXPECT_EQ(bump(object, 3.76, 0.1), 0);
  EXPECT_EQ(bump(object, 0.1, 3.76), 0);
  EXPECT_GT(bump(object, 3.7, 0.1), 0);
  EXPECT_EQ(bump(world, 0.376, 0.01), 0);
  EXPECT_EQ(bump(world, 0.01, 0.376), 0);
  EXPECT_GT(bump(world, 0.37, 0.01), 0);
  EXPECT_NEAR(bump(object, 2.5, 0.1) / bump(object, 0.1, 0.1), 0.5, 1e-12) << "half visible";
}

TEST(NoiseLayer, Perlin1985AddsTheWholeGradientToTheNormal) {
  Random random(seed);
  NoiseLayer layer = noise_layer(NoiseKind::perlin, 2, 0.15);
  layer.method = stack::NoiseMethod::perlin1985;
  NoiseLayer correct = layer;
  correct.method = stack::NoiseMethod::surface_gradient;
  double difference = 0;
  for (int i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const vec3d g = evaluate(layer.noise, p.position, 0.0).gradient;
    // The gradient is at most 2 * 3.75 long, so that n - 0.15 * g may turn over, but does not here.
    const vec3d expected = p.normal - 0.15 * g;
    ASSERT_GT(dot(expected, p.normal), 0);
    EXPECT_LT(max_abs(composed_normal(layer, p) - normalize_or_zero(expected)), 1e-12);
    difference =
        std::max(difference, degrees_between(composed_normal(layer, p), composed_normal(correct, p)));
  }
  EXPECT_GT(difference, 5) << "degrees: what figure 1 shows";
}

TEST(NoiseLayer, ALaterPassBendsTheNormalSoFar) {
  Random random(seed);
  const NoiseLayer first = noise_layer(NoiseKind::simplex, 1, 0.2);
  const NoiseLayer second = noise_layer(NoiseKind::perlin, 2, 0.3);
  const Program two = Lab().compile({first, stack::ResolveLayer{}, second});
  for (int i = 0; i < 100; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    SurfacePoint resolved = p;
    resolved.normal = composed_normal(first, p);
    EXPECT_LT(max_abs(composed(two, fragment_at(p)).normal - composed_normal(second, resolved)), 1e-12);
  }
}

// --------------------------------------------------------------------------------------- degenerate

TEST(NoiseLayer, WithoutATransformBackObjectSpaceIsFlatAndFlagged) {
  Random random(seed);
  const SurfacePoint p = random_point(Torus{}, random);
  NoiseLayer layer = noise_layer(NoiseKind::perlin, 2);
  const mat3d flattened{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
  raster::Fragment<double> f = fragment_at(p);
  const auto in_object = composed(Lab().compile({layer}), f, BackFaces::same, flattened);
  EXPECT_TRUE(in_object.degenerate);
  EXPECT_EQ(max_abs(in_object.surfgrad), 0);
  layer.space = stack::Space::world;
  const auto in_world = composed(Lab().compile({layer}), f, BackFaces::same, flattened);
  EXPECT_FALSE(in_world.degenerate);
  EXPECT_GT(max_abs(in_world.surfgrad), 0);
}

TEST(NoiseLayer, ACustomFunctionWithoutAGradientIsFlatAndFlagged) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  Random random(seed);
  NoiseLayer layer;
  layer.custom = VolumeFunction([](vec3<double>) { return Noise<double>{0, {1, nan, 0}}; });
  const auto c = composed(Lab().compile({layer}), test::random_fragment(random));
  EXPECT_TRUE(c.degenerate);
  EXPECT_LT(max_abs(c.surfgrad), 1e-15) << "the normal may round once more";
}

template <class T>
void expect_finite(const Program& program, const vec3<T>& normal, T position, T dp,
                   const Placement& placement) {
  raster::Fragment<T> f{};
  f.object_position = f.position = {position, position, T(0.3)};
  f.normal = normal;
  f.dp_dx = {dp, 0, 0};
  f.dp_dy = {0, dp, 0};
  f.front_facing = true;
  const auto c = compose(program, f, BackFaces::same, placement);
  const double size = length(vec3<double>{c.normal.x, c.normal.y, c.normal.z});
  EXPECT_TRUE(size == 0 || std::abs(size - 1) < 1e-6) << size;
  EXPECT_FALSE(std::isnan(max_abs(c.surfgrad)));
}

TEST(NoiseLayer, NoNumberOfADocumentAndNoFragmentMakesNaN) {
  const double sizes[] = {1e-12, 1, 1e12};
  for (const NoiseKind kind : {NoiseKind::perlin, NoiseKind::worley, NoiseKind::ridged})
    for (const double frequency : {5e-324, 1.0, 1e12})
      for (const double power : {1e-9, 1.0, 1e12})
        for (const double scale : {0.0, 1.0, -1e12})
          for (const auto method : {stack::NoiseMethod::surface_gradient, stack::NoiseMethod::perlin1985})
            for (const double object : sizes) {
              NoiseLayer layer = noise_layer(kind, frequency, scale);
              layer.noise.power = power;
              layer.method = method;
              const Program program = Lab().compile({layer, stack::ResolveLayer{}, layer});
              const Placement placement = placed({{object, 0, 0}, {0, 1, 0}, {0, 0, 1 / object}});
              for (const double position : {0.0, 0.7, -1e12})
                for (const double dp : {0.0, 1e-12, 1e12})
                  for (const double normal : {0.0, 1.0}) {
                    SCOPED_TRACE(testing::Message()
                                 << "function " << static_cast<int>(kind) << ", frequency " << frequency
                                 << ", power " << power << ", scale " << scale << ", method "
                                 << static_cast<int>(method) << ", object " << object << ", position "
                                 << position << ", dp " << dp << ", normal " << normal);
                    const vec3d n{0.6 * normal, 0, 0.8 * normal};
                    expect_finite<double>(program, n, position, dp, placement);
                    expect_finite<float>(program, {static_cast<float>(n.x), 0, static_cast<float>(n.z)},
                                         static_cast<float>(position), static_cast<float>(dp), placement);
                  }
            }
}

} // namespace
} // namespace surfgrad::engine
