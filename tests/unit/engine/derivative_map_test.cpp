// Derivative maps: the slopes of a normal map, in another file.

#include "diagnostic/error.hpp"
#include "lab.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using test::composed;
using test::derivative_layer;
using test::normal_layer;

struct DerivativeMaps : ::testing::Test {
  static constexpr std::uint64_t seed = 181;
  static constexpr int size = 16;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};

  /// A file of one slope.
  void add_constant(const char* name, vec2<float> codes, image::Depth depth) {
    image::Image image = image::make_image(1, 1, 2, depth);
    image.at(0, 0, 0) = codes.x;
    image.at(0, 0, 1) = codes.y;
    lab.add(name, image);
  }
};

TEST_F(DerivativeMaps, EqualTheNormalMapOfTheSameSlopes) {
  constexpr float range = 0.75f;
  image::Image slopes = image::make_image(size, size, 2, image::Depth::float32);
  image::Image normals = image::make_image(size, size, 3, image::Depth::float32);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      // Multiples of 1/64: the products with the range and the normals are exact floats.
      const vec2<float> d{static_cast<float>(random.integer(129) - 64) / 64,
                          static_cast<float>(random.integer(129) - 64) / 64};
      slopes.at(x, y, 0) = d.x;
      slopes.at(x, y, 1) = d.y;
      normals.at(x, y, 0) = 0.5f - 0.25f * range * d.x; // (-d, 1) / 2, any length will do
      normals.at(x, y, 1) = 0.5f - 0.25f * range * d.y;
      normals.at(x, y, 2) = 0.75f;
    }
  lab.add("slopes", slopes);
  lab.add("normals", normals);
  surfgrad::test::Worst worst("derivative map against normal map");
  for (const stack::Basis basis : {stack::Basis::mikktspace, stack::Basis::derived})
    for (const stack::Green green : {stack::Green::up, stack::Green::down})
      for (const double turn : {0.0, 90.0, 33.0}) {
        stack::DerivativeMapLayer d = derivative_layer("slopes", 1, basis);
        d.code.range = range;
        d.map.green = green;
        d.map.tile = {-3, 2};
        d.map.rotate_deg = turn;
        stack::NormalMapLayer n = normal_layer("normals", 1, basis);
        static_cast<stack::Texture&>(n.map) = d.map;
        n.map.file.path = "normals";
        n.map.green = green;
        n.map.channels = stack::Channels::xyz; // its blue is constant
        const Program by_slopes = lab.compile({d});
        const Program by_normals = lab.compile({n});
        for (long k = 0; k < 50; ++k) {
          const auto f = test::leaning_fragment(random);
          worst.add(composed(by_slopes, f).normal, composed(by_normals, f).normal, 1e-13,
                    k); // a few roundings
        }
      }
}

TEST_F(DerivativeMaps, CodesSpanTheRangeAboutTheirNeutralCode) {
  raster::Fragment<double> f = test::random_fragment(random);
  f.normal = {0, 0, 1};
  f.uvs[0].tangent = {1, 0, 0};
  f.uvs[0].sign = 1;
  const auto slope = [&](vec2<float> codes, double range, stack::NeutralCode neutral) {
    add_constant("one", codes, image::Depth::unorm8);
    stack::DerivativeMapLayer layer = derivative_layer("one");
    layer.code = {range, neutral};
    const vec3<double> g = composed(lab.compile({layer}), f).surfgrad;
    return vec2<double>{g.x, g.y};
  };
  constexpr double stored = 1e-6; // slopes of order one in float
  const vec2<double> ends = slope({1, 0}, 2, stack::NeutralCode::between);
  EXPECT_NEAR(ends.x, 2, stored);
  EXPECT_NEAR(ends.y, -2, stored);
  const vec2<double> middle = slope({128.0f / 255, 127.0f / 255}, 3, stack::NeutralCode::between);
  EXPECT_NEAR(middle.x, 3.0 / 255, stored);
  EXPECT_NEAR(middle.y, -3.0 / 255, stored);
  EXPECT_LT(max_abs(slope({128.0f / 255, 128.0f / 255}, 3, stack::NeutralCode::whole)), stored);
  EXPECT_NEAR(slope({1, 0.5f}, 3, stack::NeutralCode::whole).x, 3, stored);
}

TEST_F(DerivativeMaps, OfOneChannelAreAnError) {
  image::Image grey = image::make_image(2, 2, 1, image::Depth::unorm8);
  lab.add("grey", grey);
  try {
    static_cast<void>(lab.compile({derivative_layer("grey")}));
    FAIL() << "compiled";
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().file, "grey");
    EXPECT_EQ(error.fault().problem, "has 1 channel");
    EXPECT_EQ(error.fault().remedy, "a derivative map needs two or three");
  }
}

} // namespace
} // namespace surfgrad::engine
