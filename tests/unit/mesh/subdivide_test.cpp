#include "io/model_file.hpp"
#include "mesh/subdivide.hpp"
#include <surfgrad/trigonometry.hpp>

#include "support/meshes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace surfgrad::mesh {
namespace {

constexpr double epsilon = std::numeric_limits<float>::epsilon();
constexpr EdgeShape shapes[] = {EdgeShape::straight, EdgeShape::curved};

using Bits = std::array<std::uint32_t, 3>;

Bits bits_of(vec3<float> v) {
  // -0 is where 0 is.
  return {std::bit_cast<std::uint32_t>(v.x + 0.0f), std::bit_cast<std::uint32_t>(v.y + 0.0f),
          std::bit_cast<std::uint32_t>(v.z + 0.0f)};
}

/// How many edges, told by the bits of their ends, no other triangle runs along in the other direction.
/// Triangles with two corners at one place have no sides there.
long open_edges(const TriangleMesh& mesh) {
  std::map<std::pair<Bits, Bits>, long> surplus;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Bits a = bits_of(mesh.positions[triangle[i]]);
      const Bits b = bits_of(mesh.positions[triangle[(i + 1) % 3]]);
      if (a < b) ++surplus[{a, b}];
      if (b < a) --surplus[{b, a}];
    }
  long open = 0;
  for (const auto& [edge, count] : surplus) open += std::abs(count);
  return open;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const vec3<double> a = test::widen(mesh.positions[t[0]]);
    const vec3<double> b = test::widen(mesh.positions[t[1]]) - a;
    sum += 0.5 * length(cross(b, test::widen(mesh.positions[t[2]]) - a));
  }
  return sum;
}

/// A torus whose seams are doubled vertices at the same place to the bit, with the same normals.
TriangleMesh closed_torus(int columns, int rows) {
  TriangleMesh mesh = test::torus(columns, rows);
  const auto join = [&](int i, int j, int k, int l) {
    const auto to = static_cast<std::size_t>(j * (columns + 1) + i);
    const auto from = static_cast<std::size_t>(l * (columns + 1) + k);
    mesh.positions[to] = mesh.positions[from];
    mesh.normals[to] = mesh.normals[from];
  };
  for (int j = 0; j <= rows; ++j) join(columns, j, 0, j);
  for (int i = 0; i <= columns; ++i) join(i, rows, i, 0);
  return mesh;
}

TEST(Subdivide, MakesFourTrianglesALevelInThePlaceOfEach) {
  const TriangleMesh mesh = test::plane(2);
  EXPECT_EQ(subdivide(mesh, 0).triangles, mesh.triangles);
  const TriangleMesh once = subdivide(mesh, 1);
  const TriangleMesh thrice = subdivide(mesh, 3);
  EXPECT_EQ(once.triangles.size(), 4 * 8u);
  EXPECT_EQ(once.positions.size(), 25u); // a grid of 4 by 4 cells
  EXPECT_EQ(thrice.positions.size(), 17u * 17u);
  EXPECT_EQ(thrice.normals.size(), 17u * 17u);
  EXPECT_EQ(thrice.uv_sets[0].size(), 17u * 17u);
  ASSERT_EQ(thrice.triangles.size(), 64 * 8u);
  EXPECT_EQ(thrice.material_of_triangle.size(), 64 * 8u);
  for (std::size_t i = 0; i < thrice.triangles.size(); ++i) {
    const auto& t = thrice.triangles[i];
    const auto& parent = mesh.triangles[i / 64];
    const vec3<float> a = mesh.positions[parent[0]];
    const auto turn = [&](vec3<float> p, vec3<float> q, vec3<float> r) { return cross(q - p, r - p).z; };
    EXPECT_EQ(turn(thrice.positions[t[0]], thrice.positions[t[1]], thrice.positions[t[2]]),
              turn(a, mesh.positions[parent[1]], mesh.positions[parent[2]]) / 64);
    for (const std::uint32_t v : t) {
      // Inside its parent, and its texture coordinate still the place in the square.
      const vec3<float> p = thrice.positions[v];
      for (std::size_t e = 0; e < 3; ++e)
        EXPECT_GE(turn(mesh.positions[parent[e]], mesh.positions[parent[(e + 1) % 3]], p), 0);
      EXPECT_EQ(thrice.uv_sets[0][v].x, 0.5f * (p.x + 1));
      EXPECT_EQ(thrice.uv_sets[0][v].y, 0.5f * (p.y + 1));
      EXPECT_EQ(thrice.normals[v].z, 1.0f);
    }
  }
}

