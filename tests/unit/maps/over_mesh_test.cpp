// Tangent space to object space and back, over a mesh.

#include "maps/over_mesh.hpp"

#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/temporary_folder.hpp"

#include <surfgrad/vec.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>

namespace surfgrad::maps {
namespace {

using surfgrad::test::Random;

/// A quarter of a cylinder about the y axis, unwrapped over the whole map; its normals are smooth.
std::string cylinder() {
  constexpr int steps = 8;
  std::ostringstream obj;
  for (int i = 0; i <= steps; ++i) {
    const double u = static_cast<double>(i) / steps;
    const double x = std::sin(1.5707963267948966 * u);
    const double z = std::cos(1.5707963267948966 * u);
    for (const int v : {0, 1})
      obj << "v " << x << ' ' << v << ' ' << z << "\nvn " << x << " 0 " << z << "\nvt " << u << ' ' << v
          << '\n';
  }
  for (int i = 0; i < steps; ++i) {
    obj << 'f';
    for (const int k : {1, 3, 4, 2}) {
      const int corner = 2 * i + k;
      obj << ' ' << corner << '/' << corner << '/' << corner;
    }
    obj << '\n';
  }
  return obj.str();
}

vec3<double> vector_of(const image::Image& map, int x, int y) {
  return normalize_or_zero(
      vec3<double>{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1});
}

TEST(OverMesh, AFlatMapBecomesTheNormalsOfTheMesh) {
  const surfgrad::test::TemporaryFolder folder;
  const auto model = folder.write("cylinder.obj", cylinder());
  const image::Image flat = surfgrad::test::constant_image(64, 8, {0.5, 0.5, 1});
  const image::Image object = in_other_space(flat, {.model = model, .to_object = true}, "flat.png");
  for (int x = 0; x < 64; ++x) {
    // Normals are interpolated along chords of 11 degrees: at most 0.03 degrees off the circle's.
    const double angle = 1.5707963267948966 * (x + 0.5) / 64;
    EXPECT_LT(surfgrad::test::unit_angle(vector_of(object, x, 4), {std::sin(angle), 0, std::cos(angle)}),
              0.05)
        << x;
  }
}

TEST(OverMesh, ThereAndBackIsTheSameMap) {
  const surfgrad::test::TemporaryFolder folder;
  const auto model = folder.write("cylinder.obj", cylinder());
  Random random(1911);
  const image::Image map = surfgrad::test::random_normal_map(random, 48, 40, 1.5);
  for (const stack::Green green : {stack::Green::up, stack::Green::down}) {
    const image::Image object =
        in_other_space(map, {.model = model, .to_object = true, .green_from = green}, "map.png");
    const image::Image back = in_other_space(object, {.model = model, .green_to = green}, "object.png");
    double worst = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 48; ++x)
        worst = std::max(worst, surfgrad::test::unit_angle(vector_of(back, x, y), vector_of(map, x, y)));
    std::printf("  worst %.3g degrees\n", worst);
    EXPECT_LT(worst, 0.01); // half a code of 16 bits is 0.0009 degrees; frames are those of floats
    // Another convention is another map: the test would see it.
    const image::Image other = in_other_space(
        object,
        {.model = model, .green_to = green == stack::Green::up ? stack::Green::down : stack::Green::up},
        "object.png");
    EXPECT_GT(surfgrad::test::unit_angle(vector_of(other, 7, 9), vector_of(map, 7, 9)), 1);
  }
}

} // namespace
} // namespace surfgrad::maps
