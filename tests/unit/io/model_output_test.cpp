#include "diagnostic/error.hpp"
#include "io/model_file.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace surfgrad::io {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

namespace support = surfgrad::test;

const std::filesystem::path mesh_folder = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh";

constexpr mat4<double> identity{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

Model model_of(mesh::TriangleMesh mesh) {
  Model model;
  model.meshes.push_back(std::move(mesh));
  model.objects.push_back({"thing", 0, identity});
  model.materials.push_back({.name = "clay"});
  return model;
}

/// The model as read back from a file.
Model round_trip(const Model& model, const std::string& name = "model.glb") {
  const TemporaryFolder folder;
  write_model(folder.path() / name, model);
  return read_model(folder.path() / name);
}

/// Texture coordinates pass 1 - t twice. Each rounds by at most 2^-24 of its result; the two together by
/// 2^-24 * (|1 - t| + |t|), or where t < 0 by the first alone, for there the second is exact.
void expect_same_uvs(const std::vector<std::vector<vec2<float>>>& actual,
                     const std::vector<std::vector<vec2<float>>>& expected, support::Worst& worst) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t set = 0; set < actual.size(); ++set) {
    ASSERT_EQ(actual[set].size(), expected[set].size());
    for (std::size_t i = 0; i < actual[set].size(); ++i) {
      const vec2<float> a = actual[set][i];
      const vec2<float> e = expected[set][i];
      EXPECT_EQ(a.x, e.x);
      worst.add(a.y, e.y, 0x1p-23 * std::max(1.0, std::abs(static_cast<double>(e.y))), static_cast<long>(i));
    }
  }
}

void expect_same_mesh(const mesh::TriangleMesh& actual, const mesh::TriangleMesh& expected,
                      support::Worst& worst) {
  EXPECT_TRUE(same_bits(actual.positions, expected.positions));
  EXPECT_TRUE(same_bits(actual.normals, expected.normals));
  EXPECT_EQ(actual.triangles, expected.triangles);
  expect_same_uvs(actual.uv_sets, expected.uv_sets, worst);
  ASSERT_EQ(mesh::has_tangents(actual, 0), mesh::has_tangents(expected, 0));
  if (mesh::has_tangents(actual, 0)) {
    EXPECT_TRUE(same_bits(actual.tangent_spaces[0].corners, expected.tangent_spaces[0].corners));
  }
}

