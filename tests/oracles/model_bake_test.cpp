// Baked maps inside the model they were baked for: what changes, that all else stays, and that the Khronos
// validator finds no error in any of it.

#include "io/model_bake.hpp"

#include "diagnostic/error.hpp"
#include "io/image_file.hpp"
#include "io/model_file.hpp"
#include "mesh/mikktspace.hpp"
#include "oracles/oracle.hpp"
#include "unit/io/glb_file.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace surfgrad::io {
namespace {

using nlohmann::json;
using test::Glb;
using test::Gltf;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::byte> png_of(float r, float g, float b, int side = 4) {
  image::Image image = image::make_image(side, side, 3);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      image.at(x, y, 0) = r;
      image.at(x, y, 1) = g;
      image.at(x, y, 2) = b;
    }
  return encode_image(image, image::Depth::unorm8, ImageFormat::png);
}

std::vector<std::byte> flat_map() { return png_of(0.5f, 0.5f, 1); }

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Of the file, as a scene has it.
BakedModel baked(const std::filesystem::path& file, std::vector<double> weights = {}) {
  BakedModel result{.file = file, .morph_weights = weights, .normal_png = flat_map()};
  result.model = read_model(file, {.morph_weights = std::move(weights), .report = {}});
  result.is_bumped.assign(result.model.materials.size(), true);
  return result;
}

/// The model moved up by 1, as a displacement would; no tangents are left of it.
BakedModel displaced(BakedModel model) {
  for (mesh::TriangleMesh& mesh : model.model.meshes) {
    for (vec3<float>& p : mesh.positions) p.z += 1;
    mesh.tangent_spaces.clear();
  }
  model.is_displaced = true;
  return model;
}

/// The file that is written, after the validator had it.
Glb written(BakedModel model, const Report& report = {}) {
  const std::vector<std::byte> bytes = encode_baked_model(std::move(model), report);
  const TemporaryFolder folder;
  EXPECT_EQ(surfgrad::test::validator_errors({folder.write("out.glb", bytes)}), "");
  return Glb(bytes);
}

/// The document is kept while its model is read.
struct Saved {
  TemporaryFolder folder{};
  std::filesystem::path file;

  explicit Saved(const Gltf& document) : file(folder.write("model.gltf", document.gltf())) {
    folder.write("old.png", png_of(0.25f, 0.5f, 0.75f));
  }
};

