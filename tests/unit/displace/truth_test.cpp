// Seed 003's claim: the gradient of the height gives the normals of the displaced surface. Against the
// displaced surface itself, as a function and as a mesh.

#include "displace/displace.hpp"
#include "engine/compiler.hpp"
#include "engine/reference.hpp"
#include "io/model_file.hpp"
#include "mesh/bounds.hpp"
#include "mesh/normals.hpp"
#include "mesh/places.hpp"
#include "mesh/subdivide.hpp"
#include "support/images.hpp"
#include "support/meshes.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace surfgrad::displace {
namespace {

using double3 = vec3<double>;
using test::widen;

constexpr double degrees = 180 / std::numbers::pi;

double angle_between(double3 a, double3 b) { return std::atan2(length(cross(a, b)), dot(a, b)) * degrees; }

/// Two octaves whose waves are about as long as the surfaces are wide.
stack::Displace noise_of(double height) {
  stack::Displace displace;
  displace.noise.function = stack::NoiseKind::fractal_sum;
  displace.noise.octaves = 2;
  displace.noise.frequency = 1.7;
  displace.height = height;
  return displace;
}

/// A surface over (s, t), and its mesh.
struct Surface {
  const char* name;
  test::SurfacePoint (*point)(double, double);
  mesh::TriangleMesh (*mesh)(int, int);
  double size;
};

const Surface surfaces[] = {
    {"sphere",
     [](double s, double t) {
       const double u = 2 * std::numbers::pi * s;
       const double v = std::numbers::pi * 0.4 * (2 * t - 1);
       const double3 n{std::cos(v) * std::sin(u), std::sin(v), std::cos(v) * std::cos(u)};
       return test::SurfacePoint{n, n};
     },
     test::sphere_band, 2},
    {"torus", test::torus_point, test::torus, 2.8},
};

/// Normal of p + h n by central differences: of order four, step 1e-3, so good to about 1e-10.
double3 true_normal(const Surface& surface, const std::function<double(double, double)>& height, double s,
                    double t) {
  const auto point = [&](double a, double b) {
    const test::SurfacePoint p = surface.point(a, b);
    return p.position + height(a, b) * p.normal;
  };
  constexpr double d = 1e-3;
  const double3 ds = 8.0 * (point(s + d, t) - point(s - d, t)) - (point(s + 2 * d, t) - point(s - 2 * d, t));
  const double3 dt = 8.0 * (point(s, t + d) - point(s, t - d)) - (point(s, t + 2 * d) - point(s, t - 2 * d));
  return normalize_or_zero(cross(ds, dt));
}

/// Mean angle in degrees between the displaced mesh's normals and the displaced surface's.
double mean_error(const Surface& surface, const mesh::TriangleMesh& displaced,
                  const std::function<double(double, double)>& height) {
  double sum = 0;
  for (std::size_t i = 0; i < displaced.normals.size(); ++i) {
    const vec2<double> st = widen(displaced.uv_sets[0][i]);
    sum += angle_between(widen(displaced.normals[i]), true_normal(surface, height, st.x, st.y));
  }
  return sum / static_cast<double>(displaced.normals.size());
}

double noise_at(const stack::Displace& displace, double3 p) {
  return displace.height *
         fractal_sum(displace.noise.frequency * p, Fractal<double>{.octaves = displace.noise.octaves}).value;
}

TEST(DisplaceTruth, NormalsOfANoiseAreThoseOfTheDisplacedSurfaceButForAQuadraticNeglect) {
  for (const Surface& surface : surfaces) {
    double before = 0;
    for (const double percent : {1.0, 0.5, 0.25}) {
      const stack::Displace displace = noise_of(0.01 * percent * surface.size);
      const DisplacedMesh displaced = displace::displace(surface.mesh(48, 24), displace);
      const double error = mean_error(surface, displaced.mesh, [&](double s, double t) {
        return noise_at(displace, surface.point(s, t).position);
      });
      std::printf("  %s at %.2f %%: %.5f degrees mean\n", surface.name, percent, error);
      if (percent == 1) {
        EXPECT_LT(error, 0.5);
      }
      // Four times less for half the height, but for the next term, which is of the order of the height, and
      // for float normals, good to 4e-6 degrees.
      if (before > 0) {
        EXPECT_NEAR(before / error, 4, 0.15) << surface.name;
      }
      before = error;
    }
  }
}

TEST(DisplaceTruth, VerticesOfANoiseLieOnTheDisplacedSurface) {
  for (const Surface& surface : surfaces) {
    const stack::Displace displace = noise_of(0.1);
    const mesh::TriangleMesh base = surface.mesh(32, 16);
    const DisplacedMesh displaced = displace::displace(base, displace);
    test::Worst worst(std::string("vertices on the displaced ") + surface.name);
    for (std::size_t i = 0; i < base.positions.size(); ++i) {
      const double3 p = widen(base.positions[i]);
      // Float positions up to 1.5, each moved and rounded once, and a float normal times 0.1.
      worst.add(widen(displaced.mesh.positions[i]), p + noise_at(displace, p) * widen(base.normals[i]), 2e-7,
                static_cast<long>(i));
    }
    EXPECT_EQ(displaced.mesh.rest_positions.size(), base.positions.size());
    EXPECT_EQ(widen(displaced.mesh.rest_positions[7]).x, widen(base.positions[7]).x);
    EXPECT_TRUE(displaced.mesh.tangent_spaces.empty());
  }
}

/// Vertex normals of the triangles, across seams too.
std::vector<vec3<float>> geometric_normals(const mesh::TriangleMesh& mesh) {
  const mesh::Places places =
      mesh::places_of(mesh.rest_positions.empty() ? mesh.positions : mesh.rest_positions);
  std::vector<vec3<float>> positions(places.count);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) positions[places.of_vertex[i]] = mesh.positions[i];
  auto triangles = mesh.triangles;
  for (auto& triangle : triangles)
    for (std::uint32_t& vertex : triangle) vertex = places.of_vertex[vertex];
  const std::vector<vec3<float>> joined = mesh::generate_normals(positions, triangles);
  std::vector<vec3<float>> normals;
  for (const std::uint32_t place : places.of_vertex) normals.push_back(joined[place]);
  return normals;
}

