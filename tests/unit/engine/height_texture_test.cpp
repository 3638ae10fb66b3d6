// Height maps under turned, mirrored and collapsed coordinates: the same relief, or none.

#include "height_fragments.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using stack::HeightMode;
using stack::Units;
using test::composed;
using test::for_each_point;
using test::height_layer;
using test::layer_of;
using test::Way;
using test::ways;

/// A few dozen roundings of gradients of order one; map texels are exact floats on both sides.
constexpr double rounding = 1e-12;

struct HeightTextures : ::testing::Test {
  static constexpr std::uint64_t seed = 172;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};
};

/// The image I'(x, y) = I(from(x, y)).
template <class From>
image::Image rearranged(const image::Image& map, int width, int height, const From& from) {
  image::Image result = image::make_image(width, height, 1, map.depth);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto [u, v] = from(x, y);
      result.at(x, y, 0) = map.at(u, v, 0);
    }
  return result;
}

TEST_F(HeightTextures, TurnedAndMirroredTexturesEqualTurnedAndMirroredImages) {
  constexpr int size = 16;
  constexpr int n = size - 1;
  const image::Image map = surfgrad::test::random_image(random, size, size, 1);
  lab.add("heights", map);
  struct Case {
    const char* name;
    vec2<double> tile;
    double rotate;
    std::pair<int, int> (*from)(int x, int y); ///< the texel shown at (x, y)
  };
  const Case cases[] = {{"90 degrees",
                         {1, 1},
                         90,
                         [](int x, int y) {
                           return std::pair{n - y, x};
                         }},
                        {"180 degrees",
                         {1, 1},
                         180,
                         [](int x, int y) {
                           return std::pair{n - x, n - y};
                         }},
                        {"270 degrees",
                         {1, 1},
                         -90,
                         [](int x, int y) {
                           return std::pair{y, n - x};
                         }},
                        {"mirrored along s",
                         {-1, 1},
                         0,
                         [](int x, int y) {
                           return std::pair{n - x, y};
                         }},
                        {"mirrored along t",
                         {1, -1},
                         0,
                         [](int x, int y) {
                           return std::pair{x, n - y};
                         }},
                        {"mirrored, then turned", {-1, 1}, 90, [](int x, int y) {
                           return std::pair{n - y, n - x};
                         }}};
  for (const Way& way : ways) {
    surfgrad::test::Worst worst(std::string("turned images, ") + way.name);
    for (const Case& c : cases) {
      SCOPED_TRACE(c.name);
      lab.add("changed", rearranged(map, size, size, c.from));
      stack::HeightMapLayer layer = layer_of(way, 0.02);
      layer.map.file.path = "changed";
      const Program by_image = lab.compile({layer});
      layer.map.file.path = "heights";
      layer.map.tile = c.tile;
      layer.map.rotate_deg = c.rotate;
      const Program by_transform = lab.compile({layer});
      long k = 0;
      for_each_point(random, 50, [&](const auto&, const auto&, auto f) {
        f = test::with_footprint(f, random.magnitude(0.1, 10), size);
        worst.add(composed(by_transform, f).normal, composed(by_image, f).normal, rounding, k++);
      });
    }
  }
}

TEST_F(HeightTextures, AnyTurnOfTheTextureAndOfItsCoordinateCancel) {
  lab.add("heights", surfgrad::test::random_image(random, 16, 16, 1));
  for (const Way& way : ways) {
    surfgrad::test::Worst worst(std::string("turned coordinates, ") + way.name);
    for (long k = 0; k < 200; ++k) {
      // Coordinates without shear: the frame of scale-free slopes turns with them.
      const double scale = random.magnitude(0.5, 2);
      auto p = surfgrad::test::random_point(surfgrad::test::Plane{}, random);
      const test::UvMap uv{{scale, 0}, {0, scale}, random.vector2()};
      auto f = test::fragment_of(p, surfgrad::test::random_camera(p, random).fragment(p), uv);
      f = test::with_footprint(f, random.magnitude(0.1, 10), 16);
      stack::HeightMapLayer layer = layer_of(way, 0.02);
      const vec3<double> plain = composed(lab.compile({layer}), f).normal;
      layer.map.rotate_deg = random.uniform(-180, 180);
      const double mirror = random.sign();
      layer.map.tile = {mirror, 1};
      const double a = layer.map.rotate_deg * std::numbers::pi / 180;
      const auto back = [&](vec2<double> v) { // the tile and the turn undone
        return vec2<double>{mirror * (std::cos(a) * v.x + std::sin(a) * v.y),
                            std::cos(a) * v.y - std::sin(a) * v.x};
      };
      auto& c = f.uvs[0];
      for (vec2<double>* v : {&c.st, &c.dst_dx, &c.dst_dy, &c.footprint_dx, &c.footprint_dy}) *v = back(*v);
      worst.add(composed(lab.compile({layer}), f).normal, plain, 1e-10, k); // sines of the C library
    }
  }
}

