#include "mesh/places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace surfgrad::mesh {
namespace {

using testing::ElementsAre;

TEST(Places, AreNumberedByTheirFirstVertex) {
  const std::vector<vec3<float>> positions{{1, 2, 3}, {3, 2, 1}, {1, 2, 3}, {0, 0, 0}, {3, 2, 1}};
  const Places places = places_of(positions);
  EXPECT_THAT(places.of_vertex, ElementsAre(0, 1, 0, 2, 1));
  EXPECT_EQ(places.count, 3u);
  EXPECT_EQ(places_of({}).count, 0u);
}

TEST(Places, ZerosOfBothSignsAreOneAndNeighbouringNumbersAreNot) {
  constexpr float tiny = std::numeric_limits<float>::denorm_min();
  const std::vector<vec3<float>> positions{{0, -0.0f, 0}, {-0.0f, 0, -0.0f}, {tiny, 0, 0}, {-tiny, 0, 0}};
  EXPECT_THAT(places_of(positions).of_vertex, ElementsAre(0, 0, 1, 2));
}

} // namespace
} // namespace surfgrad::mesh
