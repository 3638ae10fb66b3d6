#include "io/model_file.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>

namespace surfgrad::io {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Model read(std::string_view text) {
  const TemporaryFolder folder;
  return read_model(folder.write("shape.obj", text));
}

constexpr std::string_view square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                    "vt 0 0\nvt 1 0\nvt 1 0.25\nvt 0 1\n"
                                    "vn 0 0 1\n";

TEST(Obj, PolygonsBecomeFansAndTextureCoordinatesStay) {
  const Model model = read(std::string(square) + "f 1/1/1 2/2/1 3/3/1 4/4/1\n");
  ASSERT_EQ(model.meshes.size(), 1u);
  const mesh::TriangleMesh& mesh = model.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(mesh.uv_sets.size(), 1u);
  EXPECT_EQ(mesh.uv_sets[0][2].y, 0.25f);
  EXPECT_EQ(mesh.normals[3].z, 1.0f);
  ASSERT_EQ(model.objects.size(), 1u);
  EXPECT_EQ(model.objects[0].name, "shape");
  EXPECT_EQ(model.objects[0].world_from_object.z.z, 1.0);
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].name, "default");
  EXPECT_TRUE(model.materials[0].double_sided);
}

TEST(Obj, EveryFormOfIndexNamesTheSameCorner) {
  const std::string all = std::string(square);
  const mesh::TriangleMesh full = read(all + "f 1/1/1 2/2/1 3/3/1").meshes[0];
  const mesh::TriangleMesh backwards = read(all + "f -4/-4/-1 -3/-3/-1 -2/-2/-1").meshes[0];
  const mesh::TriangleMesh no_uv = read(all + "f 1//1 2//1 3//1").meshes[0];
  const mesh::TriangleMesh no_normal = read(all + "f 1/1 2/2 3/3").meshes[0];
  const mesh::TriangleMesh bare = read(all + "f 1 2 3").meshes[0];
  for (const mesh::TriangleMesh* mesh : {&full, &backwards, &no_uv, &no_normal, &bare}) {
    EXPECT_EQ(mesh->triangles, (Triangles{{0, 1, 2}}));
    EXPECT_EQ(mesh->positions[2].y, 1.0f);
    EXPECT_EQ(mesh->normals[1].z, 1.0f);
  }
  EXPECT_EQ(full.uv_sets[0][2].y, 0.25f);
  EXPECT_EQ(backwards.uv_sets[0][2].y, 0.25f);
  EXPECT_EQ(no_normal.uv_sets[0][2].y, 0.25f);
  EXPECT_TRUE(no_uv.uv_sets.empty());
  EXPECT_TRUE(bare.uv_sets.empty());
}

TEST(Obj, CornersWithEqualIndicesShareAVertex) {
  const mesh::TriangleMesh mesh =
      read(std::string(square) + "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\nf 1/2/1 3/3/1 4/4/1").meshes[0];
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {4, 2, 3}}));
}

TEST(Obj, MaterialsAreTheNamesInUse) {
  const Model model =
      read(std::string(square) + "mtllib absent.mtl\nf 1 2 3\nusemtl unused\nusemtl red clay\nf 1 2 3 4\n"
                                 "usemtl default\nf 2 3 4\nusemtl red clay\nf 2 3 4\n");
  std::vector<std::string> names;
  for (const ModelMaterial& material : model.materials) names.push_back(material.name);
  EXPECT_THAT(names, ElementsAre("default", "unused", "red clay"));
  EXPECT_THAT(model.meshes[0].material_of_triangle, ElementsAre(0, 2, 2, 0, 2));
}

TEST(Obj, MissingNormalsAreSmoothOverPositions) {
  // A cube: the mean of three faces, with equal angles whatever the triangulation.
  const mesh::TriangleMesh mesh =
      read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
           "vt 0 0\nvt 1 1\n"
           "f 4/1 3/2 2/1 1/1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 1 5 8 4\nf 2 3 7 6\n")
          .meshes[0];
  const float third = 0.57735027f;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const vec3<float> outward = 2.0f * mesh.positions[v] - vec3<float>{1, 1, 1};
    // A few roundings of the float sum of unit normals.
    EXPECT_NEAR(mesh.normals[v].x, third * outward.x, 1e-6f);
    EXPECT_NEAR(mesh.normals[v].y, third * outward.y, 1e-6f);
    EXPECT_NEAR(mesh.normals[v].z, third * outward.z, 1e-6f);
  }
}

TEST(Obj, CornersWithoutTextureCoordinatesLieAtTheOrigin) {
  const mesh::TriangleMesh mesh =
      read(std::string(square) + "f 1//1 2//1 3//1\nf 2/2/1 3/3/1 4/4/1").meshes[0];
  ASSERT_EQ(mesh.uv_sets.size(), 1u);
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.uv_sets[0][1].x, 0.0f);
  EXPECT_EQ(mesh.uv_sets[0][3].x, 1.0f);
  EXPECT_EQ(read(std::string(square) + "f 2/2/1 3/3/1 4/4/1\nf 1//1 2//1 3//1").meshes[0].uv_sets.size(), 1u);
}

TEST(Obj, LineEndsCommentsContinuationsAndLaterVertices) {
  const mesh::TriangleMesh mesh =
      read("\xEF\xBB\xBF# a comment\r\nf 1 \\\r\n 2 3 # the only face\r\n\r\n"
           "v +1e0\t0 0 1.0\r\nv 0 2.5E-1 0 0.1 0.2 0.3\r\n  v 0 0 1e-60\r\nvp 1\ns off\ng x\n")
          .meshes[0];
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.positions[0].x, 1.0f);
  EXPECT_EQ(mesh.positions[1].y, 0.25f);
  EXPECT_EQ(mesh.positions[2].z, 0.0f);
}

TEST(Obj, NumbersAreReadToTheNearestFloat) {
  const unsigned seed = 90210;
  std::mt19937 random(seed);
  std::string text;
  std::vector<float> expected;
  for (int i = 0; i < 30000; ++i) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    expected.push_back(std::isfinite(value) ? value : 0.0f);
    // From the shortest form to more digits than a double holds.
    std::array<char, 64> digits{};
    const int precision = 8 + i % 16;
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<double>(expected.back()),
                      std::chars_format::scientific, precision);
    text += (i % 3 == 0 ? "v " : " ") + std::string(digits.data(), end.ptr) + (i % 3 == 2 ? "\n" : "");
  }
  // A triangle for every vertex, so that none is left out.
  for (int i = 1; i <= 10000; ++i) text += "f " + std::to_string(i) + " 1 2\n";
  text += "v 0e999 0.0000001e7 1" + std::string(400, '0') + "e-400\nf 10001 1 2\n";
  const mesh::TriangleMesh mesh = read(text).meshes[0];
  for (std::size_t i = 0; i < 10000; ++i) {
    const vec3<float> p = mesh.positions[mesh.triangles[i][0]];
    ASSERT_EQ(p.x, expected[3 * i]) << "seed " << seed << ", vertex " << i;
    ASSERT_EQ(p.y, expected[3 * i + 1]) << "seed " << seed << ", vertex " << i;
    ASSERT_EQ(p.z, expected[3 * i + 2]) << "seed " << seed << ", vertex " << i;
  }
  const vec3<float> last = mesh.positions[mesh.triangles[10000][0]];
  EXPECT_EQ(last.x, 0.0f);
  EXPECT_EQ(last.y, 1.0f);
  EXPECT_EQ(last.z, 1.0f);
}

} // namespace
} // namespace surfgrad::io
