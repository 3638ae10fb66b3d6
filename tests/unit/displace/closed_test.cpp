// A displaced mesh is as closed as the one it was made of, whatever its seams and hard edges.

#include "displace/displace.hpp"
#include "engine/compiler.hpp"
#include "io/model_file.hpp"
#include "mesh/bounds.hpp"
#include "support/closed.hpp"
#include "support/images.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

namespace surfgrad::displace {
namespace {

using double3 = vec3<double>;
using test::open_edges;
using test::widen;

stack::Displace noise_of(double height, double frequency) {
  stack::Displace displace;
  displace.noise.frequency = frequency;
  displace.height = height;
  return displace;
}

/// A cube of side 2 with flat faces: every vertex is one face's own.
mesh::TriangleMesh cube() {
  mesh::TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto corner = [&](double u, double v) {
        std::array<double, 3> p{};
        p[axis] = side;
        p[(axis + 1) % 3] = side * u;
        p[(axis + 2) % 3] = v;
        return double3{p[0], p[1], p[2]};
      };
      test::append_triangle(mesh, corner(-1, -1), corner(1, -1), corner(1, 1));
      test::append_triangle(mesh, corner(-1, -1), corner(1, 1), corner(-1, 1));
    }
  return mesh;
}

/// Noise over a map that repeats, so that a texture seam has different heights on its sides.
struct Bumps {
  Bumps() {
    test::Random random(77);
    image = test::random_image(random, 64, 64, 1);
    displace.map.emplace();
    displace.map->file.path = "bumps";
  }
  engine::TiledMap tiled() {
    return engine::Compiler(slots, maps)
        .tiled(*displace.map, maps.heights(displace.map->file, displace.map->channel));
  }
  image::Image image;
  stack::Displace displace;
  std::vector<raster::UvSlot> slots;
  engine::MapLibrary maps{[this](const std::filesystem::path&) -> const image::Image& { return image; }};
};

TEST(DisplaceClosed, HardEdgesMoveTogetherAndFacesAlongTheirOwnNormals) {
  ASSERT_EQ(open_edges(cube()), 0);
  for (const int levels : {0, 1, 3}) {
    stack::Displace displace = noise_of(0.3, 1.3);
    displace.subdivide = levels;
    const DisplacedMesh displaced = displace::displace(cube(), displace);
    EXPECT_EQ(open_edges(displaced.mesh), 0);
    const int cuts = (1 << levels) - 1;
    EXPECT_EQ(displaced.joined_places, static_cast<std::size_t>(8 + 12 * cuts));
    EXPECT_EQ(displaced.parted_places, 0u);
    for (std::size_t i = 0; i < displaced.mesh.positions.size(); ++i) {
      const double3 rest = widen(displaced.mesh.rest_positions[i]);
      const double3 moved = widen(displaced.mesh.positions[i]) - rest;
      const int sides = (std::abs(rest.x) == 1) + (std::abs(rest.y) == 1) + (std::abs(rest.z) == 1);
      // At an edge of two faces, or a corner of three, the direction leans to all of them alike.
      const double share = dot(moved, rest) / (sides > 0 ? std::sqrt(double(sides)) : 1);
      const double along = std::abs(rest.x) == 1   ? moved.x * rest.x
                           : std::abs(rest.y) == 1 ? moved.y * rest.y
                                                   : moved.z * rest.z;
      if (sides == 1) {
        EXPECT_NEAR(length(moved), std::abs(along), 1e-6);
      }
      if (sides == 3) {
        EXPECT_NEAR(length(moved), std::abs(share), 1e-6);
      }
    }
  }
}

TEST(DisplaceClosed, TextureSeamsOfAMapMeetHalfway) {
  Bumps bumps;
  bumps.displace.map->tile = {1.37, 0.81}; // the sides of the seams read different texels
  bumps.displace.height = 0.1;
  const engine::TiledMap map = bumps.tiled();
  mesh::TriangleMesh torus = test::torus(24, 12);
  // Seams at one place to the bit.
  const auto join = [&](std::size_t to, std::size_t from) {
    torus.positions[to] = torus.positions[from];
    torus.normals[to] = torus.normals[from];
  };
  for (std::size_t j = 0; j <= 12; ++j) join(25 * j + 24, 25 * j);
  for (std::size_t i = 0; i <= 24; ++i) join(25 * 12 + i, i);
  ASSERT_EQ(open_edges(torus), 0);
  const DisplacedMesh displaced = displace::displace(torus, bumps.displace, &map);
  EXPECT_EQ(open_edges(displaced.mesh), 0);
  EXPECT_EQ(displaced.joined_places, 24u + 12 - 1);
  // One normal on both sides: the seam is not seen.
  for (std::size_t j = 0; j <= 12; ++j)
    EXPECT_EQ(max_abs(displaced.mesh.normals[25 * j + 24] - displaced.mesh.normals[25 * j]), 0) << j;
}

TEST(DisplaceClosed, ATextureSeamAtAHardEdgeIsNotSeenInWhateverOrderTheFacesCome) {
  Bumps bumps;
  bumps.displace.height = 0.1;
  const engine::TiledMap map = bumps.tiled();
  for (const bool wall_first : {true, false}) {
    mesh::TriangleMesh mesh;
    const auto wall = [&] { test::append_triangle(mesh, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}); };
    if (wall_first) wall();
    const std::size_t floor = mesh.positions.size();
    test::append_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    test::append_triangle(mesh, {0, 0, 0}, {0, 1, 0}, {-1, 0, 0});
    if (!wall_first) wall();
    mesh.uv_sets.assign(1, std::vector<vec2<float>>(mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const vec3<float> p = mesh.positions[i];
      const bool other_side = i >= floor + 3 && i < floor + 6;
      mesh.uv_sets[0][i] = other_side ? vec2<float>{0.3f + 0.7f * p.y, 0.5f * p.x + 0.1f * p.y}
                                      : vec2<float>{p.x + p.z, p.y + 0.2f * p.z};
    }
    const DisplacedMesh displaced = displace::displace(mesh, bumps.displace, &map);
    const auto normal = [&](std::size_t i) { return widen(displaced.mesh.normals[floor + i]); };
    EXPECT_EQ(max_abs(normal(0) - normal(3)), 0) << wall_first;
    EXPECT_EQ(max_abs(normal(2) - normal(4)), 0) << wall_first;
    EXPECT_GT(max_abs(normal(0) - double3{0, 0, 1}), 0.01) << "no slope to speak of";
  }
}

TEST(DisplaceClosed, SidesOfALeafPartAndAreCounted) {
  mesh::TriangleMesh leaf;
  test::append_triangle(leaf, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  test::append_triangle(leaf, {0, 0, 0}, {0, 1, 0}, {1, 0, 0});
  stack::Displace displace = noise_of(0, 1);
  displace.height = 1;
  displace.level = -2; // noise is at least -1: every vertex moves outwards
  const DisplacedMesh displaced = displace::displace(leaf, displace);
  EXPECT_EQ(displaced.parted_places, 3u);
  EXPECT_EQ(displaced.joined_places, 0u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_GT(displaced.mesh.positions[i].z, 0.5f);
    EXPECT_LT(displaced.mesh.positions[i + 3].z, -0.5f);
  }
}

TEST(DisplaceClosed, DegenerateMeshesStayFinite) {
  mesh::TriangleMesh mesh;
  test::append_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  test::append_triangle(mesh, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}); // no area, no normal
  mesh.positions.push_back({5, 5, 5});                          // in no triangle
  mesh.normals.push_back({0, 0, 0});
  mesh.uv_sets[0].push_back({0, 0});
  for (vec2<float>& st : mesh.uv_sets[0]) st = {0.25f, 0.25f}; // collapsed
  Bumps bumps;
  const engine::TiledMap map = bumps.tiled();
  for (const bool by_map : {false, true}) {
    const DisplacedMesh displaced =
        by_map ? displace::displace(mesh, bumps.displace, &map) : displace::displace(mesh, noise_of(1, 1));
    for (std::size_t i = 0; i < displaced.mesh.positions.size(); ++i) {
      EXPECT_TRUE(std::isfinite(dot(displaced.mesh.positions[i], displaced.mesh.normals[i]))) << i;
    }
    EXPECT_EQ(displaced.mesh.positions.back().x, 5);
  }
  EXPECT_TRUE(displace::displace({}, noise_of(1, 1)).mesh.positions.empty());
}

TEST(DisplaceClosed, SharedModelsStayAsClosedAsTheyAre) {
  const std::filesystem::path folder = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared assets at " << folder;
  Bumps bumps;
  const engine::TiledMap map = bumps.tiled();
  for (const char* name :
       {"mmikk_meshes/LP_Pirate.obj", "mmikk_meshes/Rock_Overgrown_A.obj", "mx_boombox/boombox.glb"}) {
    const mesh::TriangleMesh mesh = io::read_model(folder / name).meshes[0];
    const double size = 2 * mesh::radius(mesh::bounds_of(mesh.positions));
    const long open = open_edges(mesh);
    for (const stack::Edges edges : {stack::Edges::straight, stack::Edges::curved})
      for (const bool by_map : {false, true}) {
        stack::Displace displace = by_map ? bumps.displace : noise_of(1, 30 / size);
        displace.height = 0.01 * size;
        displace.subdivide = 1;
        displace.edges = edges;
        const DisplacedMesh displaced = displace::displace(mesh, displace, by_map ? &map : nullptr);
        std::printf("  %s, %s, %s: %zu places joined, %zu parted, %ld open edges\n", name,
                    by_map ? "map" : "noise", edges == stack::Edges::curved ? "curved" : "straight",
                    displaced.joined_places, displaced.parted_places, open_edges(displaced.mesh));
        // An open edge becomes two. Only where places part may there be more.
        if (displaced.parted_places == 0) {
          EXPECT_EQ(open_edges(displaced.mesh), 2 * open);
        }
      }
  }
}

} // namespace
} // namespace surfgrad::displace
