// Decals against what they stand for: heights over an analytic surface, and normals around a centre.

#include "decal_lab.hpp"
#include "support/surfaces.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using test::Random;
using Vector = vec3<double>;
using stack::DecalShape;

constexpr double rise_s = 0.75, rise_t = -0.5; // of the ramp, over the whole image; exact in float

/// A plane of heights: its derivative is known exactly, away from the borders.
image::Image ramp() {
  image::Image result = image::make_image(16, 16, 1, image::Depth::float32);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      result.at(x, y, 0) = static_cast<float>(rise_s * (x + 0.5) / 16 + rise_t * (y + 0.5) / 16);
  return result;
}

struct Ramp {
  DecalShape shape;
  test::DecalAxes axes;
  Vector size{1.5, 1.2, 2};
  double angle_deg = 70, depth = 2, length = 0.6;
  double height = 3;
  vec2<double> tile{0.5, -0.5};
  double rotate_deg = 30;
  vec2<double> offset{};

  /// The image's own coordinate at a point of space, by the page of the format.
  template <class T>
  [[nodiscard]] vec2<T> coordinate(vec3<T> p) const {
    const auto lift = surfgrad::test::Plane::lift<T>;
    const vec3<T> q = p - lift(axes.origin);
    T x = dot(q, lift(axes.s));
    const T y = dot(q, lift(axes.t));
    const T into = -dot(q, lift(axes.outward));
    vec2<T> st;
    if (shape == DecalShape::box) {
      st = {T(0.5) + x / T(size.x), T(0.5) + y / T(size.y)};
    } else {
      if (shape == DecalShape::wedge) {
        const T half(0.5 * length);
        x = half < x ? x - half : x < -half ? x + half : T(0.0);
      }
      const T width = T(2 * std::tan(angle_deg * std::numbers::pi / 360)) * into;
      st = {T(0.5) + x / width, T(0.5) + y / width};
    }
    const double turn = rotate_deg * std::numbers::pi / 180;
    const T c(std::cos(turn)), s(std::sin(turn));
    const vec2<T> tiled{T(tile.x) * st.x, T(tile.y) * st.y};
    return {c * tiled.x - s * tiled.y + T(offset.x), s * tiled.x + c * tiled.y + T(offset.y)};
  }
  template <class T>
  [[nodiscard]] T height_at(vec3<T> p) const {
    const vec2<T> st = coordinate(p);
    return T(height) * (T(rise_s) * st.x + T(rise_t) * st.y);
  }
  [[nodiscard]] bool interior(Vector p) const {
    const vec2<double> st = coordinate(p);
    return std::abs(st.x - 0.5) < 0.4 && std::abs(st.y - 0.5) < 0.4;
  }
  [[nodiscard]] stack::DecalLayer layer(stack::Space space) const {
    stack::DecalLayer l = test::decal_layer("ramp", shape);
    l.map.content = stack::Content::height;
    l.map.height = height;
    l.map.tile = tile;
    l.map.rotate_deg = rotate_deg;
    l.map.offset = offset;
    l.map.filter = stack::Filter::bilinear;
    l.space = space;
    l.falloff = 0;
    l.instances[0].transform = axes.transform();
    l.instances[0].size = size;
    l.instances[0].angle_deg = angle_deg;
    l.instances[0].depth = depth;
    l.instances[0].length = length;
    return l;
  }
};

Ramp random_ramp(Random& random, DecalShape shape, Vector near) {
  Ramp ramp{.shape = shape, .axes = test::random_axes(random, near)};
  // The middle of the image stays the middle.
  ramp.offset =
      vec2<double>{0.5, 0.5} -
      (Ramp{.shape = DecalShape::box, .axes = ramp.axes, .tile = ramp.tile, .rotate_deg = ramp.rotate_deg}
           .coordinate(ramp.axes.origin));
  const double away = shape == DecalShape::box ? 0.0 : random.uniform(0.3, 1.5);
  ramp.axes.origin = near + away * ramp.axes.outward + 0.2 * random.vector3();
  return ramp;
}

raster::Fragment<double> seen(const surfgrad::test::SurfacePoint& p, const mat3<double>& m, Random& random) {
  const auto camera = random_camera(p, random).fragment(p);
  raster::Fragment<double> f{};
  f.position = m * p.position;
  f.object_position = p.position;
  f.normal = random.uniform(0.5, 1) * normalize_or_zero(transform_normal(m, p.normal));
  f.dp_dx = m * camera.dp_dx;
  f.dp_dy = m * camera.dp_dy;
  f.front_facing = true;
  return f;
}

/// Blinn's normal of the surface displaced in the space of its positions, then transformed.
Vector blinn(const surfgrad::test::SurfacePoint& p, vec2<double> dh, const mat3<double>& m) {
  const Vector raised = cross(p.dp_du + dh.x * p.normal, p.dp_dv + dh.y * p.normal);
  const double side = dot(raised, p.normal) < 0 ? -1 : 1;
  return normalize_or_zero(transform_normal(m, side * raised));
}

