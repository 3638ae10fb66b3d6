// Tangents against the npm package `mikktspace`, the code of MikkTSpace's author, bit for bit.
//
// What may differ is what mesh/mikktspace.hpp states: results that are not finite there are (1, 0, 0) here,
// and a vertex with more than 2048 triangles of which some are opposed is averaged whole. The arccosine is
// the C library's here and another there: both come within an ulp of double, which floats of the angle hide.

#include "io/model_file.hpp"
#include "mesh/mikktspace.hpp"
#include "oracles/hard_meshes.hpp"
#include "oracles/oracle.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

namespace surfgrad {
namespace {

using test::HardMesh;

bool same_bits(vec4<float> a, vec4<float> b) {
  return std::bit_cast<std::array<std::uint32_t, 4>>(a) == std::bit_cast<std::array<std::uint32_t, 4>>(b);
}

struct Counts {
  std::size_t corners = 0;
  std::size_t not_finite = 0; ///< of the package's results
  std::size_t different = 0;
};

/// Compares all corners of all meshes; a failure names the first that differs.
Counts compare(const std::vector<HardMesh>& meshes, std::size_t uv_set = 0) {
  std::vector<std::string> files;
  for (const HardMesh& mesh : meshes) files.push_back(test::corners_of(mesh.mesh, uv_set));
  const std::vector<std::vector<vec4<float>>> theirs = test::package_tangents(files);
  Counts counts;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const std::vector<vec4<float>> ours = mesh::generate_tangents(meshes[m].mesh, uv_set).corners;
    EXPECT_EQ(ours.size(), theirs[m].size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
      vec4<float> expected = theirs[m][i];
      ++counts.corners;
      if (!std::isfinite(expected.x) || !std::isfinite(expected.y) || !std::isfinite(expected.z)) {
        ++counts.not_finite;
        expected = {1, 0, 0, expected.w};
      }
      if (same_bits(ours[i], expected)) continue;
      if (counts.different++ == 0)
        ADD_FAILURE() << meshes[m].name << ", corner " << i << ": (" << ours[i].x << ", " << ours[i].y << ", "
                      << ours[i].z << ", " << ours[i].w << ") but the package has (" << expected.x << ", "
                      << expected.y << ", " << expected.z << ", " << expected.w << ")";
    }
  }
  EXPECT_EQ(counts.different, 0u);
  EXPECT_GT(counts.corners, 0u);
  std::printf("  %zu corners, %zu different, %zu not finite in the package\n", counts.corners,
              counts.different, counts.not_finite);
  return counts;
}

std::vector<HardMesh> soups(unsigned count, mesh::TriangleMesh (*make)(unsigned)) {
  std::vector<HardMesh> meshes;
  for (unsigned seed = 0; seed < count; ++seed)
    meshes.push_back({"seed " + std::to_string(seed), make(seed)});
  return meshes;
}

TEST(MikktspacePackage, HasTheTangentsOfHardMeshes) {
  const Counts counts = compare(test::hard_meshes());
  EXPECT_EQ(counts.not_finite, 0u);
}

TEST(MikktspacePackage, HasTheTangentsOfRandomTrianglesOnALattice) {
  const Counts counts = compare(soups(2000, test::lattice_soup));
  // The lattice keeps all numbers small: nothing may hide behind the deviation for what is not finite.
  EXPECT_EQ(counts.not_finite, 0u);
}

TEST(MikktspacePackage, HasTheTangentsOfRandomTrianglesOfExtremeNumbersWhereTheyAreFinite) {
  const Counts counts = compare(soups(2000, test::extreme_soup));
  EXPECT_GT(counts.not_finite, 0u); // else the deviation would not be tested
  EXPECT_LT(counts.not_finite, counts.corners / 2);
}

TEST(MikktspacePackage, HasTheTangentsOfAMillionCorners) {
  const Counts counts = compare({{"torus", test::half_mirrored_torus(420, 400)}});
  EXPECT_GE(counts.corners, 1'000'000u);
}

TEST(MikktspacePackage, HasTheTangentsOfEveryUvSetOfTheSharedMeshes) {
  const std::filesystem::path folder = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared assets at " << folder;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path extension = entry.path().extension();
    if (extension != ".glb" && extension != ".gltf" && extension != ".obj") continue;
    ++files;
    const io::Model model = io::read_model(entry.path());
    for (std::size_t set = 0;; ++set) {
      std::vector<HardMesh> meshes;
      for (const mesh::TriangleMesh& mesh : model.meshes)
        if (set < mesh.uv_sets.size()) meshes.push_back({entry.path().filename().string(), mesh});
      if (meshes.empty()) break;
      std::printf("%s, UV set %zu\n", entry.path().filename().c_str(), set);
      (void)compare(meshes, set);
    }
  }
  EXPECT_GE(files, 24u);
}

} // namespace
} // namespace surfgrad