bool same_transform(const mat4<double>& a, const mat4<double>& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

std::string error_of(const auto& run) {
  try {
    run();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ModelOutput, ReadsBackEveryMeshObjectAndMaterial) {
  support::Random random(20260101);
  Model model;
  for (const int columns : {4, 8, 300}) {
    mesh::TriangleMesh mesh = support::half_mirrored_torus(columns, columns);
    mesh.uv_sets.emplace_back();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      mesh.uv_sets[1].push_back(support::narrow(random.vector2(-40, 40)));
    const std::size_t material = model.meshes.size() % 2;
    std::ranges::fill(mesh.material_of_triangle, static_cast<std::uint32_t>(material));
    model.meshes.push_back(std::move(mesh));
  }
  EXPECT_GT(model.meshes[2].positions.size(), 65536u);
  model.materials = {{.name = "clay"}, {.name = "Blätter \"2\"", .double_sided = true}};
  // Shared meshes under rotations, shears and mirrors; the names tell them apart.
  for (std::size_t i = 0; i < 6; ++i) {
    mat3<double> m = random.matrix3(-3, 3);
    if (i == 0) m = support::scaling({-1, 1, 1});
    model.objects.push_back(
        {"object " + std::to_string(i), i % 3, support::affine(m, random.vector3(-9, 9))});
  }
  for (const char* name : {"model.glb", "model.gltf", "MODEL.GLB"}) {
    SCOPED_TRACE(name);
    const Model read = round_trip(model, name);
    ASSERT_EQ(read.meshes.size(), 3u);
    support::Worst worst("texture coordinates read back");
    for (std::size_t i = 0; i < 3; ++i) {
      expect_same_mesh(read.meshes[i], model.meshes[i], worst);
      EXPECT_EQ(read.meshes[i].material_of_triangle, model.meshes[i].material_of_triangle);
    }
    ASSERT_EQ(read.objects.size(), model.objects.size());
    for (std::size_t i = 0; i < read.objects.size(); ++i) {
      EXPECT_EQ(read.objects[i].name, model.objects[i].name);
      EXPECT_EQ(read.objects[i].mesh, model.objects[i].mesh);
      EXPECT_TRUE(same_transform(read.objects[i].world_from_object, model.objects[i].world_from_object)) << i;
    }
    ASSERT_EQ(read.materials.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(read.materials[i].name, model.materials[i].name);
      EXPECT_EQ(read.materials[i].double_sided, model.materials[i].double_sided);
    }
  }
}

TEST(ModelOutput, TextureCoordinatesOfEverySizeComeBackWithinTheirBound) {
  const std::uint64_t seed = 20260102;
  support::Random random(seed);
  mesh::TriangleMesh mesh = support::plane(100);
  for (vec2<float>& st : mesh.uv_sets[0])
    st = support::narrow(random.sign() *
                         vec2<double>{random.magnitude(1e-9, 1e6), random.magnitude(1e-9, 1e6)});
  const Model read = round_trip(model_of(mesh));
  support::Worst worst("texture coordinates of all sizes, seed " + std::to_string(seed));
  expect_same_uvs(read.meshes[0].uv_sets, mesh.uv_sets, worst);
}

TEST(ModelOutput, KeepsTheTangentsOfTheFirstSet) {
  mesh::TriangleMesh mesh = support::plane(2);
  mesh.tangent_spaces.resize(1);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      mesh.tangent_spaces[0].corners.push_back({0.6f, 0.8f, 0, vertex % 2 == 0 ? 1.0f : -1.0f});
  const Model read = round_trip(model_of(mesh));
  support::Worst worst("texture coordinates beside tangents");
  expect_same_mesh(read.meshes[0], mesh, worst);
}

TEST(ModelOutput, DoublesVerticesWhoseTrianglesDisagreeAboutTheTangent) {
  mesh::TriangleMesh mesh = support::plane(3);
  mesh.tangent_spaces.resize(1);
  for (std::size_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner)
    mesh.tangent_spaces[0].corners.push_back({1, 0, 0, corner / 3 % 2 == 0 ? 1.0f : -1.0f});
  const Model model = model_of(mesh);
  const mesh::TriangleMesh read = round_trip(model).meshes[0];
  EXPECT_TRUE(same_bits(read.tangent_spaces[0].corners, mesh.tangent_spaces[0].corners));
  ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
  std::size_t moved = 0;
  for (std::size_t i = 0; i < read.triangles.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = read.triangles[i][c];
      const std::uint32_t e = mesh.triangles[i][c];
      if (a != e) ++moved;
      EXPECT_EQ(read.positions[a].x, mesh.positions[e].x);
      EXPECT_EQ(read.positions[a].y, mesh.positions[e].y);
      EXPECT_EQ(read.uv_sets[0][a].x, mesh.uv_sets[0][e].x);
    }
  EXPECT_GT(moved, 0u);
  // Each of the 16 vertices has triangles of both kinds but the two corners that the diagonals leave out.
  EXPECT_EQ(read.positions.size(), 16u + 14u);
}

TEST(ModelOutput, LeavesOutTangentsOfOtherSets) {
  mesh::TriangleMesh mesh = support::plane(1);
  mesh.uv_sets.push_back(mesh.uv_sets[0]);
  mesh.tangent_spaces.resize(2);
  mesh.tangent_spaces[1].corners.assign(6, {1, 0, 0, 1});
  EXPECT_TRUE(round_trip(model_of(mesh)).meshes[0].tangent_spaces.empty());
}

TEST(ModelOutput, MakesOnePrimitiveAMaterial) {
  mesh::TriangleMesh mesh = support::plane(2);
  mesh.material_of_triangle = {2, 0, 2, 2, 0, 0, 2, 2};
  Model model = model_of(mesh);
  model.materials = {{.name = "a"}, {.name = "unused"}, {.name = "c"}};
  const Model read = round_trip(model);
  ASSERT_EQ(read.meshes.size(), 2u);
  ASSERT_EQ(read.objects.size(), 2u);
  const auto& t = mesh.triangles;
  EXPECT_EQ(read.meshes[0].triangles, (decltype(mesh.triangles){t[1], t[4], t[5]}));
  EXPECT_EQ(read.meshes[1].triangles, (decltype(mesh.triangles){t[0], t[2], t[3], t[6], t[7]}));
  EXPECT_EQ(read.meshes[0].material_of_triangle[0], 0u);
  EXPECT_EQ(read.meshes[1].material_of_triangle[0], 2u);
  EXPECT_EQ(read.materials[1].name, "unused");
  EXPECT_TRUE(same_bits(read.meshes[1].positions, mesh.positions));
}

TEST(ModelOutput, ReplacesWhatIsNotUtf8InNames) {
  Model model = model_of(support::plane(1));
  model.materials[0].name = "gr\xFC"
                            "n";
  model.objects[0].name = "M\xE4"
                          "dchen";
  const Model read = round_trip(model);
  EXPECT_EQ(read.materials[0].name, "gr\uFFFDn");
  EXPECT_EQ(read.objects[0].name, "M\uFFFDdchen");
}

TEST(ModelOutput, RefusesOtherExtensionsAndFoldersThatAreNotThere) {
  const TemporaryFolder folder;
  const Model model = model_of(support::plane(1));
  for (const char* name : {"model.obj", "model", "model.png"}) {
    const auto file = folder.path() / name;
    EXPECT_THAT(error_of([&] { check_model_output(file); }), HasSubstr("expected .glb or .gltf"));
    EXPECT_THAT(error_of([&] { write_model(file, model); }), HasSubstr("expected .glb or .gltf"));
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  EXPECT_THAT(error_of([&] { check_model_output(folder.path() / "none" / "a.glb"); }),
              HasSubstr("does not exist"));
  EXPECT_NO_THROW(check_model_output(folder.path() / "a.glb"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.glb"));
}

TEST(ModelOutput, RefusesNumbersThatAreNotFiniteAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  const auto file = folder.write("model.glb", "old");
  Model model = model_of(support::plane(1));
  model.meshes[0].positions[2].y = std::numeric_limits<float>::infinity();
  EXPECT_THAT(error_of([&] { write_model(file, model); }), HasSubstr("meshes[0].POSITION: vertex 2 is inf"));
  model.meshes[0].positions[2].y = 0;
  model.meshes[0].normals[1].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error_of([&] { write_model(file, model); }), HasSubstr("meshes[0].NORMAL: vertex 1 is nan"));
  model.meshes[0].normals[1].z = 1;
  model.objects[0].world_from_object.x.w = std::numeric_limits<double>::infinity();
  EXPECT_THAT(error_of([&] { write_model(file, model); }), HasSubstr("object \"thing\""));
  EXPECT_EQ(std::filesystem::file_size(file), 3u);
}

TEST(ModelOutput, RefusesAModelThatBreaksItsPromises) {
  const auto refuses = [](const auto& damage) {
    Model model = model_of(support::plane(1));
    damage(model);
    EXPECT_THROW((void)encode_model(model, ModelFormat::glb), std::invalid_argument);
  };
  refuses([](Model& m) { m.objects[0].mesh = 1; });
  refuses([](Model& m) { m.meshes[0].normals.pop_back(); });
  refuses([](Model& m) { m.meshes[0].uv_sets[0].pop_back(); });
  refuses([](Model& m) { m.meshes[0].triangles[1][2] = 4; });
  refuses([](Model& m) { m.meshes[0].material_of_triangle[0] = 1; });
  refuses([](Model& m) { m.meshes[0].material_of_triangle.pop_back(); });
  refuses([](Model& m) { m.meshes[0].tangent_spaces = {{{{1, 0, 0, 1}}}}; });
}

TEST(ModelOutput, SharedModelsComeBack) {
  if (!std::filesystem::exists(mesh_folder)) GTEST_SKIP() << "no shared assets at " << mesh_folder;
  support::Worst worst("texture coordinates of shared models");
  for (const char* name : {"khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb",
                           "khr_NegativeScaleTest/NegativeScaleTest.glb", "khr_MultiUVTest/MultiUVTest.glb",
                           "pc_house/house.glb", "mmikk_meshes/Rock_Overgrown_A.obj"}) {
    SCOPED_TRACE(name);
    const Model model = read_model(mesh_folder / name);
    const Model read = round_trip(model);
    ASSERT_EQ(read.meshes.size(), model.meshes.size());
    for (std::size_t i = 0; i < read.meshes.size(); ++i)
      expect_same_mesh(read.meshes[i], model.meshes[i], worst);
    ASSERT_EQ(read.objects.size(), model.objects.size());
    for (std::size_t i = 0; i < read.objects.size(); ++i) {
      EXPECT_EQ(read.objects[i].mesh, model.objects[i].mesh);
      EXPECT_TRUE(same_transform(read.objects[i].world_from_object, model.objects[i].world_from_object));
    }
  }
}

} // namespace
} // namespace surfgrad::io