double mean_off_geometry(const mesh::TriangleMesh& mesh) {
  const std::vector<vec3<float>> geometry = geometric_normals(mesh);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    if (max_abs(geometry[i]) == 0 || max_abs(mesh.normals[i]) == 0) continue;
    sum += angle_between(widen(mesh.normals[i]), widen(geometry[i]));
    ++count;
  }
  return sum / static_cast<double>(count);
}

TEST(DisplaceTruth, NormalsNearThoseOfTheTrianglesAsTheMeshIsRefined) {
  for (const Surface& surface : surfaces) {
    double before = 0;
    for (const int rows : {16, 32, 64}) {
      const DisplacedMesh displaced = displace::displace(surface.mesh(2 * rows, rows), noise_of(0.002));
      const double error = mean_off_geometry(displaced.mesh);
      std::printf("  %s, %d rows: %.4f degrees mean off the triangles'\n", surface.name, rows, error);
      if (before > 0) {
        // Half the distance at least; borders are seen from one side and converge no faster.
        EXPECT_LT(error, 0.55 * before);
      }
      before = error;
    }
  }
}

/// Hills over the unit square that repeat.
double hills(vec2<double> st) {
  constexpr double turn = 2 * std::numbers::pi;
  return 0.5 + 0.25 * std::sin(turn * 2 * st.x) + 0.25 * std::cos(turn * (st.x + st.y));
}