TEST(Subdivide, KeepsMaterialsAndSplitsTangentsCornerByCorner) {
  TriangleMesh mesh = test::plane(1);
  mesh.material_of_triangle = {3, 5};
  mesh.tangent_spaces.resize(1);
  mesh.tangent_spaces[0].corners = {{1, 0, 0, -1}, {0, 1, 0, -1}, {0, 0, 1, -1},
                                    {1, 0, 0, 1},  {1, 0, 0, 1},  {-1, 0, 0, 1}};
  const TriangleMesh result = subdivide(mesh, 1);
  EXPECT_EQ(result.material_of_triangle, (std::vector<std::uint32_t>{3, 3, 3, 3, 5, 5, 5, 5}));
  const auto& corners = result.tangent_spaces[0].corners;
  ASSERT_EQ(corners.size(), 24u);
  // By where each corner lies in its parent, as the corners' own tangents say.
  const auto near = [](vec4<float> t, float x, float y, float z, float w) {
    return max_abs(vec3<float>{t.x - x, t.y - y, t.z - z}) < 1e-7f && t.w == w;
  };
  const float h = std::sqrt(0.5f);
  EXPECT_TRUE(near(corners[0], 1, 0, 0, -1));
  EXPECT_TRUE(near(corners[1], h, h, 0, -1));
  EXPECT_TRUE(near(corners[2], h, 0, h, -1));
  EXPECT_TRUE(near(corners[4], 0, 1, 0, -1));
  EXPECT_TRUE(near(corners[8], 0, 0, 1, -1));
  EXPECT_TRUE(near(corners[10], 0, h, h, -1));
  EXPECT_TRUE(near(corners[13], 1, 0, 0, 1));
  EXPECT_TRUE(near(corners[14], 0, 0, 0, 1)); // opposed
  // Corners of the new triangles are where their vertices are.
  for (std::size_t c = 0; c < 12; ++c)
    for (std::size_t d = 0; d < 12; ++d)
      if (result.triangles[c / 3][c % 3] == result.triangles[d / 3][d % 3]) {
        EXPECT_EQ(corners[c].x, corners[d].x);
        EXPECT_EQ(corners[c].y, corners[d].y);
      }
}

TEST(Subdivide, SeamsStayClosedToTheBit) {
  for (const EdgeShape shape : shapes) {
    TriangleMesh mesh = closed_torus(13, 7);
    // Positions without short binary fractions, so that no sum is exact.
    for (vec3<float>& p : mesh.positions) p = {p.x * 0.7137f, p.y * 1.3719f, p.z * 0.9173f};
    ASSERT_EQ(open_edges(mesh), 0);
    for (int level = 1; level <= 3; ++level) EXPECT_EQ(open_edges(subdivide(mesh, level, shape)), 0);
  }
}

