/// Volume functions and the parallax march on a pack: the same bits as one lane at a time.

#include "simd/emulated_lanes.hpp"
#include "support/random.hpp"
#include <array>
#include <bit>
#include <gtest/gtest.h>
#include <surfgrad/decal.hpp>
#include <surfgrad/fractal.hpp>
#include <surfgrad/hex_tiles.hpp>
#include <surfgrad/noise.hpp>
#include <surfgrad/parallax_march.hpp>
#include <surfgrad/worley.hpp>

namespace surfgrad::test {
namespace {

using simd::emulated_width;
using simd::EmulatedFloat;

template <class T>
std::array<T, 4> flat(const Noise<T>& n) {
  return {n.value, n.gradient.x, n.gradient.y, n.gradient.z};
}
template <class T>
std::array<T, 15> flat(const DecalProjection<T>& d) {
  return {d.texture_coordinate.x,
          d.texture_coordinate.y,
          d.grad_s.x,
          d.grad_s.y,
          d.grad_s.z,
          d.grad_t.x,
          d.grad_t.y,
          d.grad_t.z,
          d.axis_s.x,
          d.axis_s.y,
          d.axis_s.z,
          d.axis_t.x,
          d.axis_t.y,
          d.axis_t.z,
          d.falloff};
}
template <class T>
std::array<T, 10> flat(const DecalDirection<T>& d) {
  return {d.direction.x, d.direction.y,  d.direction.z,  d.lookup.x,     d.lookup.y,
          d.lookup.z,    d.unchanging.x, d.unchanging.y, d.unchanging.z, d.falloff};
}
template <class T>
std::array<T, 15> flat(const HexTiles<T>& h) {
  return {h.st[0].x,       h.st[0].y,       h.st[1].x,       h.st[1].y,       h.st[2].x,
          h.st[2].y,       h.weight[0],     h.weight[1],     h.weight[2],     h.rotation[0].x,
          h.rotation[0].y, h.rotation[1].x, h.rotation[1].y, h.rotation[2].x, h.rotation[2].y};
}

/// Compares `call` of a pack of points with `call` of each.
template <class Call>
void expect_equal_lanes(const char* name, double extent, Call call) {
  constexpr std::uint64_t seed = 71;
  Random random(seed);
  for (int round = 0; round < 400; ++round) {
    std::array<vec3<float>, emulated_width> points;
    vec3<EmulatedFloat> together;
    for (int lane = 0; lane < emulated_width; ++lane) {
      const vec3<double> p = random.vector3(-extent, extent);
      points[lane] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      together.x.lane[lane] = points[lane].x;
      together.y.lane[lane] = points[lane].y;
      together.z.lane[lane] = points[lane].z;
    }
    const auto packed = call(together);
    for (int lane = 0; lane < emulated_width; ++lane) {
      const auto alone = call(points[lane]);
      for (std::size_t k = 0; k < alone.size(); ++k)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(packed[k].lane[lane]), std::bit_cast<std::uint32_t>(alone[k]))
            << name << ", seed " << seed << ", round " << round << ", lane " << lane << ", component " << k;
    }
  }
}

TEST(LanesVolume, NoiseEqualsFloatBitForBit) {
  expect_equal_lanes("perlin", 300, [](auto p) { return flat(perlin(p)); });
  expect_equal_lanes("simplex", 300, [](auto p) { return flat(simplex(p)); });
  for (const WorleyKind kind : {WorleyKind::f1, WorleyKind::f2_minus_f1})
    expect_equal_lanes("worley", 300, [kind](auto p) { return flat(worley(p, kind)); });
  // Lanes of different footprints: octaves fade in some and not in others.
  const auto width = [](auto p) { return abs(p.x) * constant<decltype(p.x)>(0.1); };
  expect_equal_lanes("fractal_sum", 5, [&](auto p) { return flat(fractal_sum(p, {}, width(p))); });
  expect_equal_lanes("turbulence", 5, [&](auto p) { return flat(turbulence(p, {}, width(p))); });
  expect_equal_lanes("ridged", 5, [&](auto p) { return flat(ridged(p, {}, width(p))); });
  expect_equal_lanes("power", 5, [](auto p) { return flat(power(turbulence(p), 3)); });
}

TEST(LanesVolume, DecalsEqualFloatBitForBit) {
  const auto frame = [](auto p) {
    using T = decltype(p.x);
    const auto c = [](double v) { return constant<T>(v); };
    return DecalFrame<T>{
        {c(0.1), c(0.2), c(-0.3)}, {c(0.8), c(0.6), c(0)}, {c(-0.6), c(0.8), c(0)}, {c(0), c(0), c(1)}};
  };
  expect_equal_lanes("box", 1.5, [&](auto p) {
    using T = decltype(p.x);
    return flat(box_decal(frame(p), p, {T(1.0f), T(0.5f), T(0.8f)}, T(0.25f)));
  });
  expect_equal_lanes("cone", 1.5, [&](auto p) {
    using T = decltype(p.x);
    return flat(cone_decal(frame(p), p, T(0.7f), T(1.5f), T(0.25f)));
  });
  expect_equal_lanes("wedge", 1.5, [&](auto p) {
    using T = decltype(p.x);
    return flat(wedge_decal(frame(p), p, T(0.5f), T(0.7f), T(1.5f), T(0.25f), ConeGradient::scale_free));
  });
  expect_equal_lanes("sphere", 1.5, [&](auto p) {
    using T = decltype(p.x);
    return flat(sphere_decal(frame(p), p, T(1.2f), T(0.25f)));
  });
  expect_equal_lanes("capsule", 1.5, [&](auto p) {
    using T = decltype(p.x);
    return flat(capsule_decal(frame(p), p, T(0.5f), T(0.9f), T(0.25f)));
  });
}

TEST(LanesVolume, HexTilesEqualFloatBitForBit) {
  for (const double extent : {20.0, 1e12}) { // triangles of both kinds; beyond the lattice
    expect_equal_lanes("hex_tiles", extent, [](auto p) {
      using T = decltype(p.x);
      return flat(hex_tiles(vec2<T>{p.x, p.y}, 0.8f));
    });
    expect_equal_lanes("hex_derivative", extent, [](auto p) {
      using T = decltype(p.x);
      const HexTiles<T> tiles = hex_tiles(vec2<T>{p.x, p.y});
      const vec2<T> deriv[3] = {{p.z, p.x}, {p.y, p.z}, {p.z - p.x, p.x * p.y}};
      const vec3<T> weights = hex_weights(tiles, deriv, 5, 2);
      const vec2<T> d = hex_derivative(tiles, weights, deriv);
      return std::array{weights.x, weights.y, weights.z, d.x, d.y};
    });
  }
}

TEST(LanesVolume, MarchEqualsFloatBitForBit) { // lanes meet the map after different numbers of steps
  expect_equal_lanes("march_parallax", 1, [](auto p) {
    using T = decltype(p.x);
    const auto height_at = [](vec2<T> uv, T, mask_t<T>) {
      const T s = uv.x - floor(uv.x) - constant<T>(0.5);
      const T t = uv.y - floor(uv.y) - constant<T>(0.5);
      return constant<T>(0.9) - (s * s + t * t);
    };
    const ParallaxHit<T> hit = march_parallax(height_at, vec2<T>{p.x, p.y}, vec2<T>{p.z, p.x}, 24);
    return std::array{hit.texture_coordinate.x, hit.texture_coordinate.y, hit.height};
  });
}

} // namespace
} // namespace surfgrad::test