std::string error_of(const Gltf& document, const image::Image* roughness, std::size_t uv_set = 0) {
  const Saved saved(document);
  BakedModel model = baked(saved.file);
  model.roughness = roughness;
  model.uv_set = uv_set;
  try {
    (void)encode_baked_model(std::move(model));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A triangle of a material with textures of everything, and two UV sets.
Gltf textured() {
  Gltf document = test::triangle();
  json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_1"] = document.accessor<float>({0, 0, 0, 1, 1, 0}, "VEC2");
  primitive["material"] = 0;
  document.json["accessors"][0]["min"] = {0, 0, 0}; // for meshes that stay as they are
  document.json["accessors"][0]["max"] = {1, 1, 0};
  document.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_clearcoat"};
  document.json["images"] = {{{"uri", "old.png"}}};
  document.json["textures"] = {{{"source", 0}}};
  document.json["materials"] = {{{"name", "paint"},
                                 {"doubleSided", true},
                                 {"extras", {{"by", "hand"}}},
                                 {"extensions",
                                  {{"KHR_materials_clearcoat",
                                    {{"clearcoatFactor", 0.5}, {"clearcoatNormalTexture", {{"index", 0}}}}}}},
                                 {"pbrMetallicRoughness",
                                  {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}},
                                   {"roughnessFactor", 0.25},
                                   {"metallicFactor", 0.5},
                                   {"metallicRoughnessTexture", {{"index", 0}}}}},
                                 {"normalTexture",
                                  {{"index", 0},
                                   {"texCoord", 1},
                                   {"scale", 0.5},
                                   {"extras", {{"note", 1}}},
                                   {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}},
                                 {"emissiveFactor", {0.5, 0.25, 0}}},
                                {{"name", "unused"}, {"normalTexture", {{"index", 0}}}}};
  return document;
}

/// Two triangles with a morph target that lifts them; the node's weights are the document's to set.
Gltf morphed() {
  Gltf document = test::triangle();
  json& mesh = document.json["meshes"][0];
  mesh["primitives"][0]["targets"] = {
      {{"POSITION", document.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}};
  // The format wants bounds of positions, also of their differences.
  document.json["accessors"].back()["min"] = {0, 0, 1};
  document.json["accessors"].back()["max"] = {0, 0, 1};
  return document;
}

float height_of(const Glb& file, const json& mesh) {
  return file.elements<vec3<float>>(mesh["primitives"][0]["attributes"]["POSITION"]).at(0).z;
}

TEST(BakedModel, HasTheMapAsItsNormalTextureAndAllElseOfTheMaterial) {
  const Gltf document = textured();
  const Saved saved(document);
  BakedModel model = baked(saved.file);
  model.uv_set = 1;
  const Glb file = written(model);
  json expected = document.json["materials"];
  const json& material = file.document["materials"][0];
  const json& info = material["normalTexture"];
  EXPECT_EQ(info, json({{"index", 1}, {"texCoord", 1}, {"extras", {{"note", 1}}}}));
  expected[0]["normalTexture"] = info;
  EXPECT_EQ(file.document["materials"], expected);

  const json& texture = file.document["textures"][1];
  const json& sampler = file.document["samplers"][texture["sampler"].get<std::size_t>()];
  EXPECT_EQ(sampler["wrapS"], 33071);
  const json& image = file.document["images"][texture["source"].get<std::size_t>()];
  EXPECT_EQ(image["mimeType"], "image/png");
  EXPECT_EQ(file.view(image["bufferView"]), text_of(flat_map()));
  EXPECT_EQ(file.document["textures"][0], document.json["textures"][0]);
  EXPECT_EQ(file.document["nodes"], document.json["nodes"]);

  model.is_repeated = true;
  EXPECT_EQ(written(model).document["samplers"][0]["wrapT"], 10497);
}

TEST(BakedModel, HasTangentsOfTheUvSetThatWasBaked) {
  Gltf document = textured();
  document.json["materials"][0]["normalTexture"].erase("extensions");
  json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  const auto tangent_x = [](const Glb& file) {
    return file.elements<vec4<float>>(file.document["meshes"][0]["primitives"][0]["attributes"]["TANGENT"])[0]
        .x;
  };
  const auto of_set = [&](std::size_t set) {
    const Saved saved(document);
    BakedModel model = baked(saved.file);
    model.uv_set = set;
    return tangent_x(written(std::move(model)));
  };
  EXPECT_GT(of_set(0), 0.9f); // u of set 0 runs near x
  EXPECT_EQ(of_set(1), 0);    // u of set 1 runs along y
  // The file's own are for the set of its normal texture: a bake over that one has used them.
  attributes["TANGENT"] =
      document.accessor<float>({0.6f, 0.8f, 0, 1, 0.6f, 0.8f, 0, 1, 0.6f, 0.8f, 0, 1}, "VEC4");
  EXPECT_EQ(of_set(1), 0.6f);
  EXPECT_GT(of_set(0), 0.9f);
}

TEST(BakedModel, KeepsMaterialsThatAreNotBumpedAndMeshesOfPoints) {
  Gltf document = textured();
  json primitive = document.json["meshes"][0]["primitives"][0];
  primitive["material"] = 2;
  document.json["meshes"][0]["primitives"].push_back(primitive);
  primitive["mode"] = 0;
  document.json["meshes"][0]["primitives"].push_back(primitive);
  document.json["materials"].push_back({{"name", "plain"}});
  const Saved saved(document);
  BakedModel model = baked(saved.file);
  model.is_bumped = {false, false, false};
  const Glb file = written(std::move(model));
  // The first had a normal texture, which the stack does not have: the map is flat there.
  EXPECT_NE(file.document["materials"][0], document.json["materials"][0]);
  EXPECT_EQ(file.document["materials"][1], document.json["materials"][1]);
  EXPECT_EQ(file.document["materials"][2], document.json["materials"][2]);
  EXPECT_EQ(file.document["meshes"][0]["primitives"][1], document.json["meshes"][0]["primitives"][1]);
  EXPECT_EQ(file.document["meshes"][0]["primitives"][2], document.json["meshes"][0]["primitives"][2]);
}

TEST(BakedModel, DoublesAMaterialThatMeshesOutsideOfTheSceneUse) {
  Gltf document = textured();
  document.json["meshes"].push_back(document.json["meshes"][0]);
  json& hidden = document.json["meshes"][1]["primitives"][0];
  hidden["attributes"].erase("TEXCOORD_1");
  document.json["materials"][0]["normalTexture"].erase("texCoord");
  document.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].erase("texCoord");
  document.json["nodes"].push_back({{"mesh", 1}});
  document.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  document.json["scene"] = 0;
  const Saved saved(document);
  BakedModel model = baked(saved.file);
  model.uv_set = 1;
  const Glb file = written(std::move(model));
  EXPECT_EQ(file.document["materials"][0], document.json["materials"][0]);
  EXPECT_EQ(file.document["materials"][2]["name"], "paint");
  EXPECT_EQ(file.document["materials"][2]["normalTexture"]["texCoord"], 1);
  EXPECT_EQ(file.document["meshes"][0]["primitives"][0]["material"], 2);
  EXPECT_EQ(file.document["meshes"][1], document.json["meshes"][1]);
}

TEST(BakedModel, GivesAMaterialToMeshesThatHaveNone) {
  const Gltf document = test::triangle();
  const Saved saved(document);
  const Glb file = written(baked(saved.file));
  EXPECT_EQ(file.document["meshes"][0]["primitives"][0]["material"], 0);
  EXPECT_EQ(file.document["materials"],
            json::parse(R"([{"name": "default", "normalTexture": {"index": 0}}])"));
}

TEST(BakedModel, HasTheRoughnessBesideTheMetallicThatWasThere) {
  image::Image roughness = image::make_image(8, 8, 1);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) roughness.at(x, y, 0) = 0.4f;
  const auto texture_of = [](const Glb& file, std::size_t material) {
    const json& shading = file.document["materials"][material]["pbrMetallicRoughness"];
    EXPECT_FALSE(shading.contains("roughnessFactor"));
    const json& info = shading["metallicRoughnessTexture"];
    const json& texture = file.document["textures"][info["index"].get<std::size_t>()];
    const std::string png =
        file.view(file.document["images"][texture["source"].get<std::size_t>()]["bufferView"]);
    return decode_image(std::as_bytes(std::span(png)), "roughness.png");
  };
  Gltf document = textured();
  json& shading = document.json["materials"][0]["pbrMetallicRoughness"];
  const auto bake = [&] {
    const Saved saved(document);
    BakedModel model = baked(saved.file);
    model.roughness = &roughness;
    return written(std::move(model));
  };
  const Glb kept = bake();
  EXPECT_EQ(kept.document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"], 0.5);
  const image::Image both = texture_of(kept, 0);
  EXPECT_EQ(both.width, 8);
  EXPECT_NEAR(both.at(3, 5, 1), 0.4f, 0.5 / 255); // a code
  EXPECT_NEAR(both.at(3, 5, 2), 0.75f, 0.5 / 255);

  shading.erase("metallicRoughnessTexture");
  EXPECT_EQ(texture_of(bake(), 0).at(0, 0, 2), 1);

  shading["metallicRoughnessTexture"] = {{"index", 0}, {"texCoord", 1}};
  EXPECT_THAT(
      error_of(document, &roughness),
      HasSubstr("materials[0].pbrMetallicRoughness.metallicRoughnessTexture: does not lie over UV set 0"));
  shading["metallicFactor"] = 0; // no metallic to keep
  EXPECT_EQ(texture_of(bake(), 0).at(0, 0, 2), 1);
  shading["metallicFactor"] = 1;
  shading["metallicRoughnessTexture"] = {{"index", 7}};
  EXPECT_THAT(error_of(document, &roughness), HasSubstr("names no texture"));
  shading = "shiny";
  EXPECT_THAT(error_of(document, &roughness), HasSubstr("materials[0].pbrMetallicRoughness: is no object"));
}

TEST(BakedModel, ResamplesMetallicWhereSizesDiffer) {
  image::Image ramp = image::make_image(2, 2, 3);
  for (const int y : {0, 1}) ramp.at(1, y, 2) = 1; // metallic grows to the right
  Gltf document = textured();
  const Saved saved(document);
  saved.folder.write("old.png", encode_image(ramp, image::Depth::unorm8, ImageFormat::png));
  const image::Image roughness = image::make_image(4, 1, 1);
  BakedModel model = baked(saved.file);
  model.roughness = &roughness;
  const Glb file = written(std::move(model));
  const std::string png = file.view(file.document["images"].back()["bufferView"]);
  const image::Image result = decode_image(std::as_bytes(std::span(png)), "roughness.png");
  // Texel centres at 1/8, 3/8, 5/8, 7/8; those of the source at 1/4 and 3/4.
  for (const auto& [x, metallic] : {std::pair{0, 0.0}, {1, 0.25}, {2, 0.75}, {3, 1.0}})
    EXPECT_NEAR(result.at(x, 0, 2), metallic, 0.5 / 255) << x;
}

TEST(BakedModel, IsTheDisplacedMeshWithoutWhatCannotFollow) {
  Gltf document = morphed();
  json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["COLOR_0"] = document.accessor<float>(std::vector<float>(12, 1.0f), "VEC4");
  std::vector<float> weights(12, 0.0f);
  for (const std::size_t i : {0, 4, 8}) weights[i] = 1;
  primitive["attributes"]["WEIGHTS_0"] = document.accessor<float>(weights, "VEC4");
  primitive["attributes"]["JOINTS_0"] =
      document.accessor<std::uint16_t>(std::vector<std::uint16_t>(12), "VEC4");
  document.json["nodes"][0]["skin"] = 0;
  document.json["nodes"].push_back({{"name", "bone"}});
  document.json["skins"] = {{{"joints", {1}}}};
  const std::size_t times = document.accessor<float>({0, 1}, "SCALAR");
  document.json["accessors"].back()["min"] = {0};
  document.json["accessors"].back()["max"] = {1};
  const std::size_t values = document.accessor<float>({0, 1}, "SCALAR");
  const std::size_t moves = document.accessor<float>({0, 0, 0, 0, 1, 0}, "VEC3");
  const json weights_channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}};
  const json moving_channel = {{"sampler", 1}, {"target", {{"node", 1}, {"path", "translation"}}}};
  const json samplers = {{{"input", times}, {"output", values}}, {{"input", times}, {"output", moves}}};
  document.json["animations"] = {
      {{"name", "both"}, {"samplers", samplers}, {"channels", {weights_channel, moving_channel}}},
      {{"samplers", samplers}, {"channels", {weights_channel}}}};
  const Saved saved(document);
  std::vector<std::string> warnings;
  Report report;
  report.warning = [&](std::string_view text) { warnings.emplace_back(text); };
  const Glb file = written(displaced(baked(saved.file)), report);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("meshes[0].primitives[0]"));
  EXPECT_THAT(warnings[0], HasSubstr("COLOR_0, JOINTS_0, WEIGHTS_0, morph targets"));

  const json& mesh = file.document["meshes"][0];
  EXPECT_EQ(height_of(file, mesh), 1);
  std::vector<std::string> names;
  for (const auto& [name, accessor] : mesh["primitives"][0]["attributes"].items()) names.push_back(name);
  EXPECT_THAT(names, UnorderedElementsAre("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"));
  EXPECT_FALSE(mesh["primitives"][0].contains("targets"));
  EXPECT_FALSE(file.document["nodes"][0].contains("skin"));
  EXPECT_EQ(file.document["skins"], document.json["skins"]);
  ASSERT_EQ(file.document["animations"].size(), 1u);
  EXPECT_EQ(file.document["animations"][0]["channels"], json::array({moving_channel}));
}