/// A cylinder with caps: each rim's vertices are doubled, with the side's normal and the cap's.
TriangleMesh cylinder(int sides) {
  TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  const auto corner = [&](int i, double y) {
    const SinCos<double> turn = sin_cos_turns(static_cast<double>(i % sides) / sides);
    return vec3<double>{turn.sin, y, turn.cos};
  };
  const auto smooth = [&](std::uint32_t vertex) {
    const vec3<double> p = test::widen(mesh.positions[vertex]);
    mesh.normals[vertex] = test::narrow(normalize_or_zero(vec3<double>{p.x, 0, p.z}));
  };
  for (int i = 0; i < sides; ++i) {
    test::append_triangle(mesh, corner(i, -1), corner(i + 1, -1), corner(i + 1, 1));
    test::append_triangle(mesh, corner(i, -1), corner(i + 1, 1), corner(i, 1));
    for (std::uint32_t k = 1; k <= 6; ++k) smooth(static_cast<std::uint32_t>(mesh.positions.size()) - k);
    test::append_triangle(mesh, {0, 1, 0}, corner(i, 1), corner(i + 1, 1));
    test::append_triangle(mesh, {0, -1, 0}, corner(i + 1, -1), corner(i, -1));
  }
  return mesh;
}

TEST(Subdivide, CreasesStayClosedToTheBitAndBulgeHalfway) {
  const TriangleMesh mesh = cylinder(7);
  ASSERT_EQ(open_edges(mesh), 0);
  for (const EdgeShape shape : shapes)
    for (int level = 1; level <= 3; ++level) EXPECT_EQ(open_edges(subdivide(mesh, level, shape)), 0);
  const auto reach = [](const TriangleMesh& m, double y) {
    double least = 1;
    for (const vec3<float>& p : m.positions)
      if (p.y == y && p.x * p.x + p.z * p.z > 0.5f)
        least = std::min(least, std::hypot(double(p.x), double(p.z)));
    return least;
  };
  const TriangleMesh curved = subdivide(mesh, 1, EdgeShape::curved);
  // The cap wants its edge straight, the side bulged: halfway is what both have at the rim.
  const double straight = reach(subdivide(mesh, 1), 1);
  // cos(a) for the half angle a of an edge; the cubic's middle is at cos(a) * (1 + sin(a)^2 / 2).
  const double bulged = straight * (1 + 0.5 * (1 - straight * straight));
  EXPECT_GT(reach(curved, 1), straight);
  EXPECT_NEAR(reach(curved, 1), 0.5 * (straight + bulged), 2 * epsilon);
}

TEST(Subdivide, DoesNotDependOnTheOrderOfCornersAndTriangles) {
  TriangleMesh mesh = test::half_mirrored_torus(10, 9);
  TriangleMesh turned = mesh;
  std::ranges::reverse(turned.triangles);
  for (std::size_t i = 0; i < turned.triangles.size(); ++i) {
    auto& t = turned.triangles[i];
    if (i % 3 == 0) std::swap(t[0], t[1]);
    if (i % 3 == 1) t = {t[2], t[0], t[1]};
  }
  for (const EdgeShape shape : shapes) {
    const auto places = [&](const TriangleMesh& m) {
      const TriangleMesh result = subdivide(m, 2, shape);
      std::vector<std::pair<Bits, Bits>> all;
      for (std::size_t i = 0; i < result.positions.size(); ++i)
        all.emplace_back(bits_of(result.positions[i]), bits_of(result.normals[i]));
      std::ranges::sort(all);
      return all;
    };
    EXPECT_EQ(places(mesh), places(turned));
  }
}

TEST(Subdivide, StraightEdgesKeepTheSurface) {
  const TriangleMesh mesh = closed_torus(20, 12);
  const double before = area(mesh);
  // Each vertex is moved by rounding alone: half an epsilon of coordinates up to 2, at triangles whose
  // heights are a tenth or more.
  for (int level = 1; level <= 4; ++level)
    EXPECT_NEAR(area(subdivide(mesh, level)), before, before * 20 * epsilon * level);
  const TriangleMesh result = subdivide(mesh, 3);
  test::Worst unit("lengths of normals halfway");
  for (std::size_t i = 0; i < result.normals.size(); ++i)
    unit.add(length(test::widen(result.normals[i])), 1, 2 * epsilon, static_cast<long>(i));
}

