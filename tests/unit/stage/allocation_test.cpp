// Once its lists have grown, a thread composes tiles without asking for memory.

#include "counted_new.hpp"
#include "tile_scenes.hpp"

#include "render/camera.hpp"
#include "stage/tile_composer.hpp"

#include <gtest/gtest.h>

namespace surfgrad::stage {
namespace {

long compose_all(TileComposer& composer) {
  const long before = test::allocations();
  int pixels = 0;
  for (int row = 0; row < composer.grid().rows(); ++row)
    for (int column = 0; column < composer.grid().columns(); ++column)
      pixels += composer.compose(column, row).count;
  EXPECT_GT(pixels, 500);
  return test::allocations() - before;
}

TEST(Tiles, AreComposedWithoutAllocationOnceAllAreThere) {
  for (const bool texture : {false, true}) {
    const test::TileCase tiles = test::case_of(test::every_kind_together(), stack::BackFaces::flip, texture);
    const int side = tiles.side;
    const render::Pinhole camera = render::place_camera(tiles.scene, side, side);
    View view;
    if (!texture) view = {camera.eye, camera.relative_from_screen(side, side), {0, 0, 1}};
    const Stage stage(tiles.scene, view, {{0, true}}, {});
    const auto projection =
        texture ? raster::Projection::texture(stage.slot_of(0), side, side)
                : raster::Projection::camera(camera.screen_from_relative(side, side), camera.near);
    TileComposer composer(stage, projection, side, side, tiles.tile_side, tiles.tile_side,
                          {.surfgrad = true, .sunlight = true, .vertex_frame = true});
    EXPECT_GT(compose_all(composer), 0) << "setting up allocates: is new counted?";
    EXPECT_EQ(compose_all(composer), 0) << (texture ? "texture" : "screen");
    for (const simd::Isa isa : simd::available_isas()) {
      const simd::ForcedIsa forced(isa);
      compose_all(composer); // lists that wider packs fill further
      EXPECT_EQ(compose_all(composer), 0) << name_of(isa) << (texture ? ", texture" : ", screen");
    }
  }
}

} // namespace
} // namespace surfgrad::stage