TEST_F(HeightTextures, AMirroredWrapShowsTheReflectedRelief) {
  constexpr int size = 8;
  const image::Image map = surfgrad::test::random_image(random, size, size, 1);
  lab.add("heights", map);
  const auto folded = [](int i) { return i < size ? i : 2 * size - 1 - i; };
  lab.add("drawn", rearranged(map, 2 * size, 2 * size, [&](int x, int y) {
            return std::pair{folded(x), folded(y)};
          }));
  for (const Way& way : ways) {
    surfgrad::test::Worst worst(std::string("mirrored wrap, ") + way.name);
    stack::HeightMapLayer layer = layer_of(way, 0.02);
    layer.map.wrap = stack::Wrap::mirror;
    const Program mirrored = lab.compile({layer});
    layer.map.wrap = stack::Wrap::repeat;
    layer.map.file.path = "drawn";
    layer.map.tile = {0.5, 0.5};
    if (way.mode == HeightMode::scale_free) layer.height = 0.01; // half of a width that is twice as large
    const Program drawn = lab.compile({layer});
    long k = 0;
    for_each_point(random, 100, [&](const auto&, const auto&, auto f) {
      f = test::with_footprint(f, random.magnitude(0.1, 1), size);
      // Linear filters of slopes do not see the turn within half a texel of a reflected border.
      const auto near_border = [&](double s) { return std::abs(s - std::floor(s + 0.5)) < 0.5 / size; };
      const vec2<double> st = f.uvs[0].st;
      if (way.mode == HeightMode::scale_free && (near_border(st.x) || near_border(st.y))) return;
      worst.add(composed(mirrored, f).normal, composed(drawn, f).normal, rounding, k++);
    });
  }
}

TEST_F(HeightTextures, ScaleFreeHeightsAreMeasuredInWidthsOfTheMap) {
  // Ramps of float heights; a clamped map has no step where it repeats.
  const auto slope_of = [&](int width, int height, bool along_t) {
    lab.add("heights", test::height_image(width, height, [&](auto st) { return along_t ? st.y : st.x; }));
    stack::HeightMapLayer layer = height_layer("heights", 0.1, HeightMode::scale_free);
    layer.map.wrap = stack::Wrap::clamp;
    raster::Fragment<double> f{};
    f.normal = {0, 0, 1};
    f.dp_dx = {7, 0, 0}; // whatever the size of the surface
    f.dp_dy = {0, 5, 0};
    f.front_facing = true;
    f.uvs[0].st = {0.45, 0.55};
    f.uvs[0].dst_dx = f.uvs[0].footprint_dx = {0.001, 0};
    f.uvs[0].dst_dy = f.uvs[0].footprint_dy = {0, 0.001};
    const vec3<double> g = composed(lab.compile({layer}), f).surfgrad;
    return along_t ? g.y : g.x;
  };
  constexpr double stored = 1e-6; // the ramp's float texels, times their number
  EXPECT_NEAR(slope_of(8, 8, false), 0.1, stored);
  EXPECT_NEAR(slope_of(8, 8, true), 0.1, stored);
  EXPECT_NEAR(slope_of(16, 8, false), 0.1, stored);
  EXPECT_NEAR(slope_of(16, 8, true), 0.2, stored) << "half a width high";
  EXPECT_NEAR(slope_of(8, 32, true), 0.025, stored);
}