TEST(Subdivide, CurvedEdgesRunAlongTheCubicBetweenTheTangentPlanes) {
  const std::uint64_t seed = 20260301;
  test::Random random(seed);
  test::Worst positions("middles of cubics, seed " + std::to_string(seed));
  test::Worst normals("normals against the cubic's direction");
  for (long i = 0; i < 2000; ++i) {
    TriangleMesh mesh;
    test::append_triangle(mesh, random.vector3(), random.vector3(), random.vector3());
    for (vec3<float>& n : mesh.normals) n = test::narrow(random.unit_vector());
    const TriangleMesh result = subdivide(mesh, 1, EdgeShape::curved);
    const vec3<double> a = test::widen(mesh.positions[0]);
    const vec3<double> b = test::widen(mesh.positions[1]);
    const vec3<double> na = normalize_or_zero(test::widen(mesh.normals[0]));
    const vec3<double> nb = normalize_or_zero(test::widen(mesh.normals[1]));
    // Vlachos 2001: each inner control point is a third of the way, projected to its end's tangent plane.
    const auto projected = [](vec3<double> p, vec3<double> end, vec3<double> n) {
      return p - dot(p - end, n) * n;
    };
    const vec3<double> p = projected((2.0 / 3) * a + (1.0 / 3) * b, a, na);
    const vec3<double> q = projected((1.0 / 3) * a + (2.0 / 3) * b, b, nb);
    const auto cubic = [&](double t) {
      const double s = 1 - t;
      return s * s * s * a + 3 * s * s * t * p + 3 * s * t * t * q + t * t * t * b;
    };
    const std::uint32_t middle = result.triangles[0][1];
    positions.add(test::widen(result.positions[middle]), cubic(0.5), epsilon, i);
    // Central differences of a cubic miss by its third derivative times h^2 / 6, far below float.
    const vec3<double> along = normalize_or_zero(cubic(0.5 + 1e-5) - cubic(0.5 - 1e-5));
    const vec3<double> mean = normalize_or_zero(na + nb);
    const vec3<double> expected = normalize_or_zero(mean - dot(mean, along) * along);
    // Where the mean nearly runs along the cubic, what is left of it magnifies its rounding.
    const double left = length(mean - dot(mean, along) * along);
    if (left > 1e-2) normals.add(test::widen(result.normals[middle]), expected, epsilon + 1e-9 / left, i);
  }
}

/// Largest distance from the unit sphere.
double off_sphere(const TriangleMesh& mesh) {
  double worst = 0;
  for (const vec3<float>& p : mesh.positions) worst = std::max(worst, std::abs(length(test::widen(p)) - 1));
  return worst;
}

TEST(Subdivide, CurvedEdgesBringASphereBack) {
  double before = 0;
  for (const int rows : {6, 12, 24}) {
    const TriangleMesh mesh = test::sphere_band(2 * rows, rows);
    // The edge of the angle t between its ends: the cubic's middle is at cos(t/2) * (1 + sin(t/2)^2 / 2), so
    // it misses by 3/8 * (t/2)^4 where the chord's misses by (t/2)^2 / 2.
    const double straight = off_sphere(subdivide(mesh, 1));
    const double curved = off_sphere(subdivide(mesh, 1, EdgeShape::curved));
    const double half_angle = std::sqrt(2 * straight);
    std::printf("  %2d rows: straight %.3g curved %.3g\n", rows, straight, curved);
    EXPECT_NEAR(curved, 0.375 * std::pow(half_angle, 4), 0.3 * curved + epsilon);
    if (before > 0) {
      EXPECT_LT(curved, before / 12); // 16 but for the higher terms and rounding
    }
    before = curved;
  }
}