TEST(BakedModel, KeepsMorphTargetsOfTheUnmorphedShape) {
  const Gltf document = morphed();
  const Saved saved(document);
  std::vector<std::string> warnings;
  Report report;
  report.warning = [&](std::string_view text) { warnings.emplace_back(text); };
  const Glb file = written(baked(saved.file), report);
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_EQ(file.document["meshes"][0]["primitives"][0]["targets"].size(), 1u);
}

TEST(BakedModel, OfMorphedNodesIsAMeshForEachShape) {
  Gltf document = morphed();
  document.json["nodes"] = {
      {{"mesh", 0}}, {{"mesh", 0}, {"weights", {2.0}}}, {{"mesh", 0}, {"weights", {2.0}}}};
  const Saved saved(document);
  const Glb file = written(baked(saved.file));
  ASSERT_EQ(file.document["meshes"].size(), 2u);
  const json& plain = file.document["meshes"][0];
  const json& lifted = file.document["meshes"][1];
  EXPECT_EQ(height_of(file, plain), 0);
  EXPECT_TRUE(plain["primitives"][0].contains("targets"));
  EXPECT_EQ(height_of(file, lifted), 2);
  EXPECT_FALSE(lifted["primitives"][0].contains("targets"));
  EXPECT_EQ(file.document["nodes"], json::parse(R"([{"mesh": 0}, {"mesh": 1}, {"mesh": 1}])"));
  EXPECT_EQ(plain["primitives"][0]["material"], lifted["primitives"][0]["material"]);
}

