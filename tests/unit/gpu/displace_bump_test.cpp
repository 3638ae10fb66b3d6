/// Gustavson's pair of shaders in examples/ (seed 003), as they are and in their own stages: the vertices and
/// normals of `displace`, and the fine noise of the C++ core on top of them.

#include "displace/displace.hpp"
#include "displace_bump_frag.hpp"
#include "displace_bump_vert.hpp"
#include "show_vertex_frag.hpp"
#include "show_vertex_geom.hpp"
#include "support/drawing.hpp"
#include "support/meshes.hpp"
#include "support/software_driver.hpp"
#include "support/worst.hpp"
#include "vertex_to_pixel_geom.hpp"

#include <surfgrad/gradient.hpp>
#include <surfgrad/noise.hpp>
#include <surfgrad/resolve.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace surfgrad::test {
namespace {

using double3 = vec3<double>;

constexpr double eps = epsilon_v<float>;
/// Vulkan rounds five times as far where the documented bounds count roundings of half a unit.
constexpr double vulkan_rounding = 5;

/// Gustavson's figures: a displacement of 0.1 at frequency 2; a bump 1/5 as high that counts by 0.05, at 10.
constexpr double displace_height = 0.1, displace_frequency = 2;
constexpr double bump_height = 0.05 / 5, bump_frequency = 10;

/// clip_from_object and world_from_object: products with powers of two are exact. The second mirrors, and
/// stretches normals up to twofold against each other.
constexpr mat3<double> clip_from_object{{0, 0, 2}, {-0.5, 0, 0}, {0, 1, 0}};
constexpr mat3<double> world_from_object{{0, -2, 0}, {0, 0, 1}, {1, 0, 0}};
constexpr double stretch = 2;

double3 object_from_clip(const Pixel4& clip) { return {-2.0 * clip[1], clip[2], 0.5 * clip[0]}; }

/// Both matrices in the layout std140: columns of four.
std::vector<float> transforms() {
  const auto& c = clip_from_object;
  const auto& w = world_from_object;
  std::vector<float> floats;
  const auto column = [&](double x, double y, double z, double last) {
    for (const double v : {x, y, z, last}) floats.push_back(static_cast<float>(v));
  };
  column(c.x.x, c.y.x, c.z.x, 0);
  column(c.x.y, c.y.y, c.z.y, 0);
  column(c.x.z, c.y.z, c.z.z, 0);
  column(0, 0, 0, 1);
  column(w.x.x, w.y.x, w.z.x, 0);
  column(w.x.y, w.y.y, w.z.y, 0);
  column(w.x.z, w.y.z, w.z.z, 0);
  return floats;
}

constexpr std::uint32_t points = 4096; // one a pixel: the widest target that every device has

/// Points of a sphere, evenly spread along a spiral; no triangles.
mesh::TriangleMesh sphere() {
  mesh::TriangleMesh mesh;
  for (std::uint32_t i = 0; i < points; ++i) {
    const double y = 1 - (2.0 * i + 1) / points;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0)); // the golden angle
    const double r = std::sqrt(1 - y * y);
    mesh.positions.push_back({static_cast<float>(r * std::cos(angle)), static_cast<float>(y),
                              static_cast<float>(r * std::sin(angle))});
  }
  mesh.normals = mesh.positions;
  return mesh;
}

template <class T>
vec3<T> bumped(vec3<T> base, const Noise<T>& noise, double height, double frequency) {
  const Frame<T> frame = make_frame(base);
  return resolve_normal(
      frame, from_volume_gradient(frame.normal, static_cast<T>(height * frequency) * noise.gradient));
}

template <class T>
vec3<T> in_world(vec3<T> normal) {
  const auto& m = world_from_object;
  const auto row = [](const double3& r) {
    return vec3<T>{static_cast<T>(r.x), static_cast<T>(r.y), static_cast<T>(r.z)};
  };
  return normalize_or_zero(transform_normal(mat3<T>{row(m.x), row(m.y), row(m.z)}, normal));
}

/// Length of the error of a normal that a noise bumped, to first order: the base's own error turns the normal
/// and, at most twice, the gradient; the gradient's passes whole; the resolve divides both by at least 1.
///
/// base  of the base normal, a length like the result
double bumped_bound(double base, const Noise<double>& noise, double slope_of_noise) {
  const double slope = slope_of_noise * length(noise.gradient);
  const double component = slope_of_noise * 128 + 4 * slope + 4; // perlin's, the products', resolve_normal's
  return (1 + 2 * slope) * base + vulkan_rounding * std::numbers::sqrt3 * component * eps;
}

/// Of a normal made unit: make_frame's 3 eps a component.
constexpr double unit_bound = vulkan_rounding * std::numbers::sqrt3 * 3 * eps;

