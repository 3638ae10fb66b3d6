// UDIM tiles: which there are, and what is baked into one.

#include "bake/udim.hpp"

#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "diagnostic/error.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A single triangle laid out so.
scene::Scene triangle(std::array<vec2<float>, 3> uvs) {
  mesh::TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.uv_sets = {{uvs.begin(), uvs.end()}};
  mesh.triangles = {{0, 1, 2}};
  mesh.material_of_triangle = {0};
  return surfgrad::test::scene_of(std::move(mesh));
}

std::vector<int> numbers(const scene::Scene& scene) {
  std::vector<int> result;
  for (const UdimTile& tile : udim_tiles(scene, 0)) result.push_back(tile.number());
  return result;
}

std::string refusal(const scene::Scene& scene) {
  try {
    (void)udim_tiles(scene, 0);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Udim, TilesAreThoseThatATriangleHasAnAreaIn) {
  EXPECT_THAT(numbers(triangle({{{0, 0}, {1, 0}, {0, 1}}})), ElementsAre(1001));
  EXPECT_THAT(numbers(triangle({{{9, 0}, {10, 0}, {10, 1}}})),
              ElementsAre(1010)); // not 1011, whose border it is
  EXPECT_THAT(numbers(triangle({{{2.5f, 3.5f}, {2.6f, 3.5f}, {2.5f, 3.6f}}})), ElementsAre(1033));
  // The slanted side passes by the corner of a tile that its box covers.
  EXPECT_THAT(numbers(triangle({{{0.1f, 0.1f}, {1.5f, 0.1f}, {0.1f, 1.5f}}})), ElementsAre(1001, 1002, 1011));
  EXPECT_THAT(numbers(triangle({{{0.1f, 0.1f}, {1.95f, 0.1f}, {0.1f, 1.95f}}})),
              ElementsAre(1001, 1002, 1011, 1012));
  // What exporters round reaches over a border by nothing that is seen.
  EXPECT_THAT(numbers(triangle({{{-1e-7f, 0}, {1 + 2e-7f, 0}, {0, 1}}})), ElementsAre(1001));
}

TEST(Udim, OutsideOfItsTilesIsAnErrorThatSaysWhere) {
  EXPECT_THAT(refusal(triangle({{{-0.25f, 0}, {1, 0}, {0, 1}}})),
              HasSubstr("reaches from (-0.25, 0) to (1, 1)"));
  EXPECT_THAT(refusal(triangle({{{0, -1}, {1, 0}, {0, 1}}})), HasSubstr("tiles 1001 to 9999"));
  EXPECT_THAT(refusal(triangle({{{9.5f, 0}, {10.5f, 0}, {9.5f, 1}}})), HasSubstr("no UDIM tile"));
  EXPECT_THAT(refusal(triangle({{{0, 900}, {1, 900}, {0, 901}}})), HasSubstr("no UDIM tile"));
  EXPECT_THAT(refusal(triangle({{{9, 899}, {10, 899}, {9, 900}}})), HasSubstr("beyond UDIM tile 9999"));
  EXPECT_THAT(refusal(triangle({{{0, 0}, {0.5f, 0.5f}, {1, 1}}})),
              HasSubstr("no triangle has an area in UV set 0"));
  scene::Scene bare = triangle({{{0, 0}, {1, 0}, {0, 1}}});
  bare.meshes[0].uv_sets.clear();
  EXPECT_THAT(refusal(bare), HasSubstr("has 0 UV sets, but set 0 is to be baked"));
}

TEST(Udim, TileHoldsWhatTheUnitSquareHoldsOfAMeshThatIsMovedThere) {
  Random random(1781);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(24, 12));
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, 64, 64));
  scene.materials[0].layers = {surfgrad::test::normal_layer("a")};
  const Options options{.width = 64, .height = 48, .padding = 4};
  const Baked at_origin = bake(scene, options);
  const Verification verified_at_origin = verify(scene, options, at_origin.map);
  for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = st + vec2<float>{4, 2};
  Options moved = options;
  moved.tile = {4, 2};
  const Baked in_tile = bake(scene, moved);
  EXPECT_EQ(in_tile.outside, 0);
  EXPECT_EQ(in_tile.covered, at_origin.covered);
  double worst = 0;
  for (std::size_t i = 0; i < in_tile.map.texels.size(); ++i)
    worst = std::max(worst, std::abs(double{in_tile.map.texels[i]} - at_origin.map.texels[i]));
  std::printf("  worst difference %.2g\n", worst);
  // Coordinates around 4 have 2 bits less than below 1: 2^-22 of a map of 64 texels, whose slopes differ
  // by 2.
  EXPECT_LT(worst, 64 * 4 * 0x1p-22);
  const Verification verified = verify(scene, moved, in_tile.map);
  EXPECT_LT(verified.texels.most_deg, 0.01);
  EXPECT_EQ(verified.on_screen.left_out, verified_at_origin.on_screen.left_out);
  EXPECT_GT(verified.on_screen.compared, 10000);
  EXPECT_THROW((void)bake(scene, options), InputError);
}

} // namespace
} // namespace surfgrad::bake
