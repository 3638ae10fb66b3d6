// The built-in maps of relief: right way up, and without a break where they repeat.

#include "gallery/relief_maps.hpp"
#include "image/cube_map.hpp"
#include "support/images.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace surfgrad::gallery {
namespace {

using image::Image;

vec3<double> normal_at(const Image& map, int x, int y) {
  const auto decoded = [&](int channel) { return 2.0 * map.at(x, y, channel) - 1; };
  return {decoded(0), decoded(1), decoded(2)};
}

/// Which way the relief faces in the texel at (s, t) of a square that begins at column `first`.
vec3<double> facing(const Image& map, int first, int size, double s, double t) {
  return normal_at(map, first + static_cast<int>(s * size), static_cast<int>(t * size));
}

void expect_upright_letter(const Image& map, int first, int size) {
  const auto at = [&](double s, double t) { return facing(map, first, size, s, t); };
  EXPECT_LT(at(0.31, 0.6).x, -0.3); // the stem's left flank
  EXPECT_GT(at(0.41, 0.3).x, 0.3);  // its right one, below the bars
  EXPECT_GT(at(0.5, 0.77).y, 0.3);  // the top bar from above
  EXPECT_LT(at(0.5, 0.67).y, -0.3); // and below
  EXPECT_LT(at(0.5, 0.44).y, -0.3); // the lower bar from below
  EXPECT_GT(at(0.69, 0.72).x, 0.3); // the top bar ends here,
  EXPECT_GT(at(0.61, 0.49).x, 0.3); // the lower one before
}

TEST(GalleryReliefMaps, LetterStandsUpright) {
  const Image letter = letter_normals(256);
  expect_upright_letter(letter, 0, 256);
  EXPECT_GT(facing(letter, 0, 256, 0.36, 0.5).z, 0.9999); // level on top
}

TEST(GalleryReliefMaps, LetterOfTheCubeStandsUprightOnThePositiveZFace) {
  constexpr int face = 128;
  const Image cube = letter_cube(face);
  ASSERT_EQ(cube.width, 6 * face);
  // There x and y lie along s and t: the letter's flanks tilt the direction as they tilt a flat normal.
  Image tilts = image::make_image(face, face, 3, image::Depth::float32);
  for (int side = 0; side < 6; ++side)
    for (int y = 0; y < face; ++y)
      for (int x = 0; x < face; ++x) {
        const vec3<double> d = normalize_or_zero(
            image::cube_direction(side, {(2 * x + 1.0) / face - 1, (2 * y + 1.0) / face - 1}));
        const vec3<double> n = normal_at(cube, side * face + x, y);
        ASSERT_NEAR(length(n), 1, 1e-4); // three codes of 16 bits
        ASSERT_GT(dot(n, d), 0.3) << side;
        if (side != 4) continue;
        const vec3<double> tilt = 0.5 * (n - d) + vec3<double>{0.5, 0.5, 0.5};
        tilts.at(x, y, 0) = static_cast<float>(tilt.x);
        tilts.at(x, y, 1) = static_cast<float>(tilt.y);
        tilts.at(x, y, 2) = static_cast<float>(tilt.z);
      }
  expect_upright_letter(tilts, 0, face);
}

/// Mean step between texels that adjoin within a map, and across its borders.
std::pair<double, double> steps(const Image& map) {
  std::array<double, 2> sum{};
  std::array<int, 2> count{};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
        const std::size_t across = x + dx == map.width || y + dy == map.height ? 1 : 0;
        for (int channel = 0; channel < map.channels; ++channel) {
          const double there = map.at((x + dx) % map.width, (y + dy) % map.height, channel);
          sum[across] += std::abs(there - static_cast<double>(map.at(x, y, channel)));
          ++count[across];
        }
      }
  return {sum[0] / count[0], sum[1] / count[1]};
}

TEST(GalleryReliefMaps, RepeatWithoutABreak) {
  for (const Image& map : {cobble_heights(128), crag_normals(512)}) {
    const auto [inside, across] = steps(map);
    std::printf("  mean step inside %.4f, across %.4f\n", inside, across);
    EXPECT_LT(across,
              1.3 * inside); // a border is a small sample; unrelated edges differ by several times this
    EXPECT_GT(across, 0.3 * inside);
  }
}

TEST(GalleryReliefMaps, CobblesUseTheirRangeWithoutReachingItsEnds) {
  const Image map = cobble_heights(128);
  const std::vector<float> heights = test::values_of(map);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  EXPECT_GT(*low, 0); // else stones or joints were cut off flat
  EXPECT_LT(*low, 0.2);
  EXPECT_LT(*high, 1);
  EXPECT_GT(*high, 0.8);
}

} // namespace
} // namespace surfgrad::gallery