TEST(DisplaceTruth, NormalsOfAMapAreThoseOfTheDisplacedSurface) {
  constexpr int side = 256;
  image::Image image = image::make_image(side, side, 1, image::Depth::float32);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      image.at(x, y, 0) = static_cast<float>(hills({(x + 0.5) / side, (y + 0.5) / side}));
  stack::Displace displace;
  displace.map.emplace();
  displace.map->file.path = "hills";
  displace.map->tile = {2, -1};
  displace.map->rotate_deg = 90;
  displace.map->offset = {0.3, 0.1};
  displace.level = 0.5;
  displace.height = 0.004;
  engine::MapLibrary maps([&](const std::filesystem::path&) -> const image::Image& { return image; });
  const std::vector<raster::UvSlot> slots;
  const engine::TiledMap map =
      engine::Compiler(slots, maps)
          .tiled(*displace.map, maps.heights(displace.map->file, displace.map->channel));
  const auto height = [&](double s, double t) {
    // st' = R(90 degrees) (2 s, -t) + offset
    return displace.height * (hills({t + 0.3, 2 * s + 0.1}) - 0.5);
  };
  for (const Surface& surface : surfaces) {
    double before = 0;
    for (const int rows : {32, 64, 128}) {
      const mesh::TriangleMesh base = surface.mesh(2 * rows, rows);
      const DisplacedMesh displaced = displace::displace(base, displace, &map);
      const double error = mean_error(surface, displaced.mesh, height);
      std::printf("  %s, %d rows: %.4f degrees mean\n", surface.name, rows, error);
      // Falls to what is left: the curvature times the height, 0.004 at most, of slopes of a third of a
      // degree.
      EXPECT_LT(error, before > 0 ? 0.9 * before : 0.005);
      before = error;
    }
    EXPECT_LT(before, 0.002) << surface.name;
  }
}

TEST(DisplaceTruth, ABumpOfTheSameFunctionHasTheSameNormals) {
  const mesh::TriangleMesh base = test::torus(24, 12);
  const stack::Displace displace = noise_of(0.05);
  const DisplacedMesh displaced = displace::displace(base, displace);
  stack::NoiseLayer layer;
  layer.noise = displace.noise;
  layer.common.scale = displace.height;
  const std::vector<raster::UvSlot> slots;
  engine::MapLibrary maps([](const std::filesystem::path&) -> const image::Image& { std::abort(); });
  const engine::Program program = engine::compile({layer}, slots, maps);
  const engine::Placement placement = engine::place(test::affine(test::scaling({1, 1, 1})), {0, 0, 0});
  test::Worst worst("bump against displacement");
  for (std::size_t i = 0; i < base.positions.size(); ++i) {
    raster::Fragment<double> fragment{};
    fragment.position = fragment.object_position = widen(base.positions[i]);
    fragment.normal = widen(base.normals[i]);
    fragment.front_facing = true; // pixels of no size: nothing is filtered
    const auto bumped = engine::compose_reference(program, fragment, BackFaces::same, placement);
    // The displaced mesh's normals are rounded to float.
    worst.add(widen(displaced.mesh.normals[i]), bumped.normal, 7e-8, static_cast<long>(i));
  }
}

TEST(DisplaceTruth, OnTheRockOnlyTheExcessOverItsFacetsCountsAndItFalls) {
  const std::filesystem::path file =
      std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets/mesh/mmikk_meshes/Rock_Overgrown_A.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared asset " << file;
  // Smooth: normals over the places, edges curved along them.
  mesh::TriangleMesh rock = io::read_model(file).meshes[0];
  rock.normals = geometric_normals(rock);
  rock = mesh::subdivide(rock, 1, mesh::EdgeShape::curved);
  const double size = 2 * mesh::radius(mesh::bounds_of(rock.positions));
  const double zero = mean_off_geometry(rock);
  std::printf("  without displacement: %.3f degrees mean\n", zero);
  double before = 0;
  for (const double percent : {1.0, 0.5, 0.25}) {
    stack::Displace displace = noise_of(0.01 * percent * size);
    displace.noise.frequency = 8 / size;
    const double excess = mean_off_geometry(displace::displace(rock, displace).mesh) - zero;
    std::printf("  %.2f %%: %.4f degrees more\n", percent, excess);
    if (before > 0) {
      EXPECT_LT(std::abs(excess), 0.75 * before);
    }
    before = std::abs(excess);
  }
}

} // namespace
} // namespace surfgrad::displace
