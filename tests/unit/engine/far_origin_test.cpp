// Functions of world space are as exact in float far from the world's origin as near it.

#include "lab.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Worst;
using test::Lab;
using test::Random;

constexpr std::uint64_t seed = 1701;

vec3<float> narrow(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
vec3<double> widen(vec3<float> v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// What functions of space read of a fragment.
template <class T>
raster::Fragment<T> fragment_of(vec3<T> object_position, vec3<T> normal, vec3<T> dp_dx, vec3<T> dp_dy) {
  raster::Fragment<T> f{};
  f.object_position = object_position;
  f.normal = normal;
  f.dp_dx = dp_dx;
  f.dp_dy = dp_dy;
  f.front_facing = true;
  return f;
}

double degrees_between(vec3<double> a, vec3<double> b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

struct FarFromTheOrigin : ::testing::Test {
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  Lab lab{};
  void SetUp() override {
    Random random(seed);
    lab.add("n", surfgrad::test::random_normal_map(random, 16, 8, 0.5));
    lab.add("h", surfgrad::test::random_image(random, 16, 16, 1));
  }

  /// The largest angle in degrees between what float and double make of a layer about a place of the world.
  double worst(const stack::Layer& layer, double far) const {
    const Program program = lab.compile({layer});
    Random random(seed + 1);
    double most = 0;
    for (int place = 0; place < 20; ++place) {
      const mat3<double> r = random.rotation();
      const mat3<double> m{1.5 * r.x, 1.5 * r.y, 1.5 * r.z};
      const vec3<double> at = far * random.unit_vector();
      const mat4<double> moved{{m.x.x, m.x.y, m.x.z, at.x},
                               {m.y.x, m.y.y, m.y.z, at.y},
                               {m.z.x, m.z.y, m.z.z, at.z},
                               {0, 0, 0, 1}};
      const Placement placement = engine::place(moved, at + random.vector3());
      for (int k = 0; k < 50; ++k) {
        const mat3<double> s = random.rotation();
        const auto f =
            fragment_of(narrow(random.vector3()), narrow(s.z), narrow(1e-3 * s.x), narrow(1e-3 * s.y));
        const auto d = fragment_of(widen(f.object_position), widen(f.normal), widen(f.dp_dx), widen(f.dp_dy));
        const auto got = compose(program, f, BackFaces::same, placement);
        const auto expected = compose(program, d, BackFaces::same, placement);
        most = std::max(most, degrees_between(widen(got.normal), expected.normal));
      }
    }
    return most;
  }

  void expect_exact(const char* what, const stack::Layer& layer) const {
    const double near = worst(layer, 0);
    EXPECT_GT(near, 0) << what << ": float and double never differ";
    for (const double far : {1e3, 1e5, 1e6}) {
      const double angle = worst(layer, far);
      std::printf("  %s, %g away: %.2g degrees, %.2g at the origin\n", what, far, angle, near);
      EXPECT_LT(angle, 0.01) << what << ", " << far << " away";
    }
  }
};

TEST_F(FarFromTheOrigin, NoiseIsAsExactAsNearIt) {
  for (const auto& function : stack::words_of<stack::NoiseKind>)
    for (const auto& basis : stack::words_of<stack::NoiseBasis>) {
      stack::NoiseLayer layer;
      layer.space = stack::Space::world;
      layer.common.scale = 0.1;
      layer.noise.function = function.value;
      layer.noise.basis = basis.value;
      layer.noise.frequency = 3.1;
      layer.noise.lacunarity = 2.17;
      layer.noise.octaves = 4;
      layer.noise.offset = {0.3, -1234.5, 0.7};
      expect_exact(std::string(function.text).append(" ").append(basis.text).c_str(), layer);
    }
}

TEST_F(FarFromTheOrigin, AProgramsOwnFunctionIsGivenDoubles) {
  stack::NoiseLayer layer;
  layer.space = stack::Space::world;
  layer.common.scale = 0.3;
  layer.custom = stack::VolumeFunction([](vec3<double> p) {
    return Noise<double>{std::sin(p.x), {std::cos(p.x), std::cos(p.y), std::cos(p.z)}};
  });
  expect_exact("own function", layer);
}

TEST_F(FarFromTheOrigin, ProjectionsAreAsExactAsNearIt) {
  struct Lie {
    const char* name;
    stack::Wrap wrap;
    stack::Tiling tiling;
  };
  for (const Lie& lie : {Lie{"planar, repeated", stack::Wrap::repeat, stack::Tiling::plain},
                         Lie{"planar, mirrored", stack::Wrap::mirror, stack::Tiling::plain},
                         Lie{"planar, hex tiles", stack::Wrap::repeat, stack::Tiling::hex}}) {
    const auto lay = [&](stack::Tiled& use) {
      use.tile = {0.7, -1.3};
      use.offset = {0.25, 17.1};
      use.rotate_deg = 25;
      use.wrap = lie.wrap;
      use.tiling = lie.tiling;
    };
    stack::PlanarLayer planar = test::planar_layer("n", PlaneAxis::y);
    planar.space = stack::Space::world;
    lay(planar.map);
    expect_exact(lie.name, planar);
    stack::PlanarLayer heights = test::planar_layer("h", PlaneAxis::x, stack::Content::height);
    heights.space = stack::Space::world;
    heights.map.height = 0.1;
    lay(heights.map);
    expect_exact("heights", heights);
    for (const auto content : {stack::TriplanarContent::normal, stack::TriplanarContent::object_normal}) {
      stack::TriplanarLayer triplanar = test::triplanar_layer({"n"}, content);
      triplanar.space = stack::Space::world;
      lay(triplanar.map);
      expect_exact("triplanar", triplanar);
    }
  }
}

TEST_F(FarFromTheOrigin, ProjectionsLieWhereTheyAlwaysDid) {
  // Doubles tell where a map lies well enough 1e3 away: by 1e-13, which the slopes' slopes multiply.
  Worst worst("projection about an origin");
  long k = 0;
  const auto compare = [&](auto layer) {
    layer.space = stack::Space::world;
    const Program world = lab.compile({layer});
    layer.space = stack::Space::object;
    const Program object = lab.compile({layer});
    Random random(seed + 4);
    for (int i = 0; i < 300; ++i, ++k) {
      const vec3<double> far = (i % 3 == 0 ? 2 : 1e3) * random.vector3();
      const vec3<double> p = random.vector3();
      const mat3<double> r = random.rotation();
      const Placement moved =
          engine::place({{1, 0, 0, far.x}, {0, 1, 0, far.y}, {0, 0, 1, far.z}, {0, 0, 0, 1}}, far);
      const vec3<double> got =
          compose(world, fragment_of(p, r.z, 1e-2 * r.x, 1e-2 * r.y), BackFaces::same, moved).normal;
      const vec3<double> expected = compose(object, fragment_of(far + p, r.z, 1e-2 * r.x, 1e-2 * r.y),
                                            BackFaces::same, test::placed(test::identity))
                                        .normal;
      worst.add(got, expected, 1e-9, k);
    }
  };
  for (const auto& wrap : stack::words_of<stack::Wrap>)
    for (const auto& tiling : stack::words_of<stack::Tiling>) {
      if (tiling.value == stack::Tiling::hex && wrap.value != stack::Wrap::repeat) continue;
      const auto lay = [&](stack::Tiled& use) {
        use.tile = {0.7, -1.3};
        use.offset = {0.25, 17.1};
        use.rotate_deg = 25;
        use.wrap = wrap.value;
        use.tiling = tiling.value;
      };
      stack::PlanarLayer planar = test::planar_layer("n", PlaneAxis::y);
      lay(planar.map);
      compare(planar);
      stack::PlanarLayer heights = test::planar_layer("h", PlaneAxis::x, stack::Content::height);
      lay(heights.map);
      compare(heights);
      for (const auto content : {stack::TriplanarContent::normal, stack::TriplanarContent::object_normal}) {
        stack::TriplanarLayer triplanar = test::triplanar_layer({"n"}, content);
        triplanar.convention.planes = TriplanarPlanes::golubev;
        lay(triplanar.map);
        compare(triplanar);
      }
    }
}

TEST_F(FarFromTheOrigin, AClampedMapLiesWhereItsOffsetPutsIt) {
  // Its few periods around the object, 1e6 away.
  stack::PlanarLayer layer = test::planar_layer("n", PlaneAxis::z);
  layer.space = stack::Space::world;
  layer.map.wrap = stack::Wrap::clamp;
  layer.map.tile = {0.25, 0.25};
  const Placement far =
      engine::place({{1, 0, 0, 1e6}, {0, 1, 0, 2e6}, {0, 0, 1, 0}, {0, 0, 0, 1}}, {1e6, 2e6, 0});
  const Placement here = engine::place({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, {0, 0, 0});
  layer.map.offset = {0.5, 0.5};
  const Program at_origin = lab.compile({layer});
  layer.map.offset = {0.5 - 0.25e6, 0.5 - 0.5e6};
  const Program away = lab.compile({layer});
  Random random(seed + 2);
  for (int k = 0; k < 200; ++k) {
    const auto f = fragment_of<float>(narrow(random.vector3(-3, 3)), {0, 0, 1}, {1e-3f, 0, 0}, {0, 1e-3f, 0});
    const vec3<float> a = compose(away, f, BackFaces::same, far).normal;
    const vec3<float> b = compose(at_origin, f, BackFaces::same, here).normal;
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.y, b.y);
  }
}

TEST(NoiseOrigins, MoveTheSamplingPoint) {
  SCOPED_TRACE(seed);
  Random random(seed + 3);
  // Doubles 1e4 cells and 2.17^5 times that away round by 1e-10; the gradient multiplies that by up to 47.
  Worst worst("noise about an origin");
  long k = 0;
  for (const auto& function : stack::words_of<stack::NoiseKind>)
    for (const auto& basis : stack::words_of<stack::NoiseBasis>)
      for (const double lacunarity : {2.0, 2.17})
        for (int i = 0; i < 200; ++i, ++k) {
          stack::NoiseFunction noise;
          noise.function = function.value;
          noise.basis = basis.value;
          noise.lacunarity = lacunarity;
          noise.octaves = 6;
          noise.frequency = random.uniform(0.5, 2);
          // On whole cells too, and below 0.
          vec3<double> origin = 1e4 * random.vector3();
          if (i % 2 == 0) origin = {std::floor(origin.x), std::floor(origin.y), std::floor(origin.z)};
          const vec3<double> p = random.vector3();
          const Noise<double> moved = evaluate(noise, p, 0.0, origin);
          const Noise<double> whole = evaluate(noise, origin + p, 0.0);
          worst.add(moved.value, whole.value, 1e-7, k);
          worst.add(moved.gradient, whole.gradient, 1e-6, k);
        }
}

TEST(NoiseOrigins, OfNoCellOrNoNumberGiveNumbers) {
  for (const double far :
       {1e18, 1e40, 1e308, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    for (const auto& basis : stack::words_of<stack::NoiseBasis>) {
      stack::NoiseFunction noise;
      noise.function = stack::NoiseKind::fractal_sum;
      noise.basis = basis.value;
      const Noise<float> n = evaluate(noise, vec3<float>{0.1f, 0.2f, 0.3f}, 0.0f, {far, -far, 1});
      EXPECT_EQ(n.value, n.value);
      EXPECT_LT(max_abs(n.gradient), 1e3f);
    }
}

} // namespace
} // namespace surfgrad::engine
