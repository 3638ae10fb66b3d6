// What lanes interpolate from the setup of a triangle is the fragment that the definition makes in double.

#include "raster/interpolate.hpp"
#include "raster/tile_scan.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace surfgrad::raster {
namespace {

constexpr int side = 48;
constexpr int tile_side = 16;

/// Sizes that an attribute's rounding errors are in proportion to.
struct Sizes {
  double value;   ///< most of the attribute at the triangle's corners
  double change;  ///< most of its change per pixel, at both places
  double stretch; ///< 1 / q at the place: how much nearer it lies than the centre, at least 1
};

/// An attribute is at + step / q with step = dx d.x + dy d.y. The setup rounds at, dx, dy and q' once, the
/// lanes round a few times more, each by at most half an epsilon of its part: four roundings of every part
/// are two epsilons. The parts of the step are as large as |d| times the change; q = 1 + q' d is rounded by
/// that of 1 + |q' d|, which divided by q is relative.
double value_bound(const Sizes& s, double d, double qd) {
  return 2 * epsilon_v<float> * (s.value + d * s.change * s.stretch * (1 + (1 + qd) * s.stretch));
}
/// The derivative is (dx - (a - at) q') / q, where (a - at) q' is at most |q' d| / q times the change.
double change_bound(const Sizes& s, double qd) {
  return 2 * epsilon_v<float> * s.change * s.stretch * (1 + qd * s.stretch) * (1 + (1 + qd) * s.stretch);
}

template <class T>
void expect_fragments(const char* name, const std::vector<Surface>& surfaces, const Projection& projection) {
  const std::string what = name;
  test::Worst position(what + ", position"), derivative(what + ", its derivatives"),
      normal(what + ", normal"), st(what + ", texture coordinates"), dst(what + ", their derivatives"),
      tangent(what + ", tangent"), object(what + ", object position");
  Wanted wanted;
  wanted.screen = projection.has_depth();
  wanted.to_viewer = false;
  wanted.slots = static_cast<int>(surfaces[0].slots.size());
  for (std::size_t s = 0; s < surfaces[0].slots.size(); ++s) {
    wanted.present[s] = surfaces[0].slots[s].present;
    wanted.tangents[s] = !surfaces[0].slots[s].tangents.empty();
  }
  const TileGrid grid(surfaces, projection, side, side, tile_side, tile_side);
  TileScan scan;
  TriangleSetup setup;
  for (int tile_number = 0; tile_number < grid.columns() * grid.rows(); ++tile_number) {
    const int column = tile_number % grid.columns();
    const int row = tile_number / grid.columns();
    const Tile tile = grid.tile(column, row);
    scan.scan(surfaces, projection, tile, grid.candidates(column, row), {});
    for (int i = 0; i < tile.width * tile.height; ++i) {
      const int owner = scan.owners()[static_cast<std::size_t>(i)];
      if (owner == TileScan::nothing) continue;
      const TileScan::Shown& shown = scan.shown()[static_cast<std::size_t>(owner)];
      const Surface& surface = surfaces[shown.id.surface];
      const std::uint32_t t = shown.id.triangle;
      const double cx = tile.x + shown.first_pixel % tile.width + 0.5;
      const double cy = tile.y + shown.first_pixel / tile.width + 0.5;
      set_up(surface, t, shown.planes, cx, cy, setup);
      const double x = tile.x + i % tile.width + 0.5;
      const double y = tile.y + i / tile.width + 0.5;
      const std::int32_t which = 0;
      const auto f = interpolate<T>(&setup, &which, wanted, {static_cast<T>(x), static_cast<T>(y)});
      Fragment<double> expected = make_fragment(surface, t, shown.planes, x, y);
      const Fragment<double> centre = make_fragment(surface, t, shown.planes, cx, cy);
      if (!wanted.screen) expected.front_facing = true;
      EXPECT_EQ(static_cast<bool>(f.front_facing), static_cast<bool>(expected.front_facing));

      const vec2<double> q = shown.planes.relative_change(cx, cy);
      const double d = std::abs(x - cx) + std::abs(y - cy);
      const double qd = std::abs(q.x) * std::abs(x - cx) + std::abs(q.y) * std::abs(y - cy);
      const double stretch = std::max(1.0, shown.planes.inverse_w(cx, cy) / shown.planes.inverse_w(x, y));
      const long where = (tile.y + i / tile.width) * side + tile.x + i % tile.width;
      const auto widened = [](const auto& v) { return vec3<double>{v.x, v.y, v.z}; };
      const auto& v = surface.mesh->triangles[t];
      const auto sizes = [&](const auto& corner, vec3<double> dx, vec3<double> dy, vec3<double> centre_dx,
                             vec3<double> centre_dy) {
        return Sizes{std::max({max_abs(corner(0)), max_abs(corner(1)), max_abs(corner(2))}),
                     std::max({max_abs(dx), max_abs(dy), max_abs(centre_dx), max_abs(centre_dy)}), stretch};
      };
      const Sizes of_position = sizes([&](std::size_t k) { return surface.positions[v[k]]; }, expected.dp_dx,
                                      expected.dp_dy, centre.dp_dx, centre.dp_dy);
      position.add(widened(f.position), expected.position, value_bound(of_position, d, qd), where);
      derivative.add(widened(f.dp_dx), expected.dp_dx, change_bound(of_position, qd), where);
      derivative.add(widened(f.dp_dy), expected.dp_dy, change_bound(of_position, qd), where);
      const Sizes of_normal = sizes([&](std::size_t k) { return surface.normals[v[k]]; }, expected.dn_dx,
                                    expected.dn_dy, centre.dn_dx, centre.dn_dy);
      EXPECT_EQ(static_cast<bool>(f.normal_is_absent), static_cast<bool>(expected.normal_is_absent));
      normal.add(widened(f.normal), expected.normal, value_bound(of_normal, d, qd), where);
      // Object space may lie far from the eye: what its corners' sizes are counts, as for the position.
      Sizes of_object = of_position;
      of_object.value = 0;
      for (const std::uint32_t k : v)
        of_object.value = std::max(of_object.value, max_abs(test::widen(surface.mesh->positions[k])));
      object.add(widened(f.object_position), expected.object_position, value_bound(of_object, d, qd), where);
      for (std::size_t s = 0; s < surface.slots.size(); ++s) {
        const auto& got = f.uvs[s];
        const auto& want = expected.uvs[s];
        if (!surface.slots[s].present) {
          EXPECT_EQ(max_abs(vec2<double>{got.st.x, got.st.y}), 0);
          continue;
        }
        const auto corner = [&](std::size_t k) {
          const vec2<double> c = surface.slots[s].st[v[k]];
          return vec3<double>{c.x, c.y, 0};
        };
        const auto lifted = [](vec2<double> c) { return vec3<double>{c.x, c.y, 0}; };
        const Sizes of_st = sizes(corner, lifted(want.dst_dx), lifted(want.dst_dy),
                                  lifted(centre.uvs[s].dst_dx), lifted(centre.uvs[s].dst_dy));
        st.add(vec2<double>{got.st.x, got.st.y}, want.st, value_bound(of_st, d, qd), where);
        dst.add(vec2<double>{got.dst_dx.x, got.dst_dx.y}, want.dst_dx, change_bound(of_st, qd), where);
        dst.add(vec2<double>{got.dst_dy.x, got.dst_dy.y}, want.dst_dy, change_bound(of_st, qd), where);
        if (surface.slots[s].tangents.empty()) continue;
        const auto b = shown.planes.barycentrics(x, y);
        const auto c = shown.planes.barycentrics(cx, cy);
        const auto of_corner = [&](std::size_t k) {
          const vec4<double>& w = surface.slots[s].tangents[3 * static_cast<std::size_t>(t) + k];
          return vec3<double>{w.x, w.y, w.z};
        };
        const auto weighted = [&](const std::array<double, 3>& w) {
          return w[0] * of_corner(0) + w[1] * of_corner(1) + w[2] * of_corner(2);
        };
        const Sizes of_tangent =
            sizes(of_corner, weighted(b.dx), weighted(b.dy), weighted(c.dx), weighted(c.dy));
        tangent.add(widened(got.tangent), want.tangent, value_bound(of_tangent, d, qd), where);
        EXPECT_EQ(static_cast<double>(got.sign), want.sign);
      }
    }
  }
}

template <class T>
class Interpolate : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Interpolate, Scalars);

