// A turned, mirrored or tiled texture equals an image that was turned, mirrored or tiled itself,
// its vectors with it.

#include "lab.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

namespace surfgrad::engine {
namespace {

using test::composed;

/// Vectors of few bits make the texels of both images exact; sampling them rounds a few times.
constexpr double rounding = 1e-13;

/// Vectors with few bits, so that negating a component is exact.
image::Image coarse_map(test::Random& random, int size) {
  image::Image map = image::make_image(size, size, 3, image::Depth::float32);
  for (std::size_t i = 0; i < map.texels.size(); ++i)
    map.texels[i] =
        static_cast<float>(i % 3 == 2 ? 200 + random.integer(56) : 64 + random.integer(129)) / 256;
  return map;
}

/// The image I'(x, y) with texel(x, y) = vector(I(from(x, y))).
template <class From, class Turn>
image::Image transformed(const image::Image& map, int width, int height, const From& from, const Turn& turn) {
  image::Image result = image::make_image(width, height, 3, image::Depth::float32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto [u, v] = from(x, y);
      const vec2<float> m = turn(vec2<float>{map.at(u, v, 0) - 0.5f, map.at(u, v, 1) - 0.5f});
      result.at(x, y, 0) = m.x + 0.5f;
      result.at(x, y, 1) = m.y + 0.5f;
      result.at(x, y, 2) = map.at(u, v, 2);
    }
  return result;
}

struct TextureTransform : ::testing::Test {
  static constexpr std::uint64_t seed = 131;
  static constexpr int size = 16;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  image::Image map = coarse_map(random, size);

  void expect_same(const image::Image& image, const stack::TangentMap& use, const char* what) {
    test::Lab lab;
    lab.add("map", map);
    lab.add("transformed", image);
    surfgrad::test::Worst worst(what);
    for (const stack::Basis basis : {stack::Basis::mikktspace, stack::Basis::derived}) {
      stack::NormalMapLayer by_transform = test::normal_layer("map", 0, basis);
      by_transform.map = use;
      by_transform.map.file.path = "map";
      const Program a = lab.compile({by_transform});
      stack::NormalMapLayer by_image = test::normal_layer("transformed", 0, basis);
      by_image.map.filter = use.filter;
      const Program b = lab.compile({by_image});
      for (long k = 0; k < 500; ++k) {
        auto f = test::random_fragment(random);
        const double zoom = random.magnitude(0.1, 10); // from magnified to a few texels a pixel
        f.uvs[0].dst_dx = zoom * f.uvs[0].dst_dx;
        f.uvs[0].dst_dy = zoom * f.uvs[0].dst_dy;
        worst.add(composed(a, f).normal, composed(b, f).normal, rounding, k);
      }
    }
  }
};

TEST_F(TextureTransform, QuarterTurnsEqualATurnedImage) {
  constexpr int n = size - 1;
  // st' = R st: the texel shown at (x, y) is the one at R (x, y); its vector turns back.
  stack::TangentMap use;
  use.rotate_deg = 90;
  expect_same(transformed(
                  map, size, size,
                  [](int x, int y) {
                    return std::pair{n - y, x};
                  },
                  [](vec2<float> m) {
                    return vec2<float>{m.y, -m.x};
                  }),
              use, "90 degrees");
  use.rotate_deg = 180;
  expect_same(transformed(
                  map, size, size,
                  [](int x, int y) {
                    return std::pair{n - x, n - y};
                  },
                  [](vec2<float> m) { return -m; }),
              use, "180 degrees");
  for (const double degrees : {270.0, -90.0}) {
    use.rotate_deg = degrees;
    expect_same(transformed(
                    map, size, size,
                    [](int x, int y) {
                      return std::pair{y, n - x};
                    },
                    [](vec2<float> m) {
                      return vec2<float>{-m.y, m.x};
                    }),
                use, "270 degrees");
  }
}

TEST_F(TextureTransform, ANegativeTileEqualsAMirroredImage) {
  constexpr int n = size - 1;
  stack::TangentMap use;
  use.tile = {-1, 1};
  expect_same(transformed(
                  map, size, size,
                  [](int x, int y) {
                    return std::pair{n - x, y};
                  },
                  [](vec2<float> m) {
                    return vec2<float>{-m.x, m.y};
                  }),
              use, "mirrored along s");
  use.tile = {1, -1};
  expect_same(transformed(
                  map, size, size,
                  [](int x, int y) {
                    return std::pair{x, n - y};
                  },
                  [](vec2<float> m) {
                    return vec2<float>{m.x, -m.y};
                  }),
              use, "mirrored along t");
}

TEST_F(TextureTransform, ATurnAfterAMirroredTileEqualsBothInThatOrder) {
  // st' = R(90) (-s, t) = (-t, -s).
  stack::TangentMap use;
  use.tile = {-1, 1};
  use.rotate_deg = 90;
  expect_same(transformed(
                  map, size, size,
                  [](int x, int y) {
                    return std::pair{size - 1 - y, size - 1 - x};
                  },
                  [](vec2<float> m) {
                    return vec2<float>{-m.y, -m.x};
                  }),
              use, "mirrored, then turned");
}

TEST_F(TextureTransform, TilesRepeatTheImageAndKeepItsSlopes) {
  stack::TangentMap use;
  use.tile = {2, 3};
  expect_same(transformed(
                  map, 2 * size, 3 * size,
                  [](int x, int y) {
                    return std::pair{x % size, y % size};
                  },
                  [](vec2<float> m) { return m; }),
              use, "2 x 3 tiles");
}

TEST_F(TextureTransform, AnOffsetShiftsTheImage) {
  stack::TangentMap use;
  use.offset = {3.0 / size, -5.0 / size};
  use.filter = stack::Filter::bilinear; // coarser levels do not move by whole texels
  expect_same(transformed(
                  map, size, size,
                  [](int x, int y) {
                    return std::pair{(x + 3) % size, (y + 11) % size};
                  },
                  [](vec2<float> m) { return m; }),
              use, "offset");
}

TEST_F(TextureTransform, AnyAngleTurnsTheVectorBack) {
  // One tilted texel: the map's +s, seen along the texture coordinate, is turned by minus the angle.
  test::Lab lab;
  lab.add("tilt", surfgrad::test::constant_image(1, 1, {0.75, 0.5, 1}));
  surfgrad::test::Worst worst("angle of the vector");
  for (int k = 0; k < 36; ++k) {
    stack::NormalMapLayer layer = test::normal_layer("tilt");
    layer.map.rotate_deg = 10.0 * k + 3;
    const Program program = lab.compile({layer});
    raster::Fragment<double> f = test::random_fragment(random);
    f.normal = {0, 0, 1};
    f.uvs[0].tangent = {1, 0, 0};
    f.uvs[0].sign = 1;
    const double a = layer.map.rotate_deg * 3.14159265358979324 / 180;
    // normal (1/2, 0, 1) in the image, i.e. xy = R^-1 (1/2, 0) along the coordinate
    const vec3<double> expected = normalize_or_zero(vec3<double>{0.5 * std::cos(a), -0.5 * std::sin(a), 1});
    worst.add(composed(program, f).normal, expected, 1e-12, k);
  }
}

} // namespace
} // namespace surfgrad::engine
