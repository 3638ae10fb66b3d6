// Triangles that share edges cover every point exactly once: no cracks, no double hits.

#include "raster/visibility.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace surfgrad::raster {
namespace {

constexpr int size = 40;

/// How many of these triangles cover each pixel centre.
std::vector<int> counts(const std::vector<std::array<vec3<double>, 3>>& triangles) {
  std::vector<int> result(size * size, 0);
  for (const auto& corners : triangles) {
    const TrianglePlanes planes(corners);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        result[static_cast<std::size_t>(y * size + x)] += planes.covers(x + 0.5, y + 0.5);
  }
  return result;
}

/// A net of quads over [-5, size + 5]^2 split along random diagonals, its inner vertices moved by
/// `shift`. Half of the triangles wind clockwise.
template <class Shift>
std::vector<std::array<vec3<double>, 3>> net(test::Random& random, const Shift& shift) {
  constexpr int cells = 10;
  constexpr double step = (size + 10.0) / cells;
  std::vector<vec3<double>> vertices;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const bool inner = i > 0 && j > 0 && i < cells && j < cells;
      const vec2<double> p =
          vec2<double>{i * step - 5, j * step - 5} + (inner ? shift() : vec2<double>{0, 0});
      vertices.push_back({p.x, p.y, 1});
    }
  std::vector<std::array<vec3<double>, 3>> triangles;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto v = [&](int di, int dj) {
        return vertices[static_cast<std::size_t>((j + dj) * (cells + 1) + i + di)];
      };
      const bool rising = random.integer(2) == 0;
      std::array<vec3<double>, 3> low{v(0, 0), v(1, 0), rising ? v(1, 1) : v(0, 1)};
      std::array<vec3<double>, 3> high{v(1, 1), v(0, 1), rising ? v(0, 0) : v(1, 0)};
      if (random.integer(2) == 0) std::swap(low[0], low[1]);
      if (random.integer(2) == 0) std::swap(high[1], high[2]);
      triangles.push_back(low);
      triangles.push_back(high);
    }
  return triangles;
}

void expect_once(const std::vector<std::array<vec3<double>, 3>>& triangles, int trial) {
  const std::vector<int> hits = counts(triangles);
  for (std::size_t i = 0; i < hits.size(); ++i)
    ASSERT_EQ(hits[i], 1) << "trial " << trial << " pixel " << i % size << ", " << i / size;
}

TEST(Coverage, IsOnceWithVerticesAnywhere) {
  constexpr std::uint64_t seed = 61;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (int trial = 0; trial < 30; ++trial)
    expect_once(net(random, [&] { return random.vector2(-1, 1); }), trial);
}

TEST(Coverage, IsOnceWithVerticesAndEdgesOnPixelCentres) {
  constexpr std::uint64_t seed = 62;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (int trial = 0; trial < 30; ++trial) // net vertices lie on multiples of 5: move them to centres
    expect_once(net(random,
                    [&] {
                      return vec2<double>{random.integer(3) - 1.5, random.integer(3) - 1.5};
                    }),
                trial);
}

TEST(Coverage, IsOnceUnderPerspectiveAcrossTheEyePlane) {
  constexpr std::uint64_t seed = 63;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  // A floor seen from above it, from behind the eye to the distance: what shows below the horizon is
  // covered once, what shows above it never. Vertices may lie behind.
  for (int trial = 0; trial < 30; ++trial) {
    auto floor = net(random, [&] { return random.vector2(-1, 1); });
    const double horizon = 25.25;
    for (auto& triangle : floor)
      for (vec3<double>& v : triangle) {
        const vec3<double> p{1000 * (v.x - size / 2.0), -1, 1000 * (v.y - size / 2.0)};
        v = {30 * p.x + 20 * p.z, 30 * p.y + horizon * p.z, p.z};
      }
    const std::vector<int> hits = counts(floor);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const double y = static_cast<double>(i / size) + 0.5;
      ASSERT_EQ(hits[i], y < horizon ? 1 : 0) << "trial " << trial << " pixel " << i % size << ", " << y;
    }
  }
}

TEST(Coverage, OfAFanAroundAPixelCentreIsOneTriangle) {
  constexpr std::uint64_t seed = 64;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (int trial = 0; trial < 500; ++trial) {
    const vec3<double> hub{20.5, 20.5, 1};
    const int blades = 3 + random.integer(9);
    std::vector<vec3<double>> rim;
    for (int i = 0; i < blades; ++i) {
      // Less than half a cell of jitter: no blade of three may reach half a turn.
      const double angle = 2 * std::numbers::pi * (i + random.uniform(0, 0.45)) / blades;
      rim.push_back({20.5 + 9 * std::cos(angle), 20.5 + 9 * std::sin(angle), 1});
      if (trial % 2 == 0) rim.back() = {std::round(rim.back().x) + 0.5, std::round(rim.back().y) + 0.5, 1};
    }
    int hits = 0;
    for (int i = 0; i < blades; ++i) {
      const TrianglePlanes planes(
          {hub, rim[static_cast<std::size_t>(i)], rim[static_cast<std::size_t>((i + 1) % blades)]});
      hits += planes.covers(hub.x, hub.y);
    }
    ASSERT_EQ(hits, 1) << "trial " << trial << ", " << blades << " blades";
  }
}

TEST(Coverage, OfASquareOverTheRasterIsEveryPixel) {
  const mesh::TriangleMesh mesh = test::plane(7);
  const std::vector<Surface> surfaces{
      place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, false}})};
  const VisibilityBuffer layout = see(surfaces, Projection::texture(0, 61, 130), 61, 130);
  for (const Visible& v : layout.pixels) EXPECT_EQ(v.surface, 0u);
  EXPECT_EQ(layout.overlapping, 0);
}

} // namespace
} // namespace surfgrad::raster
