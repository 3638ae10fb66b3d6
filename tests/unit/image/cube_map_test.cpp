// Cube maps: which texel lies in which direction, borders, levels, and what is no cube map.

#include "image/cube_map.hpp"
#include "support/images.hpp"
#include "support/map_texels.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::image {
namespace {

using Faces = std::array<Image, 6>;
constexpr double float_eps = std::numeric_limits<float>::epsilon();

std::variant<CubeMap, CubeFault> make(const Faces& faces) {
  std::array<const Image*, 6> pointers{};
  for (std::size_t f = 0; f < 6; ++f) pointers[f] = &faces[f];
  return make_cube_map(pointers);
}
CubeMap made(const Faces& faces) { return std::get<CubeMap>(make(faces)); }

Faces random_faces(test::Random& random, int size) {
  Faces faces;
  for (Image& face : faces) face = test::random_image(random, size, size, 3);
  return faces;
}

/// Each texel the direction of its centre, in a float file.
Faces direction_faces(int size) {
  Faces faces;
  for (int f = 0; f < 6; ++f) {
    faces[f] = make_image(size, size, 3, Depth::float32);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const vec3<double> n =
            normalize_or_zero(cube_direction(f, {(2 * x + 1.0) / size - 1, (2 * y + 1.0) / size - 1}));
        faces[f].at(x, y, 0) = static_cast<float>(0.5 * n.x + 0.5);
        faces[f].at(x, y, 1) = static_cast<float>(0.5 * n.y + 0.5);
        faces[f].at(x, y, 2) = static_cast<float>(0.5 * n.z + 0.5);
      }
  }
  return faces;
}

vec3<double> unit_texel(const Image& face, int x, int y) {
  return normalize_or_zero(
      vec3<double>{2.0 * face.at(x, y, 0) - 1, 2.0 * face.at(x, y, 1) - 1, 2.0 * face.at(x, y, 2) - 1});
}

TEST(CubeMap, FacesLieAsInTheGraphicsInterfacesTables) {
  // Corners of the cube that the corners of each file show: top left, top right, bottom left, bottom
  // right, from the table "selection of cube map images" of the OpenGL and Vulkan specifications.
  const vec3<double> corners[6][4] = {
      {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {1, -1, -1}}, {{-1, 1, -1}, {-1, 1, 1}, {-1, -1, -1}, {-1, -1, 1}},
      {{-1, 1, -1}, {1, 1, -1}, {-1, 1, 1}, {1, 1, 1}}, {{-1, -1, 1}, {1, -1, 1}, {-1, -1, -1}, {1, -1, -1}},
      {{-1, 1, 1}, {1, 1, 1}, {-1, -1, 1}, {1, -1, 1}}, {{1, 1, -1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, -1}},
  };
  test::Random random(71);
  const Faces faces = random_faces(random, 2);
  const CubeMap cube = made(faces);
  test::Worst worst("texel of a face");
  for (int f = 0; f < 6; ++f)
    for (int k = 0; k < 4; ++k) {
      const int x = k % 2;
      const int y = 1 - k / 2; // Image keeps the bottom row first
      const vec3<double> corner = corners[f][k];
      const vec2<double> st{x == 0 ? -1.0 : 1.0, y == 0 ? -1.0 : 1.0};
      EXPECT_EQ(max_abs(cube_direction(f, st) - corner), 0) << f << " " << k;
      // Halfway from the corner to the face's middle lies the texel's centre.
      const vec3<double> middle = cube_direction(f, {0, 0});
      const vec3<double> centre = 0.5 * (corner + middle);
      worst.add(sample_cube<double>(cube, 3.0 * centre, 0.0, true), unit_texel(faces[f], x, y), float_eps,
                4 * f + k); // a direction rounded to float
    }
}