TEST_F(HeightTextures, FlatHeightsAddNothing) {
  lab.add("heights", surfgrad::test::constant_image(4, 8, {0.3, 0.3, 0.3}));
  const mat3<double> m = test::scaling({2, -0.5, 1}) * random.rotation();
  const Program none = lab.compile({});
  for (const Way& way : ways) {
    const Program flat = lab.compile({layer_of(way, 1e6)});
    for (int k = 0; k < 100; ++k) {
      const auto f = test::leaning_fragment(random);
      EXPECT_EQ(max_abs(composed(flat, f, BackFaces::same, m).normal -
                        composed(none, f, BackFaces::same, m).normal),
                0)
          << way.name;
    }
  }
}

TEST_F(HeightTextures, AChannelIsChosen) {
  image::Image colours = surfgrad::test::random_image(random, 8, 8, 3);
  lab.add("heights", colours);
  image::Image blue = image::make_image(8, 8, 1, colours.depth);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) blue.at(x, y, 0) = colours.at(x, y, 2);
  lab.add("blue", blue);
  for (const Way& way : ways) {
    stack::HeightMapLayer layer = layer_of(way, 0.1);
    layer.channel = stack::MaskChannel::b;
    const Program by_channel = lab.compile({layer});
    layer.channel = stack::MaskChannel::r;
    layer.map.file.path = "blue";
    const Program by_file = lab.compile({layer});
    for (int k = 0; k < 20; ++k) {
      const auto f = test::random_fragment(random);
      EXPECT_EQ(max_abs(composed(by_channel, f).normal - composed(by_file, f).normal), 0) << way.name;
    }
  }
}

TEST_F(HeightTextures, CollapsedCoordinatesAndPositionsAreFlatAndFlagged) {
  lab.add("heights", surfgrad::test::random_image(random, 16, 16, 1));
  for (const Way& way : ways) {
    const Program program = lab.compile({layer_of(way, 0.1)});
    const auto expect_flat = [&](const raster::Fragment<double>& f, const char* what,
                                 const mat3<double>& m = test::identity) {
      const auto c = composed(program, f, BackFaces::same, m);
      EXPECT_TRUE(c.degenerate) << way.name << ", " << what;
      EXPECT_LT(max_abs(c.normal - c.base_normal), 1e-15) << way.name << ", " << what;
    };
    const auto f = test::random_fragment(random);
    EXPECT_FALSE(composed(program, f).degenerate) << way.name;
    auto g = f;
    g.uvs[0].dst_dx = {0, 0};
    expect_flat(g, "one rate zero");
    g.uvs[0].dst_dy = {0, 0};
    expect_flat(g, "both rates zero");
    g.uvs[0].dst_dx = {1e-3, 2e-3};
    g.uvs[0].dst_dy = {-2e-3, -4e-3};
    expect_flat(g, "parallel rates");
    g = f;
    g.dp_dx = g.dp_dy = {0, 0, 0};
    expect_flat(g, "no change of position");
    g = f;
    g.dp_dy = 2.0 * g.dp_dx;
    if (way.mode == HeightMode::physical) expect_flat(g, "parallel changes of position");
    if (way.units == Units::object) expect_flat(f, "no inverse", test::scaling({1, 0, 1}));
  }
}

TEST_F(HeightTextures, NoHeightMakesNaN) {
  image::Image wild = image::make_image(4, 4, 1, image::Depth::float32);
  const float values[] = {
      3e38f, -3e38f, 0, 1, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN(),
      1e-38f};
  for (float& texel : wild.texels.floats()) texel = values[random.integer(7)];
  lab.add("heights", wild);
  for (const Way& way : ways)
    for (const double height : {0.0, 5e-324, 1e12, -1e300})
      for (const double pixel : {0.0, 1e-300, 1e-30, 1.0, 1e30, 1e100})
        for (const double scale : {1e-12, 1.0, 1e12})
          for (int k = 0; k < 10; ++k) {
            const Program program =
                lab.compile({layer_of(way, height), stack::ResolveLayer{}, layer_of(way, height)});
            auto f = test::random_fragment(random);
            f.dp_dx = pixel * f.dp_dx;
            f.dp_dy = pixel * f.dp_dy;
            const auto c = composed(program, f, BackFaces::flip, test::scaling({scale, -1, 1}));
            EXPECT_NEAR(length(c.normal), 1, 1e-12)
                << way.name << ", height " << height << ", pixel " << pixel;
            EXPECT_FALSE(std::isnan(max_abs(c.surfgrad)));
          }
}

} // namespace
} // namespace surfgrad::engine
