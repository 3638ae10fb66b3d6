// Collapsed texture coordinates, vanished normals and absurd numbers: flagged, flat, never NaN.

#include "lab.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::engine {
namespace {

using test::composed;

bool is_unit_or_zero(vec3<double> n) {
  const double size = length(n);
  return size == 0 || std::abs(size - 1) < 1e-12;
}

struct Degenerate : ::testing::Test {
  static constexpr std::uint64_t seed = 151;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  test::Random random{seed};
  test::Lab lab{};
  std::vector<stack::Layer> kinds = test::one_of_each(lab, random);
  Program vertex = lab.compile({test::normal_layer("a")});
  Program derived = lab.compile({test::normal_layer("a", 0, stack::Basis::derived)});

  static void expect_flat(const Program& program, const raster::Fragment<double>& f, const char* what) {
    const auto c = composed(program, f);
    EXPECT_TRUE(c.degenerate) << what;
    // Normalising the unit normal once more may round each component.
    EXPECT_LT(max_abs(c.normal - c.base_normal), 1e-15) << what;
  }
};

TEST_F(Degenerate, NoFragmentOfOrdinarySurfacesIsFlagged) {
  const Program all = lab.compile(kinds);
  for (int k = 0; k < 300; ++k) EXPECT_FALSE(composed(all, test::random_fragment(random)).degenerate);
}

TEST_F(Degenerate, CollapsedTextureCoordinatesAreFlatAndFlagged) {
  auto f = test::random_fragment(random);
  f.uvs[0].dst_dx = {0, 0};
  expect_flat(derived, f, "one rate zero");
  f.uvs[0].dst_dy = {0, 0};
  expect_flat(derived, f, "both rates zero");
  f.uvs[0].dst_dx = {1e-3, 2e-3};
  f.uvs[0].dst_dy = {-2e-3, -4e-3};
  expect_flat(derived, f, "parallel rates");
  f = test::random_fragment(random);
  f.dp_dx = f.dp_dy = {0, 0, 0};
  expect_flat(derived, f, "no change of position");
}

TEST_F(Degenerate, VanishedVertexTangentsAreFlatAndFlagged) {
  auto f = test::random_fragment(random);
  f.uvs[0].tangent = {0, 0, 0};
  expect_flat(vertex, f, "zero tangent");
  f.normal = {0, 0, 2};
  f.uvs[0].tangent = {0, 0, 1};
  expect_flat(vertex, f, "tangent along the normal");
}

TEST_F(Degenerate, ALaterPassWhoseTangentVanishesIsFlatAndFlagged) {
  // A world-space map turns the normal onto the tangent; no vertex frame is left around it.
  lab.add("x", surfgrad::test::constant_image(1, 1, {1, 0.5, 0.5}));
  auto f = test::random_fragment(random);
  f.normal = normalize_or_zero(vec3<double>{1, 0, 1});
  f.uvs[0].tangent = {1, 0, 0};
  const Program program = lab.compile(
      {test::object_layer("x", stack::Space::world), stack::ResolveLayer{}, test::normal_layer("a")});
  const auto c = composed(program, f);
  EXPECT_TRUE(c.degenerate);
  EXPECT_LT(max_abs(c.normal - vec3<double>{1, 0, 0}), 1e-15);
}

TEST_F(Degenerate, AnAbsentNormalIsFlagged) {
  auto f = test::random_fragment(random);
  f.normal_is_absent = true; // the rasteriser put the triangle's own there
  EXPECT_TRUE(composed(vertex, f).degenerate);
  f.normal = {0, 0, 0};
  f.dp_dx = f.dp_dy = {0, 0, 0};
  f.normal_is_absent = false;
  const auto c = composed(vertex, f);
  EXPECT_TRUE(c.degenerate);
  EXPECT_EQ(max_abs(c.normal), 0);
}

TEST_F(Degenerate, NoNumberOfADocumentMakesNaN) {
  constexpr double numbers[] = {1e308, -1e308, 1e30, 5e-324, -1.0};
  for (const stack::Layer& kind : kinds)
    for (const double a : numbers)
      for (const double b : numbers) {
        stack::Layer layer = kind;
        std::visit(
            [&](auto& l) {
              if constexpr (requires { l.common.scale; }) l.common.scale = a;
              if constexpr (requires { l.map.tile; }) {
                l.map.tile = {b, a};
                l.map.offset = {a, b};
                l.map.rotate_deg = b;
              }
            },
            layer);
        const Program program =
            lab.compile({layer, layer, layer, stack::ResolveLayer{}, layer, stack::ResolveLayer{}, layer});
        for (int k = 0; k < 5; ++k) {
          const auto c = composed(program, test::random_fragment(random));
          EXPECT_TRUE(is_unit_or_zero(c.normal)) << "scale " << a << ", tile " << b;
          EXPECT_FALSE(std::isnan(max_abs(c.surfgrad)));
        }
      }
}

TEST_F(Degenerate, NoZeroOrHugeFragmentMakesNaN) {
  const Program all = lab.compile({kinds[0], kinds[1], kinds[2], stack::ResolveLayer{}, kinds[0], kinds[1]});
  constexpr double sizes[] = {0, 1e-300, 1e-30, 1, 1e30, 1e100};
  constexpr double interpolated[] = {0, 1e-12, 1}; // vertices have unit vectors or zero
  for (const double normal : interpolated)
    for (const double dp : sizes)
      for (const double dst : sizes)
        for (const double tangent : interpolated) {
          auto f = test::random_fragment(random);
          f.normal = normal * f.normal;
          f.dp_dx = dp * f.dp_dx;
          f.dp_dy = dp * f.dp_dy;
          for (auto& uv : f.uvs) {
            uv.dst_dx = dst * uv.dst_dx;
            uv.dst_dy = dst * uv.dst_dy;
            uv.tangent = tangent * uv.tangent;
          }
          const auto c = composed(all, f);
          EXPECT_TRUE(is_unit_or_zero(c.normal)) << normal << " " << dp << " " << dst << " " << tangent;
        }
}

} // namespace
} // namespace surfgrad::engine