TEST(CubeMap, GivesADirectionBackInEveryDirection) {
  constexpr std::uint64_t seed = 72;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (const int size : {4, 8, 32, 128}) {
    const CubeMap cube = made(direction_faces(size));
    const double h = 2.0 / size;
    test::Worst inside("direction in a face of " + std::to_string(size));
    test::Worst anywhere("direction anywhere, size " + std::to_string(size));
    double widest = 0;
    const auto check = [&](vec3<double> d, int k) {
      const vec3<double> n = normalize_or_zero(d);
      const vec3<double> got = sample_cube<double>(cube, d, 0.0, true);
      // The bound that sample_cube states, and float texels.
      anywhere.add(length(got - n), 0, h / 4 + h * h + 2 * float_eps, k);
      const detail::CubePoint<double> p = detail::cube_point(d);
      if (max_abs(p.st) < 1 - h / 2) inside.add(length(got - n), 0, h * h / 4 + 2 * float_eps, k);
      widest = std::max(widest, std::asin(std::min(1.0, length(cross(normalize_or_zero(got), n)))));
    };
    for (int k = 0; k < 20000; ++k) {
      check(random.magnitude(1e-3, 1e3) * random.unit_vector(), k);
      vec3<double> edge{random.sign(), random.sign(), random.uniform()};
      if (k % 3 == 1) edge = {edge.x, edge.z, edge.y};
      if (k % 3 == 2) edge = {edge.z, edge.y, edge.x};
      check(edge, k);
      check({random.sign(), random.sign(), random.sign()}, k); // a corner
      const double t = h * random.uniform();
      check({random.sign(), random.sign(), random.sign() * (1 - std::abs(t))}, k); // beside one
    }
    std::printf("  widest angle for faces of %d: %.4f degrees\n", size, widest * 57.29577951308232);
  }
}

TEST(CubeMap, HasNoSeamsWhateverTheFacesHold) {
  constexpr std::uint64_t seed = 73;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  for (const int size : {1, 2, 5, 16}) {
    const CubeMap cube = made(random_faces(random, size));
    test::Worst worst("step over an edge or corner, size " + std::to_string(size));
    const double step = 1e-7;
    for (int k = 0; k < 5000; ++k) {
      vec3<double> edge{random.sign(), random.sign(), k % 4 == 0 ? random.sign() : random.uniform()};
      if (k % 3 == 1) edge = {edge.x, edge.z, edge.y};
      if (k % 3 == 2) edge = {edge.z, edge.y, edge.x};
      const double lod = random.uniform(0, 5);
      const vec3<double> a = sample_cube<double>(cube, edge + step * random.vector3(), lod, true);
      const vec3<double> b = sample_cube<double>(cube, edge + step * random.vector3(), lod, true);
      // Each is within 2 steps of the edge point in face coordinates, size steps in texels, along each
      // axis; texels in [-1, 1] differ by at most 2.
      worst.add(a, b, 8 * size * step, k);
    }
  }
}

TEST(CubeMap, AveragesDirectionsOverAFaceDownToOneTexel) {
  test::Random random(74);
  const int size = 6;
  const Faces faces = random_faces(random, size);
  const CubeMap cube = made(faces);
  EXPECT_EQ(cube.map.level_count, 3);
  EXPECT_EQ(cube.size(0), 6);
  EXPECT_EQ(cube.size(1), 3);
  EXPECT_EQ(cube.size(2), 1);
  test::Worst worst("mean of a face");
  for (int f = 0; f < 6; ++f) {
    vec3<double> sum{0, 0, 0};
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) sum = sum + unit_texel(faces[f], x, y);
    // Three levels round to float.
    worst.add(sample_cube<double>(cube, cube_direction(f, {0, 0}), 2.0, true), (1.0 / 36) * sum,
              2 * float_eps, f);
    // Halfway between two levels.
    const vec3<double> d = cube_direction(f, random.vector2());
    const vec3<double> mean =
        0.5 * (sample_cube<double>(cube, d, 0.0, true) + sample_cube<double>(cube, d, 1.0, true));
    EXPECT_LT(length(sample_cube<double>(cube, d, 0.5, true) - mean), 1e-15);
  }
}

TEST(CubeMap, HasNothingToSayWithoutADirection) {
  test::Random random(75);
  const CubeMap cube = made(random_faces(random, 4));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const vec3<double> d :
       {vec3<double>{0, 0, 0}, {nan, 1, 0}, {1, nan, 0}, {0, 1, nan}, {inf, 1, 0}, {0, -inf, 0}})
    EXPECT_EQ(max_abs(sample_cube<double>(cube, d, 0.0, true)), 0);
  const vec3<double> d{0.3, -0.2, 0.9};
  EXPECT_EQ(max_abs(sample_cube<double>(cube, d, 0.0, false)), 0);
  const vec3<double> level_0 = sample_cube<double>(cube, d, 0.0, true);
  for (const double lod : {nan, -inf, -3.0})
    EXPECT_EQ(max_abs(sample_cube<double>(cube, d, lod, true) - level_0), 0);
  EXPECT_EQ(max_abs(sample_cube<double>(cube, d, inf, true) - sample_cube<double>(cube, d, 2.0, true)), 0);
  for (const double size : {1e-300, 5e-324, 1e300}) // the length does not count, however extreme
    EXPECT_LT(max_abs(sample_cube<double>(cube, {0, size, 0}, 0.0, true) -
                      sample_cube<double>(cube, {0, 1, 0}, 0.0, true)),
              1e-15);
}

