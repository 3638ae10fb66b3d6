/// What is interpolated over triangles stays within what is derived from their corners.

#include "gpu/mesh_reach.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <surfgrad/frame.hpp>

#include <array>
#include <cmath>

namespace surfgrad::test {
namespace {

raster::Surface placed(const mesh::TriangleMesh& mesh, vec3<double> scale) {
  return raster::place_mesh(mesh, affine(scaling(scale)), {0, 0, 0}, {{0, true}});
}

/// Frames at random places of all triangles.
void expect_within(const mesh::TriangleMesh& mesh, vec3<double> scale, double least_share) {
  const raster::Surface surface = placed(mesh, scale);
  const gpu::MeshReach reach = gpu::mesh_reach({surface}, 0);
  ASSERT_EQ(reach.slots.size(), 1u);
  Random random(7);
  Worst length_("length of tangents, beyond 1"), along("part along the normal"), tilt("tilt of normals"),
      tangent_tilt("tilt of tangents");
  // What double leaves of a vector at right angles.
  constexpr double rounding = 1e-6; // tangents were float once
  for (long i = 0; i < 100000; ++i) {
    const auto triangle = static_cast<std::uint32_t>(random.integer(static_cast<int>(mesh.triangles.size())));
    const double a = std::sqrt(random.uniform(0, 1)), b = random.uniform(0, 1);
    const std::array<double, 3> w{1 - a, a * (1 - b), a * b};
    vec3<double> n{0, 0, 0}, t{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const vec4<double>& corner = surface.slots[0].tangents[3 * triangle + k];
      n = n + w[k] * surface.normals[mesh.triangles[triangle][k]];
      t = t + w[k] * vec3<double>{corner.x, corner.y, corner.z};
    }
    const vec3<double> flat = raster::triangle_normal(surface, triangle);
    const vec3<double> unit = normalize_or_zero(n);
    const vec3<double> tangent = mikktspace_basis(n, t, 1.0).tangent;
    length_.add(std::max(length(tangent) - 1, 0.0), 0, reach.tangent_length - 1 + rounding, i);
    along.add(dot(tangent, unit), 0, reach.slots[0].along_normal + rounding, i);
    tilt.add(std::acos(std::min(dot(unit, flat), 1.0)), 0, reach.tilt_rad + rounding, i);
    tangent_tilt.add(std::asin(dot(normalize_or_zero(t), unit)), 0,
                     reach.slots[0].tangent_tilt_rad + rounding, i);
  }
  EXPECT_GT(tilt.ratio(), 0.9);
  EXPECT_GT(length_.ratio(), least_share);
}

TEST(MeshReaches, HoldWhatIsInterpolated) {
  expect_within(torus(9, 6), {1, 1, 1}, 0.3);
  expect_within(torus(48, 24), {1, 1, 1}, 0.3);
  expect_within(torus(24, 12), {1, 0.3, 2}, 0.3); // tangents and normals part differently
}

TEST(MeshReaches, KnowNothingOfNormalsThatCancel) {
  mesh::TriangleMesh mesh = plane(1);
  mesh.normals[0] = -mesh.normals[0];
  const gpu::MeshReach reach = gpu::mesh_reach({placed(mesh, {1, 1, 1})}, 0);
  EXPECT_EQ(reach.tangent_length, HUGE_VAL);
  EXPECT_EQ(reach.tilt_rad, HUGE_VAL);
  EXPECT_EQ(reach.slots[0].along_normal, HUGE_VAL);
  // Another material has no such triangle.
  EXPECT_EQ(gpu::mesh_reach({placed(mesh, {1, 1, 1})}, 1).tangent_length, 1);
}

} // namespace
} // namespace surfgrad::test