TEST(Subdivide, CurvedNormalsAgreeWithTheSurfaceTheyShape) {
  // On a torus the normals at corners are exact; what the middles get is compared with the torus's own at
  // the nearest point, and so are the normals of the triangles, which know the positions alone.
  const auto worst_angles = [](const TriangleMesh& mesh) {
    double of_vertices = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const vec3<double> p = test::widen(mesh.positions[i]);
      const vec3<double> ring = normalize_or_zero(vec3<double>{p.x, 0, p.z});
      const vec3<double> n = normalize_or_zero(p - ring);
      of_vertices = std::max(of_vertices, length(test::widen(mesh.normals[i]) - n));
    }
    double of_triangles = 0;
    for (const auto& t : mesh.triangles) {
      const vec3<double> a = test::widen(mesh.positions[t[0]]);
      const vec3<double> face = normalize_or_zero(
          cross(test::widen(mesh.positions[t[1]]) - a, test::widen(mesh.positions[t[2]]) - a));
      vec3<double> n{0, 0, 0};
      for (const std::uint32_t v : t) n = n + test::widen(mesh.normals[v]);
      of_triangles = std::max(of_triangles, length(face - normalize_or_zero(n)));
    }
    return std::pair{of_vertices, of_triangles};
  };
  const TriangleMesh mesh = closed_torus(40, 24);
  std::pair<double, double> straight;
  std::pair<double, double> curved;
  for (int level = 0; level <= 4; ++level) {
    straight = worst_angles(subdivide(mesh, level));
    curved = worst_angles(subdivide(mesh, level, EdgeShape::curved));
    std::printf("  level %d: normals off the torus %.3g straight, %.3g curved; faces off their normals %.3g, "
                "%.3g\n",
                level, straight.first, curved.first, straight.second, curved.second);
  }
  // Straight edges leave facets: their normals never agree. Curved ones end in a smooth surface.
  EXPECT_LT(curved.second, straight.second / 4);
  EXPECT_LT(curved.first, straight.first);
}

TEST(Subdivide, ZeroAndOpposedNormalsLeaveNothingThatIsNotFinite) {
  TriangleMesh mesh = test::plane(1);
  mesh.normals = {{0, 0, 0}, {0, 0, 1}, {0, 0, -1}, {1e30f, 0, 0}};
  mesh.positions[2] = mesh.positions[0];
  for (const EdgeShape shape : shapes) {
    const TriangleMesh result = subdivide(mesh, 3, shape);
    for (const vec3<float>& p : result.positions) EXPECT_LE(max_abs(p), 3);
    for (const vec3<float>& n : result.normals) EXPECT_LE(max_abs(n), 1e30f);
  }
  mesh.positions[1] = {std::numeric_limits<float>::max(), 0, 0};
  mesh.positions[3] = {std::numeric_limits<float>::max(), 1, 0};
  for (const vec3<float>& p : subdivide(mesh, 1).positions)
    EXPECT_LE(max_abs(p), std::numeric_limits<float>::max());
}

TEST(Subdivide, RefusesMoreThanItCanNumberBeforeItBegins) {
  const TriangleMesh mesh = test::plane(1);
  EXPECT_THROW((void)subdivide(mesh, 15), MachineError);
  EXPECT_THROW((void)subdivide(mesh, std::numeric_limits<int>::max()), MachineError);
}

TEST(Subdivide, SharedModelsStayAsClosedAndAsLargeAsTheyAre) {
  const std::filesystem::path folder = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared assets at " << folder;
  for (const char* name :
       {"mmikk_meshes/LP_Pirate.obj", "mmikk_meshes/Rock_Overgrown_A.obj", "mx_boombox/boombox.glb",
        "khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb"}) {
    const TriangleMesh mesh = io::read_model(folder / name).meshes[0];
    const TriangleMesh straight = subdivide(mesh, 2);
    const long open = open_edges(mesh);
    std::printf("  %s: %zu triangles, %ld open edges, area %.8g -> %.8g\n", name, mesh.triangles.size(), open,
                area(mesh), area(straight));
    // An open edge becomes four; where two open edges lie on each other they may close.
    EXPECT_EQ(open_edges(straight), 4 * open);
    EXPECT_NEAR(area(straight), area(mesh), 1e-5 * area(mesh));
  }
}

} // namespace
} // namespace surfgrad::mesh