/// One image of six faces by a picture of the layout, X Y Z for +x +y +z, x y z for -x -y -z and T for -z
/// turned by 180 degrees; what lies between is black.
Image assembled(const Faces& faces, const std::vector<std::string>& rows) {
  const std::string names = "XxYyZz";
  const int n = faces[0].width;
  const int height = static_cast<int>(rows.size());
  Image image = make_image(n * static_cast<int>(rows[0].size()), n * height, 3, Depth::float32);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < static_cast<int>(rows[row].size()); ++column) {
      const char name = rows[row][column];
      if (name == ' ') continue;
      const Image& face = faces[name == 'T' ? 5 : names.find(name)];
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          for (int c = 0; c < 3; ++c)
            image.at(column * n + x, (height - 1 - row) * n + y, c) =
                name == 'T' ? face.at(n - 1 - x, n - 1 - y, c) : face.at(x, y, c);
    }
  return image;
}

TEST(CubeMap, IsTheSameFromSixImagesStripsAndCrosses) {
  test::Random random(76);
  const Faces faces = random_faces(random, 3);
  const CubeMap six = made(faces);
  for (const std::vector<std::string>& rows : {std::vector<std::string>{"XxYyZz"},
                                               {"X", "x", "Y", "y", "Z", "z"},
                                               {" Y  ", "xZXz", " y  "},
                                               {" Y ", "xZX", " y ", " T "}}) {
    const auto one = make_cube_map(assembled(faces, rows));
    ASSERT_TRUE(std::holds_alternative<CubeMap>(one)) << rows[0];
    EXPECT_EQ(std::get<CubeMap>(one).map.words, six.map.words) << rows[0];
  }
}

TEST(CubeMap, CrossesAreNetsOfTheCube) {
  // Where faces touch in a cross, neighbouring texels show neighbouring directions: it folds to a cube.
  const int n = 16;
  const Faces faces = direction_faces(n);
  for (const std::vector<std::string>& rows :
       {std::vector<std::string>{" Y  ", "xZXz", " y  "}, {" Y ", "xZX", " y ", " T "}}) {
    const Image net = assembled(faces, rows);
    const auto cell = [&](int x, int y) { return rows[rows.size() - 1 - y / n][x / n]; };
    for (int y = 0; y < net.height; ++y)
      for (int x = 0; x < net.width; ++x)
        for (const auto& [i, j] : {std::pair{x + 1, y}, std::pair{x, y + 1}}) {
          if (i >= net.width || j >= net.height || cell(x, y) == ' ' || cell(i, j) == ' ') continue;
          // Texels are 2 / n wide on a cube of unit half side, which only shrinks on the sphere.
          EXPECT_LE(length(unit_texel(net, x, y) - unit_texel(net, i, j)), 2.0 / n)
              << rows[0] << " " << x << " " << y;
        }
  }
}

TEST(CubeMap, RefusesWhatIsNoCube) {
  test::Random random(77);
  const auto fault = [](const auto& result) { return std::get<CubeFault>(result); };
  Faces faces = random_faces(random, 4);
  faces[3] = test::random_image(random, 8, 8, 3);
  EXPECT_EQ(fault(make(faces)).problem, "face -y is 8x8, face +x is 4x4");
  EXPECT_EQ(fault(make(faces)).remedy, "expected six faces of one size");
  EXPECT_EQ(fault(make(faces)).face, 3);
  faces[3] = test::random_image(random, 4, 2, 3);
  EXPECT_EQ(fault(make(faces)).problem, "face -y is 4x2");
  EXPECT_EQ(fault(make(faces)).remedy, "expected a square");
  faces[3] = test::random_image(random, 4, 4, 2);
  EXPECT_EQ(fault(make(faces)).problem, "face -y has 2 channels");
  faces[3] = test::random_image(random, 4, 4, 4); // opacity or not: three channels
  EXPECT_TRUE(std::holds_alternative<CubeMap>(make(faces)));
  faces[5].width = faces[5].height = max_cube_size + 1; // refused before its texels are looked at
  EXPECT_EQ(fault(make(faces)).face, 5);

  for (const auto& [width, height] : {std::pair{8, 8}, {12, 3}, {7, 1}, {2, 1}, {6, 4}, {9, 8}})
    EXPECT_NE(fault(make_cube_map(make_image(width, height, 3))).problem.find("is no layout"),
              std::string::npos)
        << width << "x" << height;
  const CubeFault grey = fault(make_cube_map(make_image(12, 2, 1)));
  EXPECT_EQ(grey.problem, "face +x has 1 channel");
  EXPECT_EQ(grey.face, -1);
}

} // namespace
} // namespace surfgrad::image