TEST(BakedModel, WithTheWeightsOfTheSceneIsInPlace) {
  Gltf document = morphed();
  document.json["meshes"][0]["weights"] = {0.5};
  const Saved saved(document);
  const Glb file = written(baked(saved.file, {3.0}));
  ASSERT_EQ(file.document["meshes"].size(), 1u);
  EXPECT_EQ(height_of(file, file.document["meshes"][0]), 3);
  EXPECT_FALSE(file.document["meshes"][0].contains("weights"));
}

TEST(BakedModel, OfAMorphedShapeHasTheTangentsThatTheFileGaveIt) {
  Gltf document = morphed();
  document.json["meshes"][0]["weights"] = {0.5};
  document.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      document.accessor<float>({0.6f, 0.8f, 0, 1, 0.6f, 0.8f, 0, 1, 0.6f, 0.8f, 0, 1}, "VEC4");
  const Saved saved(document);
  const Glb file = written(baked(saved.file));
  const json& attributes = file.document["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_EQ(file.elements<vec4<float>>(attributes["TANGENT"]).at(0).x, 0.6f);
}

TEST(BakedModel, OfAnObjHasAPrimitiveAndAMapForEachMaterial) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                               "usemtl clay\nf 1/1 2/2 3/3\nusemtl glass\nf 1/1 3/3 4/4\n");
  BakedModel model = baked(file);
  model.is_bumped = {true, false};
  const mesh::TriangleMesh& mesh = model.model.meshes.at(0);
  const std::vector<vec4<float>> expected = mesh::generate_tangents(mesh, 0).corners;
  const Glb result = written(model);
  EXPECT_EQ(result.document["materials"][0]["normalTexture"]["index"], 0);
  EXPECT_FALSE(result.document["materials"][1].contains("normalTexture"));
  // The tangents that the bake had: averaged over both materials.
  ASSERT_EQ(result.document["meshes"][0]["primitives"].size(), 2u);
  for (std::size_t p = 0; p < 2; ++p) {
    const json& primitive = result.document["meshes"][0]["primitives"][p];
    const auto tangents = result.elements<vec4<float>>(primitive["attributes"]["TANGENT"]);
    const auto indices = result.elements<std::uint32_t>(primitive["indices"]);
    ASSERT_EQ(indices.size(), 3u);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(tangents[indices[c]].x, expected[3 * p + c].x);
      EXPECT_EQ(tangents[indices[c]].z, expected[3 * p + c].z);
    }
  }
}

TEST(BakedModel, OfAFileThatHasChangedIsRefused) {
  Gltf document = test::triangle();
  const Saved saved(document);
  BakedModel model = baked(saved.file);
  document.json["nodes"].push_back({{"mesh", 0}});
  saved.folder.write("model.gltf", document.gltf());
  try {
    (void)encode_baked_model(std::move(model));
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has changed since it was baked"));
  }
}

TEST(BakedModel, StopsWhenAsked) {
  const Gltf document = test::triangle();
  const Saved saved(document);
  Report report;
  report.progress = [](double) { return false; };
  EXPECT_THROW((void)encode_baked_model(baked(saved.file), report), Cancelled);
}

} // namespace
} // namespace surfgrad::io
