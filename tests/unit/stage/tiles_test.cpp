// Tiles show the same on every instruction set as on the one-lane float, byte for byte.

#include "tile_scenes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace surfgrad::stage {
namespace {

using test::Composed;

std::vector<simd::Isa> packs() {
  std::vector<simd::Isa> isas;
  for (const simd::Isa isa : simd::available_isas())
    if (isa != simd::Isa::reference && isa != simd::Isa::one_lane) isas.push_back(isa);
  return isas;
}

/// Compares with the one-lane float on all others; returns what that gives.
Composed expect_equal_on_all(const test::TileCase& tiles) {
  Composed one = test::composed_on(simd::Isa::one_lane, tiles);
  for (const simd::Isa isa : packs()) {
    const Composed other = test::composed_on(isa, tiles);
    EXPECT_EQ(one.pixel, other.pixel);
    if (one.pixel != other.pixel) continue;
    for (std::size_t c = 0; c < test::channels.size(); ++c)
      for (std::size_t i = 0; i < one.pixel.size(); ++i) {
        const float expected = one.values[c][i];
        const float got = other.values[c][i];
        if (std::bit_cast<std::uint32_t>(expected) == std::bit_cast<std::uint32_t>(got)) continue;
        ADD_FAILURE() << tiles.name << (tiles.texture ? ", texture" : ", screen") << ", " << name_of(isa)
                      << ": " << test::channels[c] << " of pixel " << one.pixel[i] % tiles.side << ", "
                      << one.pixel[i] / tiles.side << " is " << got << " instead of " << expected;
        break; // one of each channel tells enough
      }
  }
  return one;
}

bool shows_something(const Composed& composed, std::size_t channel) {
  for (const float v : composed.values[channel])
    if (v != 0) return true;
  return false;
}

TEST(Tiles, OfEveryKindAreTheSameOnEveryInstructionSet) {
  ASSERT_FALSE(packs().empty());
  for (const test::NamedLayers& kind : test::every_kind_alone())
    for (const bool texture : {false, true}) {
      test::TileCase tiles = test::case_of(kind.layers, stack::BackFaces::flip, texture);
      tiles.name = kind.name;
      const Composed composed = expect_equal_on_all(tiles);
      EXPECT_GT(composed.pixel.size(), 500u);
      // A parallax without a viewer moves nothing, and what else came out flat would compare nothing.
      EXPECT_TRUE(shows_something(composed, 6)) << kind.name << " leaves the surface flat";
    }
}

TEST(Tiles, AreTheSameInEveryBackFaceMode) {
  for (const auto& mode : stack::words_of<stack::BackFaces>)
    for (const bool texture : {false, true}) {
      test::TileCase tiles = test::case_of(test::every_kind_together(), mode.value, texture);
      tiles.name = mode.text;
      const Composed composed = expect_equal_on_all(tiles);
      for (const std::size_t channel : {0u, 3u, 6u, 12u, 15u, 18u, 19u, 20u, 21u})
        if (!(texture && channel == 18)) {
          EXPECT_TRUE(shows_something(composed, channel)) << mode.text << ": " << test::channels[channel];
        }
    }
}

TEST(Tiles, OfRandomStacksAreTheSameOnEveryInstructionSet) {
  constexpr std::uint64_t seed = 4104;
  const char* wanted = std::getenv("SURFGRAD_RANDOM_STACKS"); // scripts/bench tries many more
  const int count = wanted != nullptr ? std::max(1, std::atoi(wanted)) : 300;
  surfgrad::test::Random random(seed);
  std::size_t pixels = 0;
  int empty = 0;
  for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) {
    test::TileCase tiles = test::random_case(random);
    tiles.name = "stack " + std::to_string(i) + " of seed " + std::to_string(seed);
    const std::size_t shown = expect_equal_on_all(tiles).pixel.size();
    pixels += shown;
    empty += shown == 0;
  }
  std::printf("  %d random stacks of seed %llu: %zu pixels on %zu instruction sets, %d stacks out of sight\n",
              count, static_cast<unsigned long long>(seed), pixels, packs().size(), empty);
  EXPECT_GT(pixels, 256u * static_cast<std::size_t>(count) / 4);
}

} // namespace
} // namespace surfgrad::stage
