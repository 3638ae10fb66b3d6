// Cube maps in packs of lanes, their mip levels, and a real one.

#include "image/cube_map.hpp"
#include "io/image_file.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/images.hpp"
#include "support/worst.hpp"

#include <surfgrad/screen.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

namespace surfgrad::image {
namespace {

CubeMap random_cube(test::Random& random, int size) {
  std::array<Image, 6> faces;
  std::array<const Image*, 6> pointers{};
  for (std::size_t f = 0; f < 6; ++f) {
    faces[f] = test::random_image(random, size, size, 3);
    pointers[f] = &faces[f];
  }
  return std::get<CubeMap>(make_cube_map(pointers));
}

TEST(CubeSampling, InPacksEqualsOneLane) {
  using simd::EmulatedFloat;
  using simd::EmulatedMask;
  constexpr float odd[] = {
      std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0, 1, -1, 1e-38f};
  constexpr std::uint64_t seed = 81;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (const int size : {1, 3, 16}) {
    const CubeMap cube = random_cube(random, size);
    for (int k = 0; k < 500; ++k) {
      vec3<EmulatedFloat> d{};
      EmulatedFloat lod{};
      EmulatedMask active{};
      const auto component = [&] {
        return random.integer(4) == 0 ? odd[random.integer(6)] : static_cast<float>(random.uniform());
      };
      for (int i = 0; i < simd::emulated_width; ++i) {
        d.x.lane[i] = component();
        d.y.lane[i] = component();
        d.z.lane[i] = component();
        lod.lane[i] = static_cast<float>(random.uniform(-1, 5));
        active.lane[i] = random.integer(4) != 0;
      }
      const vec3<EmulatedFloat> pack = sample_cube<EmulatedFloat>(cube, d, lod, active);
      for (int i = 0; i < simd::emulated_width; ++i) {
        const vec3<float> one =
            sample_cube<float>(cube, {d.x.lane[i], d.y.lane[i], d.z.lane[i]}, lod.lane[i], active.lane[i]);
        const auto same = [&](float a, float b) {
          EXPECT_EQ(std::bit_cast<std::uint32_t>(a), std::bit_cast<std::uint32_t>(b)) << k << " lane " << i;
          EXPECT_TRUE(std::abs(a) <= 1 && (active.lane[i] || a == 0)) << a;
        };
        same(pack.x.lane[i], one.x);
        same(pack.y.lane[i], one.y);
        same(pack.z.lane[i], one.z);
      }
    }
  }
}

/// Solid angle of a texel of a face of n texels a side around the point st, by differences.
double texel_solid_angle(int face, vec2<double> st, int n) {
  const double h = 1e-5;
  const auto at = [&](double s, double t) {
    return normalize_or_zero(cube_direction(face, {st.x + s, st.y + t}));
  };
  const vec3<double> along_s = (0.5 / h) * (at(h, 0) - at(-h, 0));
  const vec3<double> along_t = (0.5 / h) * (at(0, h) - at(0, -h));
  return 4.0 / (n * n) * length(cross(along_s, along_t));
}

TEST(CubeLod, IsTheAngleOfAPixelInTexels) {
  constexpr std::uint64_t seed = 82;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const CubeMap cube = random_cube(random, 32);
  test::Worst worst("cube lod");
  for (int k = 0; k < 2000; ++k) {
    const int face = random.integer(6);
    const vec2<double> st = random.vector2();
    const double size = random.magnitude(1e-6, 1e6);
    const vec3<double> d = size * cube_direction(face, st);
    const vec3<double> n = normalize_or_zero(d);
    const double footprint = random.magnitude(1e-4, 1e-1);
    const vec3<double> x = normalize_or_zero(cross(n, random.unit_vector()));
    const vec3<double> y = cross(n, x);
    const double squeezed = random.uniform(0, 1);
    const double to_length = footprint * length(d);
    // Along d, the change of length does not count.
    const double got = cube_lod(cube, d, to_length * x + random.uniform() * d,
                                squeezed * to_length * y + random.uniform() * d);
    const double expected = std::log2(footprint / std::sqrt(texel_solid_angle(face, st, 32)));
    worst.add(got, expected, 1e-8, k); // differences: h^2 and eps / h, about 1e-10, over log(2) and twice
  }
}

TEST(CubeLod, OfARoundPixelIsNearThatOfTheFacesOwnCoordinates) {
  constexpr std::uint64_t seed = 86;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const CubeMap cube = random_cube(random, 32);
  test::Worst worst("cube lod against its face's coordinates");
  for (int k = 0; k < 2000; ++k) {
    const vec2<double> st = random.vector2(-0.99, 0.99);
    const vec3<double> d = cube_direction(random.integer(6), st);
    const vec3<double> x = 1e-3 * cross(normalize_or_zero(d), random.unit_vector());
    const vec3<double> y = cross(normalize_or_zero(d), x);
    const auto along = [&](vec3<double> v) { // of the coordinate over [0, 1]
      const double h = 1e-3;
      return (0.25 / h) * (detail::cube_point(d + h * v).st - detail::cube_point(d - h * v).st);
    };
    // An angle is r long in s and t across the radius and r^2 along it; the longer of two axes a right angle
    // apart is between r^1.5 and r^2. The level is that of r^1.5, with r at most sqrt(3).
    worst.add(cube_lod(cube, d, x, y), texture_lod(along(x), along(y), {32, 32}), 0.25 * std::log2(3.0), k);
  }
}

TEST(CubeLod, DoesNotStepOverEdges) {
  constexpr std::uint64_t seed = 83;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const CubeMap cube = random_cube(random, 32);
  test::Worst worst("step of the cube lod over an edge");
  for (int k = 0; k < 1000; ++k) {
    const vec3<double> edge{1, random.uniform(), 1};
    const vec3<double> x = random.vector3();
    const vec3<double> y = random.vector3();
    const double step = 1e-9;
    worst.add(cube_lod(cube, edge + vec3<double>{step, 0, 0}, x, y),
              cube_lod(cube, edge - vec3<double>{step, 0, 0}, x, y), 1e-6, k); // slopes below 100 a unit
  }
}

TEST(CubeLod, IsFiniteWhateverItIsGiven) {
  test::Random random(84);
  const CubeMap cube = random_cube(random, 8);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  const double odd[] = {0, -0.0, 1, -1, 1e-300, 1e300, 5e-324, nan, inf, -inf};
  for (int k = 0; k < 20000; ++k) {
    const auto vector = [&] {
      return vec3<double>{odd[random.integer(10)], odd[random.integer(10)], odd[random.integer(10)]};
    };
    const double lod = cube_lod(cube, vector(), vector(), vector());
    ASSERT_TRUE(std::isfinite(lod)) << k;
  }
  const vec3<double> none{0, 0, 0};
  EXPECT_LT(cube_lod(cube, {1, 2, 3}, none, none), -100);
  EXPECT_LT(cube_lod(cube, none, {1, 0, 0}, {0, 1, 0}), -100);
}

TEST(CubeSampling, ARealMapOfDirectionsGivesThemBack) {
  const std::filesystem::path folder =
      std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets/cube_normal/ogre_nm_cube";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  std::array<Image, 6> faces;
  std::array<const Image*, 6> pointers{};
  const char* names[] = {"rt", "lf", "up", "dn", "fr", "bk"};
  for (std::size_t f = 0; f < 6; ++f) {
    faces[f] = io::read_image(folder / (std::string("nm_") + names[f] + ".png"));
    pointers[f] = &faces[f];
  }
  const CubeMap cube = std::get<CubeMap>(make_cube_map(pointers));
  constexpr std::uint64_t seed = 85;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  test::Worst worst("angle of a real direction map");
  for (int k = 0; k < 50000; ++k) {
    const vec3<double> n = random.unit_vector();
    const vec3<double> got = normalize_or_zero(sample_cube<double>(cube, n, 0.0, true));
    // The file's codes are up to 2.5 of 127.5 off, on each of two axes across the direction.
    worst.add(length(cross(n, got)), 0, std::sqrt(2.0) * 2.5 / 127.5 + 0.25 * 2 / 128, k);
  }
  std::printf("  that is at most %.3f degrees\n",
              worst.ratio() * (std::sqrt(2.0) * 2.5 / 127.5 + 0.25 * 2 / 128) * 57.29577951308232);
}

} // namespace
} // namespace surfgrad::image
