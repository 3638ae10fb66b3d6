// Baking into object and world space.

#include "bake/bake.hpp"

#include "raster/visibility.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/worst.hpp"

#include <surfgrad/resolve.hpp>

#include <gtest/gtest.h>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;
using surfgrad::test::Worst;

/// Maps are stored in float: n / 2 + 1/2 rounds to 2^-25.
constexpr double stored = 2 * std::numeric_limits<float>::epsilon();
constexpr int size = 64;

vec3<double> vector_at(const image::Image& map, int x, int y) {
  return {2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1};
}

mat3<double> crooked(Random& random) {
  return random.rotation() * surfgrad::test::scaling({-1.5, 0.6, 1}) * random.rotation();
}

/// Object-space normals near those of the torus.
image::Image bumped_torus_normals(Random& random) {
  image::Image map = image::make_image(size, size, 3, image::Depth::float32);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec3<double> n =
          normalize_or_zero(surfgrad::test::torus_point((x + 0.5) / size, (y + 0.5) / size).normal +
                            0.4 * random.unit_vector());
      map.at(x, y, 0) = static_cast<float>(0.5 * n.x + 0.5);
      map.at(x, y, 1) = static_cast<float>(0.5 * n.y + 0.5);
      map.at(x, y, 2) = static_cast<float>(0.5 * n.z + 0.5);
    }
  return map;
}

TEST(Spaces, AnObjectSpaceMapComesBackUnderATurningStretchingMirroringTransform) {
  Random random(201);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::torus(32, 16), crooked(random), {1, 2, 3});
  const image::Image source = bumped_torus_normals(random);
  surfgrad::test::add_image(scene, "map", source);
  stack::ObjectNormalMapLayer layer;
  layer.map.file.path = "map";
  scene.materials[0].layers = {layer};
  const Baked object = bake(scene, {size, size, Space::object});
  const mat3<double> linear{{scene.objects[0].world_from_object.x.x, scene.objects[0].world_from_object.x.y,
                             scene.objects[0].world_from_object.x.z},
                            {scene.objects[0].world_from_object.y.x, scene.objects[0].world_from_object.y.y,
                             scene.objects[0].world_from_object.y.z},
                            {scene.objects[0].world_from_object.z.x, scene.objects[0].world_from_object.z.y,
                             scene.objects[0].world_from_object.z.z}};
  const Baked world = bake(scene, {size, size, Space::world});
  Worst back("object-space map through the bake");
  Worst through("world-space bake of it");
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec3<double> n = normalize_or_zero(vector_at(source, x, y));
      back.add(vector_at(object.map, x, y), n, 4 * stored, y * size + x);
      through.add(vector_at(world.map, x, y), normalize_or_zero(transform_normal(linear, n)), 4 * stored,
                  y * size + x);
    }
}

TEST(Spaces, TheTangentSpaceMapDecodesToTheWorldSpaceMap) {
  Random random(202);
  scene::Scene scene =
      surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(32, 16), crooked(random), {1, 2, 3});
  surfgrad::test::add_image(scene, "coarse", surfgrad::test::random_normal_map(random, 32, 32, 0.5));
  surfgrad::test::add_image(scene, "fine", surfgrad::test::random_normal_map(random, 128, 64, 0.5));
  stack::NormalMapLayer fine = surfgrad::test::normal_layer("fine");
  fine.basis = stack::Basis::derived;
  fine.map.rotate_deg = 30;
  scene.materials[0].layers = {surfgrad::test::normal_layer("coarse"), stack::ResolveLayer{}, fine};
  const Baked tangent = bake(scene, {size, size, Space::tangent});
  const Baked world = bake(scene, {size, size, Space::world});
  ASSERT_EQ(tangent.singular, 0);
  const std::vector<raster::Surface> surfaces{
      raster::place_mesh(scene.meshes[0], scene.objects[0].world_from_object, {0, 0, 0}, {{0, true}})};
  const raster::VisibilityBuffer layout =
      raster::see(surfaces, raster::Projection::texture(0, size, size), size, size);
  Worst worst("decoded tangent-space map against the world-space one");
  std::int64_t steep = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto t = layout.at(x, y).triangle;
      const auto f = raster::make_fragment(surfaces[0], t,
                                           raster::Projection::texture(0, size, size).planes(surfaces[0], t),
                                           x + 0.5, y + 0.5);
      const auto& uv = f.uvs[0];
      const vec3<double> m = vector_at(tangent.map, x, y);
      steep += m.z < 0.01;
      if (m.z < 0.01) continue; // clamped, or magnifies the map's rounding
      const vec3<double> n =
          m.x * uv.tangent + (m.y * uv.sign) * cross(f.normal, uv.tangent) + m.z * f.normal;
      worst.add(normalize_or_zero(n), vector_at(world.map, x, y), 16 * stored,
                y * size + x); // T and N not orthogonal
    }
  EXPECT_LT(steep, size * size / 50);
}

TEST(Spaces, WithoutLayersBakeTheInterpolatedNormal) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::torus(64, 64));
  const Baked world = bake(scene, {size, size, Space::world});
  const Baked tangent = bake(scene, {size, size, Space::tangent});
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec3<double> n = surfgrad::test::torus_point((x + 0.5) / size, (y + 0.5) / size).normal;
      EXPECT_LT(max_abs(vector_at(world.map, x, y) - n), 5e-3); // an interpolated normal turns within a cell
      EXPECT_LT(max_abs(vector_at(tangent.map, x, y) - vec3<double>{0, 0, 1}), stored);
    }
}

TEST(Spaces, ATransformThatFlattensIsCountedWhereItCannotBeUndone) {
  scene::Scene scene =
      surfgrad::test::scene_of(surfgrad::test::torus(16, 8), surfgrad::test::scaling({1, 1, 0}));
  const Baked object = bake(scene, {size, size, Space::object});
  EXPECT_EQ(object.singular, object.covered);
  EXPECT_EQ(object.map.at(3, 3, 2), 1);
}

} // namespace
} // namespace surfgrad::bake