/// What the device made of the sphere, and the C++ core's inputs.
class DisplaceBump : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    choose_software_driver();
    base = sphere();
    std::vector<float> vertices;
    for (std::size_t i = 0; i < base.positions.size(); ++i)
      for (const vec3<float>& v : {base.positions[i], base.normals[i]})
        vertices.insert(vertices.end(), {v.x, v.y, v.z});
    Drawing drawing;
    const auto uniforms = transforms();
    Drawing::Picture picture{.size = {points, 1}, .vertices = vertices, .vertex_count = points};
    picture.bound = {{.contents = uniforms}};
    picture.stages = {displace_bump_vert, show_vertex_geom, show_vertex_frag};
    picture.targets = 3;
    shown = drawing.draw(picture);
    picture.stages = {displace_bump_vert, vertex_to_pixel_geom, displace_bump_frag};
    picture.targets = 1;
    colours = drawing.draw(picture)[0];
    for (const std::string& message : drawing.messages()) ADD_FAILURE() << message;
  }

  static double3 position(std::size_t i) { return widen(base.positions[i]); }
  static Noise<double> coarse(std::size_t i) { return perlin(displace_frequency * position(i)); }
  /// At the point that all sides round to: a product is rounded correctly on every device.
  static Noise<double> fine(std::size_t i) {
    return perlin(widen(static_cast<float>(bump_frequency) * base.positions[i]));
  }
  static double3 shown_at(std::size_t target, std::size_t i) {
    const Pixel4& p = shown[target][i];
    return {p[0], p[1], p[2]};
  }
  /// What the geometry stage shortened, at its first length.
  static double3 displaced_normal(std::size_t i) { return (i % 2 == 0 ? 1.0 : 2.0) * shown_at(2, i); }
  static double displaced_normal_bound(std::size_t i) {
    return bumped_bound(unit_bound, coarse(i), displace_height * displace_frequency);
  }
  static double3 world_normal(std::size_t i) {
    const Pixel4& c = colours[i];
    return {2.0 * c[0] - 1, 2.0 * c[1] - 1, 2.0 * c[2] - 1};
  }
  /// The stages follow each other: the second bumps a normal that has the first's error and is made unit
  /// again. Then the transform, at most 8 eps a component, turns errors by `stretch`, and the colour's two
  /// roundings count twice.
  static double world_normal_bound(std::size_t i) {
    const double in_object =
        bumped_bound(displaced_normal_bound(i) + unit_bound, fine(i), bump_height * bump_frequency);
    return stretch * (in_object + vulkan_rounding * std::numbers::sqrt3 * 8 * eps) + unit_bound + 4 * eps;
  }

  inline static mesh::TriangleMesh base;
  inline static std::vector<std::vector<Pixel4>> shown; ///< clip position, undisplaced, displaced normal
  inline static std::vector<Pixel4> colours;
};

TEST_F(DisplaceBump, TheVertexStageMovesVerticesAndTurnsNormalsAsDisplaceDoes) {
  stack::Displace displace;
  displace.noise.function = stack::NoiseKind::perlin;
  displace.noise.frequency = displace_frequency;
  displace.height = displace_height;
  const mesh::TriangleMesh expected = displace::displace(base, displace).mesh;
  Worst positions("displaced positions");
  Worst normals("displaced normals");
  for (std::size_t i = 0; i < base.positions.size(); ++i) {
    const auto where = static_cast<long>(i);
    const double value = std::abs(coarse(i).value);
    // The height times the value's 32 eps and the unit normal's 3; one rounding each of the height's product,
    // of the sum, at most 1.1, and of displace's float.
    const double moved = vulkan_rounding * displace_height * (32 + 4 * value) + 2 * 1.1;
    positions.add(object_from_clip(shown[0][i]), widen(expected.positions[i]), moved * eps, where);
    EXPECT_EQ(shown[0][i][3], 1) << i;
    EXPECT_EQ(max_abs(shown_at(1, i) - position(i)), 0) << "undisplaced, vertex " << i;
    // And displace's float.
    normals.add(displaced_normal(i), widen(expected.normals[i]), displaced_normal_bound(i) + eps / 2, where);
  }
}

TEST_F(DisplaceBump, TheFragmentStageBumpsAsTheCoreDoes) {
  Worst in_double("bumped normals, to double");
  Worst in_float("bumped normals, to float");
  double widest = 0;
  for (std::size_t i = 0; i < base.positions.size(); ++i) {
    const double3 exact = in_world(bumped(bumped(position(i), coarse(i), displace_height, displace_frequency),
                                          fine(i), bump_height, bump_frequency));
    const double bound = world_normal_bound(i);
    in_double.add(world_normal(i), exact, bound, static_cast<long>(i));
    widest = std::max(widest, length(world_normal(i) - exact));

    const vec3<float> p = base.positions[i];
    const vec3<float> once =
        bumped(p, perlin(static_cast<float>(displace_frequency) * p), displace_height, displace_frequency);
    const vec3<float> twice =
        bumped(once, perlin(static_cast<float>(bump_frequency) * p), bump_height, bump_frequency);
    // The core in float errs by a fifth of what a device may.
    in_float.add(world_normal(i), widen(in_world(twice)), bound * (1 + 1 / vulkan_rounding),
                 static_cast<long>(i));
  }
  std::printf("  normals differ by at most %.3g degrees\n", widest * 180 / std::numbers::pi);
}

} // namespace
} // namespace surfgrad::test
