/// Maps in the buffers that a device's limit allows: where they lie, that answers do not depend on it, and
/// what is refused.

#include "diagnostic/error.hpp"
#include "gpu/backend.hpp"
#include "gpu/map_words.hpp"
#include "gpu/stack_maps.hpp"
#include "gpu/stack_pipeline.hpp"
#include "image/pyramid.hpp"
#include "render/render.hpp"
#include "stack/stack.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/vulkan.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Sizes = std::vector<std::uint64_t>;

std::vector<std::size_t> buffers_of(const gpu::Packing& packing) {
  std::vector<std::size_t> buffers;
  for (const auto& place : packing.places) buffers.push_back(place.buffer);
  return buffers;
}

TEST(FirstFit, PutsEachPieceIntoTheFirstBufferWithRoom) {
  const gpu::Packing packing = gpu::first_fit(Sizes{6, 5, 4, 5, 10, 0}, 10);
  EXPECT_THAT(buffers_of(packing), ElementsAre(0, 1, 0, 1, 2, 0));
  EXPECT_THAT(packing.used, ElementsAre(10, 10, 10));
  EXPECT_EQ(packing.places[2].first, 6u);
  EXPECT_EQ(packing.places[3].first, 5u);
  EXPECT_EQ(packing.places[4].first, 0u);
}

TEST(FirstFit, NeitherOverfillsABufferNorLaysPiecesOverEachOther) {
  Random random(7);
  for (int round = 0; round < 100; ++round) {
    const auto most = static_cast<std::uint64_t>(random.uniform(10, 1000));
    Sizes sizes(50);
    for (auto& size : sizes)
      size = static_cast<std::uint64_t>(random.uniform(0, static_cast<double>(most) + 1));
    const gpu::Packing packing = gpu::first_fit(sizes, most);
    std::vector<std::set<std::uint64_t>> taken(packing.used.size());
    for (std::size_t i = 0; i < sizes.size(); ++i)
      for (std::uint64_t k = 0; k < sizes[i]; ++k)
        ASSERT_TRUE(taken[packing.places[i].buffer].insert(packing.places[i].first + k).second);
    for (std::size_t b = 0; b < taken.size(); ++b) {
      ASSERT_EQ(taken[b].size(), packing.used[b]);
      ASSERT_LE(packing.used[b], most);
    }
  }
}

/// A material's maps, as a stage makes them.
struct Maps {
  explicit Maps(const scene::Scene& scene)
      : library([&](const std::filesystem::path& file) -> const image::Image& { return scene.image(file); }),
        maps(shadergen::generate(scene.materials.front().layers,
                                 {.access = shadergen::TextureAccess::exact, .diagnostics = true}),
             library) {}
  engine::MapLibrary library;
  gpu::StackMaps maps;
};

std::size_t bytes_of(const gpu::StackMap& m) {
  const std::size_t nodes = m.field != nullptr ? m.field->maxima.size() + m.field->node_table.size() : 0;
  return 4 * (m.map->words.size() + m.map->level_table.size() + nodes);
}

class MapBuffers : public VulkanTest {
 protected:
  /// Renders a scene with its maps in one buffer and in as many as the largest map allows.
  static void compare(const scene::Scene& scene, const std::string& where, int least_buffers) {
    const Maps maps(scene);
    std::size_t largest = 0;
    for (const gpu::StackMap& each : maps.maps.maps()) largest = std::max(largest, bytes_of(each));
    const gpu::MapWords words(device(), maps.maps.maps(), "it", largest);
    EXPECT_GE(words.buffer_count(), least_buffers) << where;
    const std::set<int> used(words.blocks().begin(), words.blocks().end());
    EXPECT_EQ(used.size(), static_cast<std::size_t>(words.buffer_count())) << where;
    std::printf("  %s: %zu maps in %d buffers\n", where.c_str(), words.maps().size(), words.buffer_count());

    const gpu::Backend one(device());
    const gpu::Backend several(device(), gpu::Backend::usual_tile_side, SIZE_MAX, {}, largest);
    render::Options options{.width = 48, .height = 48, .samples = 1, .backend = &one};
    const render::Picture expected = render::render(scene, options);
    options.backend = &several;
    const render::Picture got = render::render(scene, options);
    EXPECT_GT(expected.covered, 300) << where;
    EXPECT_EQ(expected.degenerate, 0) << where;
    EXPECT_TRUE(got.image.texels == expected.image.texels) << where;
  }
};

TEST_F(MapBuffers, AsManyAsItTakesGiveTheAnswerOfOne) { compare(scene::demo_scene(), "demo", 2); }

TEST_F(MapBuffers, HoldEveryKindOfMap) {
  scene::Scene scene = scene_of(plane(8));
  Random random(11);
  for (const char* name : {"relief", "slopes", "mask", "heights", "directions"})
    add_image(scene, name, random_normal_map(random, 32, 32, 0.3, image::Depth::unorm8));
  add_image(scene, "cube", random_normal_map(random, 6 * 16, 16, 0.3));
  scene.materials.front().layers = stack::parse_stack(R"({ "surfgrad": 1, "layers": [
      { "type": "parallax", "map": "relief", "height": 0.05 },
      { "type": "normal_map", "map": "slopes", "mask": { "map": "mask" } },
      { "type": "height_map", "map": "heights", "mode": "scale_free", "height": 0.02 },
      { "type": "object_normal_map", "map": "directions", "blend": "mix", "opacity": 0.5 },
      { "type": "decal", "shape": "sphere", "map": "cube", "radius": 0.7 } ] })",
                                                      "kinds.json")
                                       .layers;
  compare(scene, "every kind", 3);
}

image::Map grey_map(int side) {
  const std::vector<float> texels(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0.5f);
  return image::with_pyramid(image::rows_of(texels, side, 1), side, side, 1);
}

template <class F>
std::string machine_error(const F& f) {
  try {
    f();
  } catch (const MachineError& error) {
    return error.what();
  }
  return "no MachineError";
}

TEST_F(MapBuffers, AreSharedByWhatFitsAndByLayersOfOneMap) {
  const image::Map map = grey_map(64), other = grey_map(32);
  const std::size_t bytes = bytes_of({&map});
  const gpu::MapWords words(device(), {{&map, nullptr, "a"}, {&other, nullptr, "b"}, {&map, nullptr, "a"}},
                            "brick", bytes);
  EXPECT_THAT(words.blocks(), ElementsAre(0, 1, 0));
  EXPECT_EQ(words.words(0).size() * 4, bytes);
  EXPECT_EQ(words.words(1).size() * 4, bytes_of({&other}));
  EXPECT_EQ(words.maps()[2].texels, words.maps()[0].texels);
}

TEST_F(MapBuffers, RefuseAMapThatIsTooLargeAloneByItsFile) {
  const image::Map map = grey_map(64), small = grey_map(4);
  const std::size_t bytes = bytes_of({&map});
  const std::vector<gpu::StackMap> maps{{&small, nullptr, "small.png"}, {&map, nullptr, "bricks/wall_n.png"}};
  EXPECT_EQ(machine_error([&] { gpu::MapWords(device(), maps, "brick", bytes); }), "no MachineError");
  EXPECT_THAT(machine_error([&] { gpu::MapWords(device(), maps, "brick", bytes - 1); }),
              AllOf(HasSubstr("the material \"brick\""),
                    HasSubstr("the map bricks/wall_n.png needs " + std::to_string(bytes) +
                              " bytes in one buffer, maxStorageBufferRange is " + std::to_string(bytes - 1)),
                    HasSubstr("use smaller maps, or --device cpu")));
}

} // namespace
} // namespace surfgrad::test