mat4<double> projection_of(double focal_px) {
  return {{focal_px, 0, -side / 2.0, 0}, {0, focal_px, -side / 2.0, 0}, {0, 0, 0, 0}, {0, 0, -1, 0}};
}

TYPED_TEST(Interpolate, FromTheSetupOfATriangleIsItsFragmentOnAScreen) {
  constexpr std::uint64_t seed = 1511;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  const mesh::TriangleMesh torus = test::half_mirrored_torus(16, 9);
  const std::vector<Surface> surfaces{
      place_mesh(torus, test::affine(random.rotation() * test::scaling({1, -0.6, 1.3}), {3, 1, -2}),
                 {3, 1, 0.4}, {{0, true}, {1, false}}),
      place_mesh(torus, test::affine(random.rotation(), {3, 1, -3}), {3, 1, 0.4}, {{0, true}, {1, false}})};
  expect_fragments<TypeParam>("a torus", surfaces, Projection::camera(projection_of(40), 1e-3));
}

TYPED_TEST(Interpolate, HoldsAcrossLargeTrianglesThatReachBehindTheEye) {
  constexpr std::uint64_t seed = 1512;
  SCOPED_TRACE(seed);
  test::Random random(seed);
  mesh::TriangleMesh mesh;
  for (int i = 0; i < 30; ++i) {
    const vec3<double> c{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-8, 0)};
    const mat3<double> offsets = random.matrix3(-6, 6);
    test::append_triangle(mesh, c + offsets.x, c + offsets.y, c + offsets.z);
  }
  const std::vector<Surface> surfaces{
      place_mesh(mesh, test::affine(test::scaling({1, 1, 1})), {0, 0, 0}, {{0, true}})};
  expect_fragments<TypeParam>("large triangles", surfaces, Projection::camera(projection_of(30), 0.05));
}

TYPED_TEST(Interpolate, FromTheSetupOfATriangleIsItsFragmentInATexture) {
  const mesh::TriangleMesh torus = test::half_mirrored_torus(24, 13);
  const std::vector<Surface> surfaces{
      place_mesh(torus, test::affine(test::scaling({2, 0.3, -1}), {100, 0, 0}), {0, 0, 0}, {{0, true}})};
  expect_fragments<TypeParam>("a texture", surfaces, Projection::texture(0, side, side));
}

} // namespace
} // namespace surfgrad::raster
