#include "diagnostic/error.hpp"
#include "io/model_file.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

namespace surfgrad::io {
namespace {

using nlohmann::json;
using test::Gltf;
using test::TemporaryFolder;
using test::triangle;
using testing::HasSubstr;

json& primitive(Gltf& document) { return document.json["meshes"][0]["primitives"][0]; }

/// The triangle with two targets: 0 lifts vertex 1 by 2 and leans its normal, 1 moves vertex 2 by -3 in x.
/// Target 0 is accessors 4 (POSITION) and 5 (NORMAL), target 1 is accessor 6, sparse.
Gltf morphing_triangle() {
  Gltf document = triangle();
  document.accessor<float>({0, 0, 0, 0, 0, 2, 0, 0, 0}, "VEC3");
  document.accessor<float>({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3");
  document.json["accessors"].push_back(
      {{"componentType", 5126},
       {"count", 3},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 1},
         {"indices", {{"bufferView", document.view<std::uint16_t>({2})}, {"componentType", 5123}}},
         {"values", {{"bufferView", document.view<float>({-3, 0, 0})}}}}}});
  primitive(document)["targets"] = {{{"POSITION", 4}, {"NORMAL", 5}}, {{"POSITION", 6}}};
  return document;
}

Model read(const Gltf& document, const std::vector<double>& weights = {}) {
  const TemporaryFolder folder;
  return read_model(folder.write("model.gltf", document.gltf()), {.morph_weights = weights});
}

/// How far the targets have moved their vertices.
std::pair<float, float> pulled(const mesh::TriangleMesh& mesh) {
  return {mesh.positions[1].z, mesh.positions[2].x};
}
using Pair = std::pair<float, float>;

TEST(GltfMorph, WithoutWeightsTheMeshStandsAsModelled) {
  const mesh::TriangleMesh mesh = read(morphing_triangle()).meshes[0];
  EXPECT_EQ(pulled(mesh), Pair(0, 0));
  EXPECT_EQ(mesh.normals[1].z, 1.0f);
}

TEST(GltfMorph, TheNodesWeightsComeBeforeTheMeshsAndTheCallersBeforeBoth) {
  Gltf document = morphing_triangle();
  document.json["meshes"][0]["weights"] = {0.5, 1};
  EXPECT_EQ(pulled(read(document).meshes[0]), Pair(1, -3));
  document.json["nodes"][0]["weights"] = {1, -0.5};
  EXPECT_EQ(pulled(read(document).meshes[0]), Pair(2, 1.5f));
  EXPECT_EQ(pulled(read(document, {0.25}).meshes[0]), Pair(0.5f, 1.5f));
  EXPECT_EQ(pulled(read(document, {0, 2}).meshes[0]), Pair(0, -6));
}

TEST(GltfMorph, NormalsLeanByTheirOwnDifferencesAndStayUnit) {
  const mesh::TriangleMesh mesh = read(morphing_triangle(), {1, 1}).meshes[0];
  EXPECT_FLOAT_EQ(mesh.normals[1].x, 1 / std::numbers::sqrt2_v<float>);
  EXPECT_FLOAT_EQ(mesh.normals[1].z, 1 / std::numbers::sqrt2_v<float>);
  EXPECT_EQ(mesh.normals[2].z, 1.0f); // target 1 says nothing about normals
}

TEST(GltfMorph, MissingNormalsAreThoseOfTheMorphedTriangles) {
  Gltf document = morphing_triangle();
  primitive(document)["attributes"].erase("NORMAL");
  primitive(document)["targets"][0].erase("NORMAL");
  const mesh::TriangleMesh mesh = read(document, {0.5}).meshes[0];
  // (1, 0, 1) x (0, 1, 0) = (-1, 0, 1)
  for (const vec3<float>& normal : mesh.normals) {
    EXPECT_FLOAT_EQ(normal.x, -1 / std::numbers::sqrt2_v<float>);
    EXPECT_FLOAT_EQ(normal.z, 1 / std::numbers::sqrt2_v<float>);
  }
}

TEST(GltfMorph, GivenTangentsMoveOrStayStale) {
  Gltf document = morphing_triangle();
  primitive(document)["attributes"]["TANGENT"] =
      document.accessor<float>({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, "VEC4");
  const auto tangent = [&] { return read(document, {1}).meshes[0].tangent_spaces.at(0).corners.at(1); };
  EXPECT_EQ(tangent().x, 1.0f);
  EXPECT_EQ(tangent().z, 0.0f);
  primitive(document)["targets"][0]["TANGENT"] =
      document.accessor<float>({0, 0, 0, 0, 0, -1, 0, 0, 0}, "VEC3");
  EXPECT_FLOAT_EQ(tangent().x, 1 / std::numbers::sqrt2_v<float>);
  EXPECT_FLOAT_EQ(tangent().z, -1 / std::numbers::sqrt2_v<float>);
  EXPECT_EQ(tangent().w, -1.0f);
}

TEST(GltfMorph, ObjectsShareAMeshWhereTheirWeightsAreEqual) {
  Gltf document = morphing_triangle();
  document.json["nodes"] = {
      {{"mesh", 0}}, {{"mesh", 0}, {"weights", {1, 0}}}, {{"mesh", 0}}, {{"mesh", 0}, {"weights", {1, 0}}}};
  const Model model = read(document);
  ASSERT_EQ(model.meshes.size(), 2u);
  EXPECT_EQ(pulled(model.meshes[model.objects[0].mesh]), Pair(0, 0));
  EXPECT_EQ(pulled(model.meshes[model.objects[1].mesh]), Pair(2, 0));
  EXPECT_EQ(model.objects[2].mesh, model.objects[0].mesh);
  EXPECT_EQ(model.objects[3].mesh, model.objects[1].mesh);
  EXPECT_EQ(read(document, {1, 0}).meshes.size(), 1u);
}

TEST(GltfMorph, MeshesWithFewerTargetsTakeTheWeightsTheyHaveAUseFor) {
  Gltf document = morphing_triangle();
  json second = document.json["meshes"][0];
  second["primitives"][0]["targets"].erase(1);
  document.json["meshes"].push_back(second);
  document.json["nodes"].push_back({{"mesh", 1}});
  const Model model = read(document, {1, 1});
  EXPECT_EQ(pulled(model.meshes[0]), Pair(2, -3));
  EXPECT_EQ(pulled(model.meshes[1]), Pair(2, 0));
}

/// A good morphing triangle made bad, and what the message must say about it.
struct BadMorph {
  const char* name;
  std::function<void(Gltf&)> spoil;
  std::vector<double> weights;
  std::vector<std::string> fragments;
};

void PrintTo(const BadMorph& bad, std::ostream* out) { *out << bad.name; }

const std::string target_place = "meshes[0].primitives[0].targets";

const std::vector<BadMorph> all_bad_morphs = {
    {"CountOfATarget",
     [](Gltf& d) {
       primitive(d)["targets"][1]["POSITION"] = d.accessor<float>({1, 2, 3}, "VEC3");
     },
     {},
     {target_place + "[1].POSITION", "has 1 elements but POSITION has 3"}},
    {"TypeOfATarget",
     [](Gltf& d) { primitive(d)["targets"][0]["NORMAL"] = 2; },
     {},
     {"accessors[2].type", "VEC2", "VEC3"}},
    {"NotFinite",
     [](Gltf& d) {
       primitive(d)["targets"][1]["POSITION"] =
           d.accessor<float>({0, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 0}, "VEC3");
     },
     {},
     {target_place + "[1].POSITION", "vertex 1 is nan"}},
    {"TangentWithoutBase",
     [](Gltf& d) { primitive(d)["targets"][0]["TANGENT"] = 5; },
     {},
     {target_place + "[0].TANGENT", "does not have"}},
    {"NormalWithoutBase",
     [](Gltf& d) { primitive(d)["attributes"].erase("NORMAL"); },
     {},
     {target_place + "[0].NORMAL", "does not have"}},
    {"AccessorThatIsNotThere",
     [](Gltf& d) { primitive(d)["targets"][0]["POSITION"] = 99; },
     {},
     {target_place + "[0].POSITION", "accessors[99] does not exist"}},
    {"TargetsIsObject",
     [](Gltf& d) { primitive(d)["targets"] = json::object(); },
     {},
     {target_place, "expected an array"}},
    {"WeightsOfTheMesh",
     [](Gltf& d) { d.json["meshes"][0]["weights"] = {1}; },
     {},
     {"meshes[0].weights", "has 1 entries but the mesh has 2 morph targets"}},
    {"WeightsOfTheNode",
     [](Gltf& d) {
       d.json["nodes"][0]["weights"] = {1, 2, 3};
     },
     {},
     {"nodes[0].weights", "has 3 entries but the mesh has 2 morph targets"}},
    {"WeightIsText",
     [](Gltf& d) {
       d.json["nodes"][0]["weights"] = {1, "2"};
     },
     {},
     {"nodes[0].weights[1]", "expected a number"}},
    {"PrimitivesDisagree",
     [](Gltf& d) {
       json other = primitive(d);
       other.erase("targets");
       d.json["meshes"][0]["primitives"].push_back(other);
     },
     {},
     {"meshes[0].primitives[1].targets", "has 0 entries but primitives[0] has 2"}},
    {"TooManyWeights",
     [](Gltf&) {},
     {1, 2, 3},
     {"model.gltf", "at most 2 morph targets but 3 weights are given", "expected at most 2"}},
    {"WeightsWithoutTargets",
     [](Gltf& d) { primitive(d).erase("targets"); },
     {1},
     {"model.gltf", "no morph targets but 1 weights are given"}},
    {"WeightsThatOverflow", [](Gltf&) {}, {1e300}, {target_place, "farther than a number can tell"}},
};

class BadMorphTest : public testing::TestWithParam<BadMorph> {};

TEST_P(BadMorphTest, IsRefusedWithItsPlace) {
  Gltf document = morphing_triangle();
  GetParam().spoil(document);
  std::string message = "it was read";
  try {
    (void)read(document, GetParam().weights);
  } catch (const InputError& error) {
    message = error.what();
  }
  for (const std::string& fragment : GetParam().fragments) EXPECT_THAT(message, HasSubstr(fragment));
}

INSTANTIATE_TEST_SUITE_P(, BadMorphTest, testing::ValuesIn(all_bad_morphs),
                         [](const auto& entry) { return std::string(entry.param.name); });

TEST(GltfMorph, AnObjTakesNoWeights) {
  const TemporaryFolder folder;
  const auto file = folder.write("model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THROW((void)read_model(file, {.morph_weights = {1}}), InputError);
}

} // namespace
} // namespace surfgrad::io
