// The attribute TANGENT that add_tangents writes, and that it leaves all else of a document as it was.

#include "io/model_tangents.hpp"

#include "diagnostic/error.hpp"
#include "io/model_file.hpp"
#include "mesh/mikktspace.hpp"
#include "support/meshes.hpp"
#include "unit/io/glb_file.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <string>

namespace surfgrad::io {
namespace {

using nlohmann::json;
using test::Glb;
using test::Gltf;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

namespace support = surfgrad::test;

ModelWithTangents tangents_of(const Gltf& document, const TangentOptions& options = {}) {
  const TemporaryFolder folder;
  return add_tangents(folder.write("model.gltf", document.gltf()), options);
}

std::string error_of(const Gltf& document, const TangentOptions& options = {}) {
  try {
    (void)tangents_of(document, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// What read_model makes of the file.
Model read_back(const ModelWithTangents& written) {
  const TemporaryFolder folder;
  return read_model(folder.write("out.glb", written.glb));
}

/// Two quads beside each other that share two vertices, the texture of the second one mirrored.
Gltf mirrored_quads() {
  Gltf document;
  document.accessor<float>({0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0}, "VEC3");
  document.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  document.accessor<float>({0, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC2");
  document.accessor<std::uint8_t>({0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4}, "SCALAR");
  document.mesh({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}}});
  return document;
}

TEST(ModelTangents, AreGltfsWithWUpInTheTexture) {
  const Glb file(tangents_of(test::triangle()).glb);
  const json& attributes = file.document["meshes"][0]["primitives"][0]["attributes"];
  // u grows along x and v along y. v runs down in the texture, so up is -y, against cross(NORMAL, TANGENT).
  const auto tangents = file.elements<float>(attributes["TANGENT"]);
  ASSERT_EQ(tangents.size(), 12u);
  for (std::size_t i = 0; i < 12; i += 4) EXPECT_EQ(tangents[i + 3], -1);
}

TEST(ModelTangents, SplitVerticesWhereTheTextureMirrors) {
  const ModelWithTangents written = tangents_of(mirrored_quads());
  EXPECT_EQ(written.vertices, 8u);
  EXPECT_EQ(written.split_vertices, 2u);
  EXPECT_EQ(written.triangles, 4u);
  const Glb file(written.glb);
  const json& primitive = file.document["meshes"][0]["primitives"][0];
  EXPECT_THAT(file.elements<std::uint16_t>(primitive["indices"]),
              ElementsAre(0, 1, 4, 0, 4, 3, 6, 2, 5, 6, 5, 7));
  const auto tangents = file.elements<vec4<float>>(primitive["attributes"]["TANGENT"]);
  for (const std::size_t v : {0, 1, 3, 4}) EXPECT_EQ(tangents[v].x, 1) << v;
  for (const std::size_t v : {2, 5, 6, 7}) EXPECT_EQ(tangents[v].x, -1) << v;
  for (const std::size_t v : {0, 1, 3, 4}) EXPECT_EQ(tangents[v].w, 1) << v;
  for (const std::size_t v : {2, 5, 6, 7}) EXPECT_EQ(tangents[v].w, -1) << v;
}

TEST(ModelTangents, ReadBackAsTheyAreMade) {
  const TemporaryFolder folder;
  Model model;
  model.meshes.push_back(support::half_mirrored_torus(20, 12));
  model.materials.push_back({.name = "clay"});
  model.objects.push_back({"torus", 0, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
  write_model(folder.path() / "in.glb", model);
  const Model before = read_model(folder.path() / "in.glb");
  const Model after = read_back(add_tangents(folder.path() / "in.glb"));
  const auto expected = mesh::generate_tangents(before.meshes.at(0), 0).corners;
  const auto& actual = after.meshes.at(0).tangent_spaces.at(0).corners;
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    ASSERT_EQ((std::bit_cast<std::array<std::uint32_t, 4>>(actual[i])),
              (std::bit_cast<std::array<std::uint32_t, 4>>(expected[i])))
        << i;
}

TEST(ModelTangents, GoWithTheUvSetOfTheNormalTexture) {
  Gltf document = test::triangle();
  const std::size_t turned = document.accessor<float>({0, 0, 0, 1, 1, 0}, "VEC2");
  json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_1"] = turned;
  primitive["material"] = 0;
  document.json["images"] = {{{"bufferView", document.view(std::string_view("\x89PNG\r\n not decoded"))},
                              {"mimeType", "image/png"}}};
  document.json["textures"] = {{{"source", 0}}};
  const auto tangent_x = [&](const TangentOptions& options = {}) {
    const Glb file(tangents_of(document, options).glb);
    return file.elements<float>(file.document["meshes"][0]["primitives"][0]["attributes"]["TANGENT"])[0];
  };
  document.json["materials"] = {{{"normalTexture", {{"index", 0}, {"texCoord", 1}}}}};
  EXPECT_EQ(tangent_x(), 0); // u of set 1 runs along y
  EXPECT_NE(tangent_x({.uv_set = 0}), 0);
  document.json["materials"][0]["normalTexture"]["texCoord"] = 0;
  EXPECT_NE(tangent_x(), 0);
  EXPECT_EQ(tangent_x({.uv_set = 1}), 0);
  document.json["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["texCoord"] = 1;
  EXPECT_EQ(tangent_x(), 0);
}

TEST(ModelTangents, ReplaceThoseThatAreThereAndDropTheirMorphing) {
  Gltf document = mirrored_quads();
  json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TANGENT"] = document.accessor<float>(std::vector<float>(24, 0.5f), "VEC4");
  primitive["targets"] = {
      {{"POSITION", 0}, {"TANGENT", document.accessor<float>(std::vector<float>(18, 0.25f), "VEC3")}}};
  const ModelWithTangents written = tangents_of(document);
  EXPECT_EQ(written.replaced, 1u);
  const Glb file(written.glb);
  const json& result = file.document["meshes"][0]["primitives"][0];
  EXPECT_EQ(file.elements<vec4<float>>(result["attributes"]["TANGENT"])[0].x, 1);
  EXPECT_FALSE(result["targets"][0].contains("TANGENT"));
  EXPECT_EQ(file.elements<vec3<float>>(result["targets"][0]["POSITION"]).size(), 8u); // split with the base
  EXPECT_EQ(file.document["accessors"].size(), document.json["accessors"].size());    // written over
}

TEST(ModelTangents, MoveEveryAttributeWithItsVertex) {
  Gltf document = mirrored_quads();
  json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  const std::vector<std::uint8_t> colours{0,  1,  2,  10, 11, 12, 20, 21, 22,
                                          30, 31, 32, 40, 41, 42, 50, 51, 52};
  // Three bytes a vertex do not lie at multiples of four: the source has gaps, and so must the result.
  std::vector<std::uint8_t> spaced;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    spaced.push_back(colours[i]);
    if (i % 3 == 2) spaced.push_back(99);
  }
  const std::size_t view =
      document.view(std::string_view(reinterpret_cast<const char*>(spaced.data()), spaced.size()), 4);
  document.json["accessors"].push_back({{"bufferView", view},
                                        {"componentType", 5121},
                                        {"normalized", true},
                                        {"count", 6},
                                        {"type", "VEC3"},
                                        {"name", "paint"},
                                        {"extras", {{"by", "hand"}}}});
  attributes["COLOR_0"] = document.json["accessors"].size() - 1;
  std::vector<std::uint16_t> joints(24);
  std::iota(joints.begin(), joints.end(), std::uint16_t{0});
  attributes["JOINTS_0"] = document.accessor<std::uint16_t>(joints, "VEC4");
  const Glb file(tangents_of(document).glb);
  const json& result = file.document["meshes"][0]["primitives"][0]["attributes"];
  const json& paint = file.document["accessors"][result["COLOR_0"].get<std::size_t>()];
  EXPECT_EQ(paint["name"], "paint");
  EXPECT_EQ(paint["extras"]["by"], "hand");
  EXPECT_EQ(paint["normalized"], true);
  EXPECT_EQ(file.document["bufferViews"][paint["bufferView"].get<std::size_t>()]["byteStride"], 4);
  const auto bytes = file.elements<std::uint8_t>(result["COLOR_0"]);
  ASSERT_EQ(bytes.size(), 32u);
  const std::size_t source[] = {0, 1, 2, 3, 4, 5, 1, 4};
  const auto moved = file.elements<std::uint16_t>(result["JOINTS_0"]);
  for (std::size_t v = 0; v < 8; ++v) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(bytes[4 * v + c], colours[3 * source[v] + c]);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(moved[4 * v + c], joints[4 * source[v] + c]);
  }
}

TEST(ModelTangents, KeepWhatElseTheDocumentHolds) {
  Gltf document = mirrored_quads();
  document.json["asset"]["copyright"] = "me";
  document.json["extensionsUsed"] = {"VENDOR_thing"};
  document.json["extensions"]["VENDOR_thing"] = {{"accessor", 5}, {"deep", {{"list", {1, 2.5, "x"}}}}};
  document.json["extras"] = {{"note", "\u00e4"}};
  document.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  document.json["nodes"].push_back({{"camera", 0}, {"name", "eye"}});
  document.json["nodes"][0]["skin"] = 0;
  const std::size_t times = document.accessor<float>({0, 1}, "SCALAR");
  const std::size_t pinned = document.accessor<float>({7, 8}, "SCALAR"); // 5: what the extension names
  ASSERT_EQ(pinned, 5u);
  const std::size_t moves = document.accessor<float>({0, 0, 0, 0, 1, 0}, "VEC3");
  document.json["animations"] = {
      {{"samplers", {{{"input", times}, {"output", moves}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  std::vector<float> matrix(16, 0.0f);
  for (const std::size_t i : {0, 5, 10, 15}) matrix[i] = 1;
  document.json["accessors"].push_back(
      {{"bufferView", document.view(matrix)}, {"componentType", 5126}, {"count", 1}, {"type", "MAT4"}});
  const std::size_t bind = document.json["accessors"].size() - 1;
  document.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", bind}}};
  const std::string png = "\x89PNG\r\n\x1a\n not decoded";
  document.json["images"] = {{{"uri", "maps/a%20b.png"}, {"name", "paint"}}, {{"uri", "notes.bmp"}}};

  const TemporaryFolder folder;
  folder.write("maps/a b.png", png);
  folder.write("notes.bmp", "BM whatever");
  std::vector<std::string> warnings;
  TangentOptions options;
  options.report.warning = [&](std::string_view text) { warnings.emplace_back(text); };
  const Glb file(add_tangents(folder.write("model.gltf", document.gltf()), options).glb);

  for (const char* key :
       {"asset", "extensionsUsed", "extensions", "extras", "cameras", "nodes", "animations", "skins"})
    EXPECT_EQ(file.document[key], document.json[key]) << key;
  for (const std::size_t kept : {times, pinned, moves}) {
    json accessor = file.document["accessors"][kept];
    EXPECT_EQ(accessor, document.json["accessors"][kept]);
    const json& view = document.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    EXPECT_EQ(file.view(accessor["bufferView"]),
              document.buffer.substr(view["byteOffset"], view["byteLength"]));
  }
  EXPECT_EQ(file.elements<float>(bind), matrix);
  const json& image = file.document["images"][0];
  EXPECT_EQ(image["name"], "paint");
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_FALSE(image.contains("uri"));
  EXPECT_EQ(file.view(image["bufferView"]), png);
  EXPECT_EQ(file.document["images"][1], document.json["images"][1]);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("images[1]"));
}

TEST(ModelTangents, MakeListsOfStripsAndFlatNormalsWhereThereAreNone) {
  Gltf document;
  document.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1, 5, 5, 5}, "VEC3");
  document.accessor<float>({0, 1, 1, 1, 0, 0, 1, 0, 5, 5}, "VEC2");
  document.accessor<std::uint16_t>({0, 1, 2, 3}, "SCALAR");
  document.mesh({{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}, {"indices", 2}, {"mode", 5}}});
  const ModelWithTangents written = tangents_of(document);
  EXPECT_EQ(written.vertices, 6u); // the last is of no triangle
  const Glb file(written.glb);
  const json& primitive = file.document["meshes"][0]["primitives"][0];
  EXPECT_FALSE(primitive.contains("mode"));
  const auto normals = file.elements<vec3<float>>(primitive["attributes"]["NORMAL"]);
  const auto tangents = file.elements<vec4<float>>(primitive["attributes"]["TANGENT"]);
  ASSERT_EQ(normals.size(), 6u);
  EXPECT_EQ(normals[0].z, 1);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(dot(normals[i], {tangents[i].x, tangents[i].y, tangents[i].z}), 0, 2e-7); // three products
  const json& bounds = file.document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(bounds["max"], json({1, 1, 1}));
}

TEST(ModelTangents, OfAPrimitiveThatSharesItsVerticesAreItsOwn) {
  Gltf document = mirrored_quads();
  const std::size_t first = document.accessor<std::uint8_t>({0, 1, 4}, "SCALAR");
  json primitive = document.json["meshes"][0]["primitives"][0];
  primitive["indices"] = first;
  primitive["mode"] = 1; // lines: they keep the shared vertices
  document.json["meshes"][0]["primitives"].push_back(primitive);
  primitive.erase("mode");
  document.json["meshes"][0]["primitives"].push_back(primitive);
  const ModelWithTangents written = tangents_of(document);
  EXPECT_EQ(written.meshes, 2u);
  const Glb file(written.glb);
  const json& lines = file.document["meshes"][0]["primitives"][1];
  EXPECT_EQ(lines, document.json["meshes"][0]["primitives"][1]);
  EXPECT_EQ(file.document["accessors"][0], document.json["accessors"][0]);
  EXPECT_EQ(file.elements<std::uint8_t>(lines["indices"]).size(), 3u);
  const json& triangle = file.document["meshes"][0]["primitives"][2];
  EXPECT_EQ(file.elements<vec3<float>>(triangle["attributes"]["POSITION"]).size(), 3u);
}

TEST(ModelTangents, ThatVanishAreSomeUnitVector) {
  Gltf document;
  document.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  document.accessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3"); // along +s: nothing is left of it
  document.accessor<float>({0, 1, 1, 1, 0, 0}, "VEC2");
  document.accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
  document.mesh({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}}});
  const ModelWithTangents written = tangents_of(document);
  EXPECT_EQ(written.arbitrary_tangents, 3u);
  const Glb file(written.glb);
  const auto tangents =
      file.elements<vec4<float>>(file.document["meshes"][0]["primitives"][0]["attributes"]["TANGENT"]);
  ASSERT_EQ(tangents.size(), 3u);
  for (const vec4<float>& t : tangents) {
    EXPECT_EQ(t.x, 0);
    EXPECT_EQ(length(vec3<float>{t.x, t.y, t.z}), 1);
  }
}

TEST(ModelTangents, OfAnObjComeWithItsMeshAndMaterials) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                               "usemtl clay\nf 1/1 2/2 3/3 4/4\n");
  const Model model = read_back(add_tangents(file));
  EXPECT_EQ(model.materials.at(0).name, "clay");
  for (const vec4<float>& t : model.meshes.at(0).tangent_spaces.at(0).corners) {
    EXPECT_EQ(t.x, 1);
    EXPECT_EQ(t.w, 1);
  }
}

TEST(ModelTangents, OfMeshesWithoutTheSetAreLeftOutOrRefused) {
  Gltf document = test::triangle();
  document.json["meshes"].push_back(
      {{"name", "rope"},
       {"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 3}}}}});
  std::vector<std::string> warnings;
  TangentOptions options;
  options.report.warning = [&](std::string_view text) { warnings.emplace_back(text); };
  const ModelWithTangents written = tangents_of(document, options);
  EXPECT_EQ(written.meshes, 1u);
  EXPECT_EQ(written.without_uv, 1u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("meshes[1].primitives[0] (\"rope\") has no UV set 0"));
  EXPECT_EQ(Glb(written.glb).document["meshes"][1], document.json["meshes"][1]);

  EXPECT_THAT(error_of(document, {.uv_set = 0}),
              HasSubstr("meshes[1].primitives[0] (\"rope\"): has no UV set 0; unwrap it, or name no set"));
  EXPECT_THAT(error_of(document, {.uv_set = 3}),
              HasSubstr("meshes[0].primitives[0]: has no UV set 3; it has set 0 only"));
  document.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  EXPECT_THAT(error_of(document), HasSubstr("no mesh has the UV set"));
  document.json["meshes"][0]["primitives"][0]["mode"] = 0;
  document.json["meshes"][1]["primitives"][0]["mode"] = 0;
  EXPECT_THAT(error_of(document), HasSubstr("has no mesh of triangles"));
}

TEST(ModelTangents, OfDamagedDocumentsAreRefused) {
  Gltf counts = test::triangle();
  counts.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      counts.accessor<float>({1, 1, 1, 1}, "VEC4");
  EXPECT_THAT(error_of(counts), HasSubstr("meshes[0].primitives[0].COLOR_0: has 1 elements"));
  Gltf image = test::triangle();
  image.json["images"] = {{{"uri", "gone.png"}}};
  EXPECT_THAT(error_of(image), HasSubstr("images[0].uri: "));
  image.json["images"] = {{{"uri", "../up.png"}}};
  EXPECT_THAT(error_of(image), HasSubstr("leaves the model's folder"));
  Gltf deep = test::triangle();
  const TemporaryFolder folder;
  std::string text = deep.gltf();
  text.insert(text.rfind('}'), ", \"extras\": " + std::string(100'000, '[') + std::string(100'000, ']'));
  EXPECT_THROW((void)add_tangents(folder.write("deep.gltf", text)), InputError);
  EXPECT_THROW((void)add_tangents(folder.path() / "gone.glb"), InputError);
  EXPECT_THROW((void)add_tangents(folder.write("a.stl", "solid")), InputError);
}

TEST(ModelTangents, DropDataForDecodersThatLieBesideThePlainData) {
  Gltf document = mirrored_quads();
  document.json["extensionsUsed"] = {"EXT_meshopt_compression", "KHR_draco_mesh_compression"};
  const json compressed = {{"buffer", 1},      {"byteOffset", 0}, {"byteLength", 4},
                           {"byteStride", 12}, {"count", 6},      {"mode", "ATTRIBUTES"}};
  for (json& view : document.json["bufferViews"]) view["extensions"]["EXT_meshopt_compression"] = compressed;
  document.json["bufferViews"][0]["extensions"]["VENDOR_other"] = json::object();
  const std::string uri = "data:application/octet-stream;base64,";
  document.json["buffers"] = {{{"byteLength", document.buffer.size()},
                               {"uri", uri + test::base64(document.buffer)},
                               {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}},
                              {{"byteLength", 3}, {"uri", uri + test::base64("abc")}}};
  json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                           {"attributes", {{"POSITION", 0}}}};
  const Glb file(tangents_of(document).glb);
  ASSERT_EQ(file.document["buffers"].size(), 1u);
  EXPECT_FALSE(file.document["buffers"][0].contains("extensions"));
  EXPECT_FALSE(file.document["meshes"][0]["primitives"][0].contains("extensions"));
  EXPECT_EQ(file.document["bufferViews"][0]["extensions"], json({{"VENDOR_other", json::object()}}));
  for (std::size_t i = 1; i < file.document["bufferViews"].size(); ++i)
    EXPECT_FALSE(file.document["bufferViews"][i].contains("extensions")) << i;
}

TEST(ModelTangents, DoNotDependOnTheNumberOfThreads) {
  Gltf document;
  json primitives;
  for (int p = 0; p < 8; ++p) {
    const mesh::TriangleMesh mesh = support::half_mirrored_torus(8 + p, 6);
    const auto floats = [](const auto& vectors) {
      std::vector<float> values(vectors.size() * sizeof vectors[0] / sizeof(float));
      std::memcpy(values.data(), vectors.data(), values.size() * sizeof(float));
      return values;
    };
    std::vector<std::uint16_t> indices;
    for (const auto& triangle : mesh.triangles)
      indices.insert(indices.end(), triangle.begin(), triangle.end());
    const std::size_t positions = document.accessor<float>(floats(mesh.positions), "VEC3");
    const std::size_t normals = document.accessor<float>(floats(mesh.normals), "VEC3");
    const std::size_t uvs = document.accessor<float>(floats(mesh.uv_sets[0]), "VEC2");
    primitives.push_back({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}},
                          {"indices", document.accessor<std::uint16_t>(indices, "SCALAR")}});
  }
  document.mesh(primitives);
  const auto on = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return tangents_of(document).glb;
  };
  const std::vector<std::byte> alone = on(1);
  EXPECT_EQ(on(2), alone);
  EXPECT_EQ(on(7), alone);
}

/// Tangents that another program wrote, made for the mirrored half as well.
TEST(ModelTangents, HaveTheDirectionsAndSignsOfTheKhronosMirrorTest) {
  const std::filesystem::path file = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh" /
                                     "khr_NormalTangentMirrorTest" / "NormalTangentMirrorTest.glb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared assets at " << file;
  const Model theirs = read_model(file);
  const Model ours = read_back(add_tangents(file));
  std::size_t corners = 0;
  std::size_t opposed = 0;
  std::size_t aside = 0;
  for (std::size_t m = 0; m < theirs.meshes.size(); ++m) {
    const auto& expected = theirs.meshes[m].tangent_spaces.at(0).corners;
    const auto& made = ours.meshes.at(m).tangent_spaces.at(0).corners;
    ASSERT_EQ(made.size(), expected.size());
    corners += made.size();
    for (std::size_t i = 0; i < made.size(); ++i) {
      opposed += made[i].w != expected[i].w;
      aside += made[i].x * expected[i].x + made[i].y * expected[i].y + made[i].z * expected[i].z < 0.99f;
    }
  }
  std::printf("  %zu corners, %zu with another sign, %zu more than 8 degrees aside\n", corners, opposed,
              aside);
  EXPECT_EQ(opposed, 0u);
  EXPECT_EQ(aside, 0u);
}

TEST(ModelTangents, StopWhenAsked) {
  const TemporaryFolder folder;
  TangentOptions options;
  options.report.progress = [](double) { return false; };
  EXPECT_THROW((void)tangents_of(test::triangle(), options), Cancelled);
}

} // namespace
} // namespace surfgrad::io
