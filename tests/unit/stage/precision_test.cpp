// What float tiles show is what the double reference shows, to a hundredth of a degree in all but a
// thousandth of the pixels. What is beyond that, measured here: where a rounding decides between places that
// lie apart (a view ray just meets a relief or just passes it: 23 degrees; the nearest of two texels: 0.04
// degrees) and else 0.012 degrees, where steep layers on a surface seen from the side multiply the rounding
// of its position.

#include "tile_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace surfgrad::stage {
namespace {

struct Difference {
  double degrees;
  std::string where;
};

/// The angles between both normals of every pixel where both are normals.
class Angles {
 public:
  explicit Angles(std::string what) : what_(std::move(what)) {}

  void add(const test::TileCase& tiles) {
    const test::Composed truth = test::composed_on(simd::Isa::reference, tiles);
    const test::Composed fast = test::composed_on(simd::available_isas().back(), tiles);
    ASSERT_EQ(truth.pixel, fast.pixel);
    for (std::size_t i = 0; i < truth.pixel.size(); ++i) {
      const vec3<double> a = truth.normal(i);
      const vec3<double> b = fast.normal(i);
      const double degrees = std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
      angles_.push_back(degrees);
      if (degrees > worst_.degrees)
        worst_ = {degrees, tiles.name + (tiles.texture ? ", texture" : ", screen") + ", pixel " +
                               std::to_string(truth.pixel[i] % tiles.side) + ", " +
                               std::to_string(truth.pixel[i] / tiles.side)};
    }
  }

  [[nodiscard]] double worst() const { return worst_.degrees; }
  /// Prints, and returns the 99.9th percentile.
  double percentile() {
    EXPECT_GT(angles_.size(), 1000u);
    std::sort(angles_.begin(), angles_.end());
    const double result = angles_[(angles_.size() * 999) / 1000];
    std::printf("  %s: %.2g degrees at the 99.9th percentile of %zu pixels, %.2g at the worst (%s)\n",
                what_.c_str(), result, angles_.size(), worst_.degrees, worst_.where.c_str());
    return result;
  }

 private:
  std::string what_;
  std::vector<double> angles_{};
  Difference worst_{0, "nowhere"};
};

/// What is aimed at: a hundredth of a degree is a thirtieth of a code of an 8-bit normal map.
constexpr double most_degrees = 0.01;

TEST(Precision, OfEveryKindIsThatOfTheReference) {
  for (const test::NamedLayers& kind : test::every_kind_alone()) {
    Angles angles(kind.name);
    for (const bool texture : {false, true}) {
      test::TileCase tiles = test::case_of(kind.layers, stack::BackFaces::flip, texture);
      tiles.name = kind.name;
      angles.add(tiles);
    }
    EXPECT_LT(angles.percentile(), most_degrees) << kind.name;
  }
}

/// Whether a rounding can decide between places or texels that lie apart: which relief a view ray meets
/// first, which texel is nearest, which hexagons of copies a place lies in.
bool jumps(const stack::Layer& any_layer) {
  return std::visit(
      [](const auto& layer) {
        if constexpr (std::is_same_v<decltype(layer), const stack::ParallaxLayer&>) return true;
        bool any = false;
        const auto look = [&](const stack::Tiled& map) {
          any = any || map.filter == stack::Filter::nearest || map.tiling == stack::Tiling::hex;
        };
        if constexpr (requires { layer.map.filter; }) look(layer.map);
        if constexpr (requires { layer.common.mask; })
          if (layer.common.mask) look(*layer.common.mask);
        return any;
      },
      any_layer);
}

bool jumps(const test::TileCase& tiles) {
  for (const scene::Material& material : tiles.scene.materials)
    if (std::any_of(material.layers.begin(), material.layers.end(),
                    [](const auto& layer) { return jumps(layer); }))
      return true;
  return false;
}

TEST(Precision, OfRandomStacksIsThatOfTheReference) {
  constexpr std::uint64_t seed = 4105;
  SCOPED_TRACE(seed);
  surfgrad::test::Random random(seed);
  Angles all("random stacks"), steady("those without parallax, nearest texels and hex tiles");
  for (int i = 0; i < 300; ++i) {
    test::TileCase tiles = test::random_case(random);
    tiles.name = "stack " + std::to_string(i);
    all.add(tiles);
    if (!jumps(tiles)) steady.add(tiles);
  }
  EXPECT_LT(all.percentile(), most_degrees);
  EXPECT_LT(steady.percentile(), most_degrees);
  EXPECT_LT(steady.worst(), 5 * most_degrees); // rounding, if multiplied: nothing jumps
}

} // namespace
} // namespace surfgrad::stage