template <class Surface>
void expect_blinn(const Surface& surface, DecalShape shape, stack::Space space, const mat3<double>& m,
                  Random& random, const std::string& name) {
  surfgrad::test::Worst worst(name);
  double steepest = 0;
  for (long used = 0; used < 150;) {
    const auto p = random_point(surface, random);
    const Ramp ramp = random_ramp(random, shape, p.position);
    if (!ramp.interior(p.position)) continue;
    test::Lab lab;
    lab.add("ramp", surfgrad::engine::ramp());
    const auto c = test::composed(lab.compile({ramp.layer(space)}), seen(p, m, random), BackFaces::same, m);
    const bool outside = max_abs(c.surfgrad) < 1e-14; // beyond the shape's sides or end: rounding
    if (outside) continue;
    const vec2<double> dh = surfgrad::test::gradient_of(
        [&](auto uv) { return ramp.height_at(surface.position(uv.x, uv.y)); }, p.uv);
    const Vector expected = blinn(p, dh, m);
    worst.add(c.normal, expected, 1e-9, used);
    steepest = std::max(steepest, length(c.surfgrad));
    ++used;
  }
  EXPECT_GT(steepest, 0.5) << "no bump to speak of";
}

TEST(Decals, OfHeightsGiveBlinnsNormalOnSphereAndTorus) {
  constexpr std::uint64_t seed = 311;
  SCOPED_TRACE(seed);
  Random random(seed);
  const mat3<double> identity = test::identity;
  const mat3<double> odd{{0.5, 0.2, 0}, {0, -2, 0.3}, {0.1, 0, 1}}; // uneven, sheared and mirrored
  for (const DecalShape shape : {DecalShape::box, DecalShape::cone, DecalShape::wedge})
    for (const bool object : {false, true}) {
      const std::string name =
          std::string(stack::words_of<DecalShape>[static_cast<std::size_t>(shape)].text) +
          (object ? " in object space" : "");
      const auto space = object ? stack::Space::object : stack::Space::world;
      expect_blinn(surfgrad::test::Sphere{}, shape, space, object ? odd : identity, random,
                   name + " on a sphere");
      expect_blinn(surfgrad::test::Torus{.ring = 2, .tube = 1}, shape, space, object ? odd : identity, random,
                   name + " on a torus");
    }
}

/// Slopes are stored in float, once.
constexpr double stored = 2 * std::numeric_limits<float>::epsilon();

TEST(Decals, OfSlopesAddThemAlongTheirAxes) {
  constexpr std::uint64_t seed = 312;
  SCOPED_TRACE(seed);
  Random random(seed);
  surfgrad::test::Worst worst("slopes of box, cone, cone without perspective");
  const vec2<double> slope{0.5, -0.25};
  test::Lab lab;
  lab.add("slope", test::slope_image(slope));
  double perspective = 0;
  for (long k = 0; k < 300; ++k) {
    const test::DecalAxes axes = test::random_axes(random, random.vector3());
    const double away = random.uniform(0.5, 1.5);
    const vec2<double> across = 0.4 * random.vector2();
    const Vector p = axes.origin + across.x * axes.s + across.y * axes.t - away * axes.outward;
    const Vector n = random.unit_vector();
    const auto f = test::surface_at(p, n);
    const auto compose_with = [&](DecalShape shape, stack::ConeGradient gradient) {
      stack::DecalLayer layer = test::decal_layer("slope", shape);
      layer.falloff = 0;
      layer.gradient = gradient;
      layer.instances[0].transform = axes.transform();
      layer.instances[0].size = {4, 4, 4};
      layer.instances[0].angle_deg = 120;
      layer.instances[0].depth = 2;
      return test::composed(lab.compile({layer}), f).normal;
    };
    const auto expected = [&](Vector volume) { return normalize_or_zero(n - (volume - dot(volume, n) * n)); };
    const Vector along = slope.x * axes.s + slope.y * axes.t;
    worst.add(compose_with(DecalShape::box, stack::ConeGradient::exact), expected(along), 2 * stored, k);
    worst.add(compose_with(DecalShape::cone, stack::ConeGradient::scale_free), expected(along), 2 * stored,
              k);
    // The gradient of (x/z, y/z), times z: what is off the axis also changes along it.
    const Vector exact = along + (dot(slope, across) / away) * axes.outward;
    worst.add(compose_with(DecalShape::cone, stack::ConeGradient::exact), expected(exact), 2 * stored, k);
    perspective = std::max(perspective, max_abs(expected(exact) - expected(along)));
  }
  EXPECT_GT(perspective, 0.05);
}

