// The round trip on a real model with its own map.

#include "bake/bake.hpp"

#include "raster/visibility.hpp"
#include "source_codes.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace surfgrad::bake {
namespace {

TEST(RoundTrip, OfARealModelsOwnMap) {
  const std::filesystem::path file = SURFGRAD_SHARED_DIR "/assets/mesh/blenderio_suzanne/02_suzanne.gltf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is absent";
  const scene::Scene scene = scene::load_scene(file);
  ASSERT_EQ(scene.images.size(), 1u);
  const image::Image& source = *scene.images.begin()->second;
  const Baked baked = bake(scene, {source.width, source.height, Space::tangent});

  // Which texels lie under exactly one triangle.
  std::vector<raster::Surface> surfaces;
  for (const scene::Object& object : scene.objects)
    surfaces.push_back(
        raster::place_mesh(scene.meshes[object.mesh], object.world_from_object, {0, 0, 0}, {{0, true}}));
  std::vector<int> hits(static_cast<std::size_t>(source.width) * static_cast<std::size_t>(source.height), 0);
  for (const raster::Surface& surface : surfaces)
    for (std::uint32_t t = 0; t < surface.mesh->triangles.size(); ++t) {
      const raster::TrianglePlanes planes =
          raster::Projection::texture(0, source.width, source.height).planes(surface, t);
      double low[] = {1e9, 1e9};
      double high[] = {-1e9, -1e9};
      for (const std::uint32_t v : surface.mesh->triangles[t]) {
        const vec2<double> st = surface.slots[0].st[v];
        low[0] = std::min(low[0], st.x * source.width);
        high[0] = std::max(high[0], st.x * source.width);
        low[1] = std::min(low[1], st.y * source.height);
        high[1] = std::max(high[1], st.y * source.height);
      }
      for (int y = std::max(0, static_cast<int>(low[1]) - 1);
           y < std::min<double>(source.height, high[1] + 1); ++y)
        for (int x = std::max(0, static_cast<int>(low[0]) - 1);
             x < std::min<double>(source.width, high[0] + 1); ++x)
          hits[static_cast<std::size_t>(y) * static_cast<std::size_t>(source.width) +
               static_cast<std::size_t>(x)] += planes.covers(x + 0.5, y + 0.5);
    }

  int worst = 0;
  std::int64_t compared = 0;
  std::int64_t overlapping = 0;
  std::int64_t below = 0;
  std::int64_t uncovered = 0;
  std::int64_t differing = 0;
  for (int y = 0; y < source.height; ++y)
    for (int x = 0; x < source.width; ++x) {
      const int count = hits[static_cast<std::size_t>(y) * static_cast<std::size_t>(source.width) +
                             static_cast<std::size_t>(x)];
      uncovered += count == 0;
      overlapping += count > 1;
      if (count != 1) continue;
      const auto n = test::normal_of_texel(source, false, x, y);
      if (!n) {
        ++below;
        continue;
      }
      const int difference = test::code_difference(baked.map, x, y, *n);
      const bool flat = baked.map.at(x, y, 2) == 1;
      if (difference > 1 && flat) { // only a singular frame may do that
        ++differing;
        continue;
      }
      worst = std::max(worst, difference);
      ++compared;
    }
  std::printf("  worst difference %d code at 16 bits, %lld texels compared; left out: %lld uncovered, %lld "
              "overlapping, "
              "%lld below the surface, %lld with a singular frame\n",
              worst, static_cast<long long>(compared), static_cast<long long>(uncovered),
              static_cast<long long>(overlapping), static_cast<long long>(below),
              static_cast<long long>(baked.singular));
  EXPECT_LE(worst, 1);
  EXPECT_LE(differing, baked.singular);
  EXPECT_LT(baked.singular, compared / 1000);
  EXPECT_EQ(baked.overlapping, overlapping);
  EXPECT_EQ(baked.covered - baked.touched + uncovered, static_cast<std::int64_t>(hits.size()));
  EXPECT_GT(compared, 100000);
}

} // namespace
} // namespace surfgrad::bake
