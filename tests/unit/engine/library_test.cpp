// Images to maps: shared where equal, refused where they cannot be what a layer takes them for.

#include "engine/program.hpp"

#include "diagnostic/error.hpp"
#include "support/images.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Random;

stack::TangentMap use_of(const char* file) {
  stack::TangentMap use;
  use.file = {file, 7, "layers[1].map"};
  return use;
}

TEST(MapLibrary, MakesEachCombinationOnce) {
  Random random(171);
  const image::Image image = surfgrad::test::random_normal_map(random, 4, 4);
  MapLibrary maps([&](const std::filesystem::path&) -> const image::Image& { return image; });
  stack::TangentMap use = use_of("a.png");
  const auto first = maps.slopes(use);
  EXPECT_EQ(maps.slopes(use), first);
  use.green = stack::Green::down;
  EXPECT_NE(maps.slopes(use), first);
  use = use_of("b.png");
  EXPECT_NE(maps.slopes(use), first);
  EXPECT_NE(maps.directions(use_of("a.png")), first);
  EXPECT_TRUE(maps.inward_texels().empty());
}

TEST(MapLibrary, CountsTexelsThatPointInwards) {
  const image::Image image = surfgrad::test::constant_image(3, 2, {0.9, 0.5, 0.2});
  MapLibrary maps([&](const std::filesystem::path&) -> const image::Image& { return image; });
  (void)maps.slopes(use_of("in.png"));
  (void)maps.slopes(use_of("in.png"));
  ASSERT_EQ(maps.inward_texels().size(), 1u);
  EXPECT_EQ(maps.inward_texels()[0].file, "in.png");
  EXPECT_EQ(maps.inward_texels()[0].count, 6);
  EXPECT_EQ(maps.inward_texels()[0].of, 6);
}

TEST(MapLibrary, RefusesImagesWithTooFewChannels) {
  Random random(172);
  const auto refusal = [&](int channels, const auto& ask) -> std::string {
    const image::Image image = surfgrad::test::random_image(random, 2, 2, channels);
    MapLibrary maps([&](const std::filesystem::path&) -> const image::Image& { return image; }, "s.json");
    try {
      ask(maps);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto slopes = [](MapLibrary& maps) { (void)maps.slopes(use_of("n.png")); };
  const auto xyz = [](MapLibrary& maps) {
    stack::TangentMap use = use_of("n.png");
    use.channels = stack::Channels::xyz;
    (void)maps.slopes(use);
  };
  const auto directions = [](MapLibrary& maps) { (void)maps.directions(use_of("n.png")); };
  EXPECT_EQ(refusal(1, slopes),
            "n.png: (named by s.json:7: layers[1].map): has 1 channel; a normal map needs two or three");
  EXPECT_EQ(refusal(2, slopes), "");
  EXPECT_EQ(
      refusal(2, xyz),
      "n.png: (named by s.json:7: layers[1].map): has 2 channels; a normal map of x, y and z needs three");
  EXPECT_EQ(refusal(3, xyz), "");
  EXPECT_NE(refusal(2, directions), "");
  EXPECT_EQ(refusal(4, directions), "");
}

TEST(UvSlots, ListEachSetOnceAndWantTangentsWhereALayerDoes) {
  stack::NormalMapLayer derived;
  derived.basis = stack::Basis::derived;
  derived.map.uv = 3;
  derived.common.mask.emplace();
  derived.common.mask->uv = 1;
  stack::NormalMapLayer vertex;
  vertex.map.uv = 1;
  std::vector<raster::UvSlot> slots;
  collect_uv_slots({derived, stack::ResolveLayer{}, stack::ObjectNormalMapLayer{}}, slots);
  ASSERT_EQ(slots.size(), 3u);
  EXPECT_EQ(slots[0].uv_set, 3);
  EXPECT_EQ(slots[1].uv_set, 1);
  for (const raster::UvSlot& slot : slots) EXPECT_FALSE(slot.tangents);
  collect_uv_slots({vertex}, slots);
  ASSERT_EQ(slots.size(), 3u);
  EXPECT_TRUE(slots[1].tangents);
  EXPECT_FALSE(slots[0].tangents);
}

} // namespace
} // namespace surfgrad::engine
