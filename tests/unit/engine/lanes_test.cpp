// A pack of fragments composes as each of its lanes would alone, bit for bit.

#include "lab.hpp"
#include "simd/emulated_lanes.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace surfgrad::engine {
namespace {

using simd::emulated_width;
using simd::EmulatedFloat;

vec3<float> narrow(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
vec2<float> narrow(vec2<double> v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }

raster::Fragment<float> narrow(const raster::Fragment<double>& f) {
  raster::Fragment<float> r{};
  r.raster = narrow(f.raster);
  r.position = narrow(f.position);
  r.object_position = narrow(f.object_position);
  r.to_viewer = narrow(f.to_viewer);
  r.normal = narrow(f.normal);
  r.normal_is_absent = f.normal_is_absent;
  r.dp_dx = narrow(f.dp_dx);
  r.dp_dy = narrow(f.dp_dy);
  r.dn_dx = narrow(f.dn_dx);
  r.dn_dy = narrow(f.dn_dy);
  r.front_facing = f.front_facing;
  for (std::size_t s = 0; s < 2; ++s)
    r.uvs[s] = {narrow(f.uvs[s].st),
                narrow(f.uvs[s].dst_dx),
                narrow(f.uvs[s].dst_dy),
                narrow(f.uvs[s].footprint_dx),
                narrow(f.uvs[s].footprint_dy),
                narrow(f.uvs[s].tangent),
                static_cast<float>(f.uvs[s].sign)};
  return r;
}

void put(vec3<EmulatedFloat>& pack, int lane, vec3<float> v) {
  pack.x.lane[lane] = v.x;
  pack.y.lane[lane] = v.y;
  pack.z.lane[lane] = v.z;
}
void put(vec2<EmulatedFloat>& pack, int lane, vec2<float> v) {
  pack.x.lane[lane] = v.x;
  pack.y.lane[lane] = v.y;
}

void put(raster::Fragment<EmulatedFloat>& pack, int lane, const raster::Fragment<float>& f) {
  put(pack.raster, lane, f.raster);
  put(pack.position, lane, f.position);
  put(pack.object_position, lane, f.object_position);
  put(pack.to_viewer, lane, f.to_viewer);
  put(pack.normal, lane, f.normal);
  pack.normal_is_absent.lane[lane] = f.normal_is_absent;
  put(pack.dp_dx, lane, f.dp_dx);
  put(pack.dp_dy, lane, f.dp_dy);
  put(pack.dn_dx, lane, f.dn_dx);
  put(pack.dn_dy, lane, f.dn_dy);
  pack.front_facing.lane[lane] = f.front_facing;
  for (std::size_t s = 0; s < 2; ++s) {
    put(pack.uvs[s].st, lane, f.uvs[s].st);
    put(pack.uvs[s].dst_dx, lane, f.uvs[s].dst_dx);
    put(pack.uvs[s].dst_dy, lane, f.uvs[s].dst_dy);
    put(pack.uvs[s].footprint_dx, lane, f.uvs[s].footprint_dx);
    put(pack.uvs[s].footprint_dy, lane, f.uvs[s].footprint_dy);
    put(pack.uvs[s].tangent, lane, f.uvs[s].tangent);
    pack.uvs[s].sign.lane[lane] = f.uvs[s].sign;
  }
}

void expect_same_bits(float a, float b) {
  EXPECT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b));
}

void expect_lanes_equal_one(const Program& program, test::Random& random, BackFaces mode,
                            const Placement& placement) {
  for (int k = 0; k < 100; ++k) {
    raster::Fragment<EmulatedFloat> pack{};
    std::array<raster::Fragment<float>, emulated_width> one{};
    for (int i = 0; i < emulated_width; ++i) {
      auto f = test::random_fragment(random);
      f.front_facing = random.integer(2) == 0;
      if (random.integer(8) == 0) f.uvs[0].tangent = {0, 0, 0};
      if (random.integer(8) == 0) f.uvs[1].dst_dx = {0, 0};
      if (random.integer(8) == 0) f.normal_is_absent = true;
      one[static_cast<std::size_t>(i)] = narrow(f);
      put(pack, i, one[static_cast<std::size_t>(i)]);
    }
    const auto got = compose(program, pack, mode, placement);
    for (int i = 0; i < emulated_width; ++i) {
      const auto expected = compose(program, one[static_cast<std::size_t>(i)], mode, placement);
      expect_same_bits(got.normal.x.lane[i], expected.normal.x);
      expect_same_bits(got.normal.y.lane[i], expected.normal.y);
      expect_same_bits(got.normal.z.lane[i], expected.normal.z);
      expect_same_bits(got.surfgrad.x.lane[i], expected.surfgrad.x);
      expect_same_bits(got.sunlight.lane[i], expected.sunlight);
      EXPECT_EQ(got.degenerate.lane[i], expected.degenerate);
    }
  }
}

TEST(ComposeLanes, EqualOneLaneInEveryBackFaceMode) {
  constexpr std::uint64_t seed = 161;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Lab lab;
  std::vector<stack::Layer> layers = test::one_of_each(lab, random);
  layers.insert(layers.begin() + 2, stack::ResolveLayer{});
  stack::NormalMapLayer hex = test::normal_layer("b");
  hex.map.tiling = stack::Tiling::hex;
  hex.common.mask = test::mask_of("mask");
  hex.common.mask->tiling = stack::Tiling::hex;
  layers.emplace_back(hex);
  stack::HeightMapLayer heights = test::height_layer("heights", 0.02);
  heights.map.tiling = stack::Tiling::hex;
  heights.taps = stack::Taps::bicubic;
  layers.emplace_back(heights);
  lab.add("relief", surfgrad::test::random_image(random, 16, 8, 1));
  stack::ParallaxLayer parallax = test::parallax_layer("relief", 0.1);
  parallax.self_shadow = true;
  layers.insert(layers.begin(), parallax);
  const Program program = lab.compile(layers);
  Placement placement = test::placed({{0, -2, 0}, {1, 0, 0}, {0, 0, -1}});
  placement.to_sun = {0.6, 0, 0.8};
  for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip})
    expect_lanes_equal_one(program, random, mode, placement);
}

TEST(ComposeLanes, EqualOneLaneWhereEachMeetsOtherDecals) {
  constexpr std::uint64_t seed = 162;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Lab lab;
  static_cast<void>(test::one_of_each(lab, random));
  std::vector<stack::Layer> layers;
  for (const auto& word : stack::words_of<stack::DecalShape>) {
    const bool round = word.value == stack::DecalShape::sphere || word.value == stack::DecalShape::capsule;
    stack::DecalLayer layer = test::decal_layer(round ? "cube" : "a", word.value);
    if (word.value == stack::DecalShape::wedge) layer.space = stack::Space::object;
    layer.instances.assign(30, {});
    for (stack::DecalInstance& decal : layer.instances) {
      decal.position = random.vector3();
      decal.direction = random.unit_vector();
      decal.size = random.vector3(0.2, 1);
      decal.depth = random.uniform(0.2, 1);
      decal.radius = random.uniform(0.1, 0.5);
      decal.length = random.uniform(0.1, 0.5);
      decal.blend = stack::words_of<stack::DecalBlend>[random.bits() % 3].value;
      decal.opacity = random.uniform(0, 1);
    }
    layers.emplace_back(layer);
  }
  expect_lanes_equal_one(lab.compile(layers), random, BackFaces::flip,
                         test::placed({{0, -2, 0}, {1, 0, 0}, {0, 0, -1}}));
}

} // namespace
} // namespace surfgrad::engine