/// Six faces, a normal each; or the same in all.
image::Image cube_of(const std::array<Vector, 6>& normals) {
  image::Image result = image::make_image(6 * 4, 4, 3, image::Depth::float32);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 24; ++x) {
      const Vector code = 0.5 * normals[static_cast<std::size_t>(x / 4)] + Vector{0.5, 0.5, 0.5};
      result.at(x, y, 0) = static_cast<float>(code.x);
      result.at(x, y, 1) = static_cast<float>(code.y);
      result.at(x, y, 2) = static_cast<float>(code.z);
    }
  return result;
}

Vector in_space(const test::DecalAxes& axes, Vector v) {
  return v.x * axes.s + v.y * axes.t + v.z * axes.outward;
}

TEST(Decals, OfACubeMapGiveItsNormalsToASphereAroundTheirCentre) {
  constexpr std::uint64_t seed = 313;
  SCOPED_TRACE(seed);
  Random random(seed);
  surfgrad::test::Worst worst("cube map's normal on a concentric sphere");
  for (const bool mirrored : {false, true})
    for (long k = 0; k < 300; ++k) {
      test::DecalAxes axes = test::random_axes(random, random.vector3());
      if (mirrored) axes.t = -axes.t;
      const Vector local = random.unit_vector();
      const Vector normal = normalize_or_zero(local + 0.6 * random.unit_vector());
      test::Lab lab;
      lab.add("cube", cube_of({normal, normal, normal, normal, normal, normal}));
      stack::DecalLayer layer = test::decal_layer("cube", DecalShape::sphere);
      layer.falloff = 0;
      layer.instances[0].transform = axes.transform();
      layer.instances[0].radius = 2;
      const Vector n = in_space(axes, local);
      const auto c = test::composed(lab.compile({layer}), test::surface_at(axes.origin + n, n));
      worst.add(c.normal, in_space(axes, normal), 4 * stored, k);
      EXPECT_FALSE(c.degenerate);
    }
}

TEST(Decals, OfACubeMapHaveItsFacesAlongTheirAxes) {
  const std::array<Vector, 6> directions{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  std::array<Vector, 6> normals{};
  for (std::size_t i = 0; i < 6; ++i)
    normals[i] = normalize_or_zero(directions[i] + 0.1 * static_cast<double>(i + 1) * Vector{0.3, -0.5, 0.7});
  Random random(314);
  const test::DecalAxes axes = test::random_axes(random, {1, 2, 3});
  for (const bool six_files : {false, true}) {
    test::Lab lab;
    lab.add("cube", cube_of(normals));
    stack::DecalLayer layer = test::decal_layer("cube", DecalShape::sphere);
    if (six_files) {
      layer.files.clear();
      for (std::size_t i = 0; i < 6; ++i) {
        const std::string name = "face" + std::to_string(i);
        lab.add(name, surfgrad::test::constant_image(4, 4, 0.5 * normals[i] + Vector{0.5, 0.5, 0.5}));
        layer.files.push_back({.path = name});
      }
    }
    layer.instances[0].transform = axes.transform();
    for (std::size_t i = 0; i < 6; ++i) {
      const Vector n = in_space(axes, directions[i]);
      const auto c = test::composed(lab.compile({layer}), test::surface_at(axes.origin + 0.1 * n, n));
      EXPECT_LT(max_abs(c.normal - in_space(axes, normals[i])), 4 * stored) << "face " << i;
    }
  }
}

TEST(Decals, DrawnOutAsACapsuleBendNothingAlongTheirAxis) {
  Random random(315);
  surfgrad::test::Worst worst("capsule's cylinder");
  const Vector normal = normalize_or_zero(Vector{0.4, 0.3, 0.8});
  test::Lab lab;
  lab.add("cube", cube_of({normal, normal, normal, normal, normal, normal}));
  for (long k = 0; k < 200; ++k) {
    const test::DecalAxes axes = test::random_axes(random, random.vector3());
    stack::DecalLayer layer = test::decal_layer("cube", DecalShape::capsule);
    layer.falloff = 0;
    layer.instances[0].transform = axes.transform();
    layer.instances[0].length = 2;
    const double angle = random.uniform(-1, 1);
    const Vector n = std::sin(angle) * axes.t + std::cos(angle) * axes.outward;
    const Vector p = axes.origin + random.uniform(-0.9, 0.9) * axes.s + 0.3 * n;
    const Vector v = in_space(axes, normal);
    const Vector g = from_perturbed_normal(n, v);
    worst.add(test::composed(lab.compile({layer}), test::surface_at(p, n)).normal,
              normalize_or_zero(n - (g - dot(g, axes.s) * axes.s)), 4 * stored, k);
    // Beyond the segment's ends it is a sphere.
    const Vector end = axes.origin + axes.s;
    const Vector out = normalize_or_zero(n + 0.5 * axes.s);
    worst.add(test::composed(lab.compile({layer}), test::surface_at(end + 0.3 * out, out)).normal, v,
              4 * stored, k);
  }
}

} // namespace
} // namespace surfgrad::engine
