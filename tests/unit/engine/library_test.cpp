// Images to maps: shared where equal, refused where they cannot be what a layer takes them for.

#include "engine/program.hpp"

#include "diagnostic/error.hpp"
#include "support/images.hpp"

#include <gtest/gtest.h>

#include <map>

namespace surfgrad::engine {
namespace {

using surfgrad::test::Random;

stack::FileName file_of(const char* file) { return {file, 7, "layers[1].map"}; }

constexpr stack::Channels automatic = stack::Channels::automatic;
constexpr stack::Green up = stack::Green::up;

TEST(MapLibrary, MakesEachCombinationOnce) {
  Random random(171);
  const image::Image image = surfgrad::test::random_normal_map(random, 4, 4);
  MapLibrary maps([&](const std::filesystem::path&) -> const image::Image& { return image; });
  const stack::FileName a = file_of("a.png");
  const auto first = maps.slopes(a, automatic, up);
  EXPECT_EQ(maps.slopes(a, automatic, up), first);
  EXPECT_NE(maps.slopes(a, automatic, stack::Green::down), first);
  EXPECT_EQ(maps.slopes(a, automatic, up, stack::Filter::anisotropic), first);
  EXPECT_NE(maps.slopes(a, automatic, up, stack::Filter::normal), first);
  EXPECT_NE(maps.slopes(file_of("b.png"), automatic, up), first);
  EXPECT_NE(maps.directions(a, up), first);
  const auto steep = maps.derivatives(a, {.range = 2}, up);
  EXPECT_NE(steep, first);
  EXPECT_NE(maps.derivatives(a, {.range = 3}, up), steep);
  EXPECT_NE(maps.derivatives(a, {.range = 2, .neutral = stack::NeutralCode::whole}, up), steep);
  EXPECT_EQ(maps.derivatives(a, {.range = 2}, up), steep);
  const auto red = maps.heights(a, stack::MaskChannel::r);
  EXPECT_NE(maps.heights(a, stack::MaskChannel::g), red);
  EXPECT_NE(maps.weights(a, stack::MaskChannel::r), red);
  const auto repeated = maps.height_slopes(a, stack::MaskChannel::r, {});
  EXPECT_NE(maps.height_slopes(a, stack::MaskChannel::r, {image::Wrap::clamp, image::Wrap::repeat}),
            repeated);
  EXPECT_NE(maps.height_slopes(a, stack::MaskChannel::g, {}), repeated);
  EXPECT_EQ(maps.height_slopes(a, stack::MaskChannel::r, {}), repeated);
  EXPECT_TRUE(maps.inward_texels().empty());
}

TEST(MapLibrary, CountsTexelsThatPointInwards) {
  const image::Image image = surfgrad::test::constant_image(3, 2, {0.9, 0.5, 0.2});
  MapLibrary maps([&](const std::filesystem::path&) -> const image::Image& { return image; });
  (void)maps.slopes(file_of("in.png"), automatic, up);
  (void)maps.slopes(file_of("in.png"), automatic, up);
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
  const auto slopes = [](MapLibrary& maps) { (void)maps.slopes(file_of("n.png"), automatic, up); };
  const auto xyz = [](MapLibrary& maps) { (void)maps.slopes(file_of("n.png"), stack::Channels::xyz, up); };
  const auto derivatives = [](MapLibrary& maps) { (void)maps.derivatives(file_of("n.png"), {}, up); };
  const auto directions = [](MapLibrary& maps) { (void)maps.directions(file_of("n.png"), up); };
  EXPECT_EQ(refusal(1, slopes),
            "n.png: (named by s.json:7: layers[1].map): has 1 channel; a normal map needs two or three");
  EXPECT_EQ(refusal(2, slopes), "");
  EXPECT_EQ(
      refusal(2, xyz),
      "n.png: (named by s.json:7: layers[1].map): has 2 channels; a normal map of x, y and z needs three");
  EXPECT_EQ(refusal(3, xyz), "");
  EXPECT_NE(refusal(1, derivatives), "");
  EXPECT_EQ(refusal(2, derivatives), "");
  EXPECT_NE(refusal(2, directions), "");
  EXPECT_EQ(refusal(4, directions), "");
  for (const auto& ask :
       {+[](MapLibrary& maps) { (void)maps.weights(file_of("n.png"), stack::MaskChannel::a); },
        +[](MapLibrary& maps) { (void)maps.heights(file_of("n.png"), stack::MaskChannel::a); },
        +[](MapLibrary& maps) { (void)maps.height_slopes(file_of("n.png"), stack::MaskChannel::a, {}); },
        +[](MapLibrary& maps) { (void)maps.relief(file_of("n.png"), stack::MaskChannel::a); }}) {
    EXPECT_EQ(refusal(3, ask), "n.png: (named by s.json:7: layers[1].map): has no alpha channel; expected "
                               "\"channel\": r, g or b, or a file with opacity");
    EXPECT_EQ(refusal(4, ask), "");
  }
}

TEST(MapLibrary, RefusesImagesWhoseMapsCannotBeAddressed) {
  const auto refusal = [](int width, int height, const auto& ask) -> std::string {
    image::Image image; // refused before a texel is read
    image.width = width;
    image.height = height;
    image.channels = 3;
    MapLibrary maps([&](const std::filesystem::path&) -> const image::Image& { return image; }, "s.json");
    try {
      ask(maps);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto slopes = [](MapLibrary& maps) { (void)maps.slopes(file_of("n.png"), automatic, up); };
  const auto relief = [](MapLibrary& maps) { (void)maps.relief(file_of("n.png"), stack::MaskChannel::r); };
  EXPECT_EQ(refusal(5'000'000, 1, slopes), "n.png: (named by s.json:7: layers[1].map): is 5000000x1; "
                                           "expected at most 4194304 texels a side");
  EXPECT_EQ(refusal(1, 2'000'000, relief), "n.png: (named by s.json:7: layers[1].map): is 1x2000000; "
                                           "expected at most 1048576 texels a side");
  EXPECT_EQ(refusal(40'000, 40'000, slopes), "n.png: (named by s.json:7: layers[1].map): is 40000x40000; "
                                             "with its mip levels that is more than 2147483644 numbers");
}

TEST(MapLibrary, MakesCubeMapsOfOneFileOrSixAndSaysWhichFaceDoesNotFit) {
  Random random(173);
  std::map<std::filesystem::path, image::Image> images;
  std::vector<stack::FileName> files;
  for (const char* name : {"px", "nx", "py", "ny", "pz", "nz"}) {
    images[name] = surfgrad::test::random_image(random, 4, 4, 3);
    files.push_back({name, 3, "layers[0].map[" + std::to_string(files.size()) + "]"});
  }
  images["strip"] = surfgrad::test::random_image(random, 24, 4, 3);
  images["wide"] = surfgrad::test::random_image(random, 25, 4, 3);
  MapLibrary maps([&](const std::filesystem::path& name) -> const image::Image& { return images.at(name); },
                  "s.json");
  const auto six = maps.cube(files);
  EXPECT_EQ(six->size(), 4);
  EXPECT_EQ(maps.cube(files), six);
  EXPECT_EQ(maps.cube({file_of("strip")})->size(), 4);
  EXPECT_NE(maps.cube({file_of("strip")}), six);

  const auto refusal = [&](const std::vector<stack::FileName>& names) -> std::string {
    try {
      (void)maps.cube(names);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  images["small"] = surfgrad::test::random_image(random, 2, 2, 3);
  files[4].path = "small";
  EXPECT_EQ(refusal(files), "small: (named by s.json:3: layers[0].map[4]): face +z is 2x2, face +x is 4x4; "
                            "expected six faces of one size");
  EXPECT_EQ(refusal({file_of("wide")}),
            "wide: (named by s.json:7: layers[1].map): is 25x4, which is no layout of six square faces; "
            "expected a strip (6:1 or 1:6), a cross (4:3 or 3:4) or six separate images");
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
