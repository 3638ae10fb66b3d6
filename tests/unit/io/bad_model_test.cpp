#include "diagnostic/error.hpp"
#include "io/model_file.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <limits>
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

/// The message of the InputError that reading the file ends in; fails the test otherwise.
std::string refusal(const std::filesystem::path& file) {
  try {
    (void)read_model(file);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << file << " was read";
  return {};
}

void expect_refusal(std::string_view name, std::string_view content,
                    const std::vector<std::string>& fragments) {
  const TemporaryFolder folder;
  const std::string message = refusal(folder.write(name, content));
  std::printf("  %s\n", message.substr(message.find(name.substr(0, 5))).c_str());
  EXPECT_THAT(message, HasSubstr(name));
  EXPECT_EQ(message.find('\n'), message.npos);
  for (const std::string& fragment : fragments) EXPECT_THAT(message, HasSubstr(fragment));
}

/// A good triangle made bad, and what the message must say about it.
struct BadGltf {
  const char* name;
  std::function<void(Gltf&)> spoil;
  std::vector<std::string> fragments;
};

void PrintTo(const BadGltf& bad, std::ostream* out) { *out << bad.name; }

json& primitive(Gltf& document) { return document.json["meshes"][0]["primitives"][0]; }
json& accessor(Gltf& document, std::size_t index) { return document.json["accessors"][index]; }
json& view(Gltf& document, std::size_t index) { return document.json["bufferViews"][index]; }

void use_normal_texture(Gltf& document, const json& image, const json& info = {{"index", 0}}) {
  document.json["images"] = json::array({image});
  document.json["textures"] = {{{"source", 0}}};
  document.json["materials"] = {{{"normalTexture", info}}};
}

void set_sparse(Gltf& document, const std::vector<std::uint8_t>& targets) {
  const std::size_t indices = document.view(targets);
  const std::size_t values = document.view<float>({1, 2, 3, 4, 5, 6});
  accessor(document, 0)["sparse"] = {{"count", 2},
                                     {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                     {"values", {{"bufferView", values}}}};
}

void replace_float(Gltf& document, std::size_t view_index, std::size_t element, float value) {
  const std::size_t offset =
      view(document, view_index)["byteOffset"].get<std::size_t>() + element * sizeof value;
  std::memcpy(document.buffer.data() + offset, &value, sizeof value);
}

const float nan = std::numeric_limits<float>::quiet_NaN();
const float infinity = std::numeric_limits<float>::infinity();
const std::string attributes_place = "meshes[0].primitives[0].attributes";

const std::vector<BadGltf> all_bad_gltf = {
    // Document
    {"OtherVersion",
     [](Gltf& d) { d.json["asset"]["version"] = "1.0"; },
     {"asset.version", "1.0", "expected 2.0"}},
    {"NoAsset", [](Gltf& d) { d.json.erase("asset"); }, {"\"asset\" is missing"}},
    {"RootIsArray",
     [](Gltf& d) {
       d.json = json::array({1, 2});
     },
     {"expected an object"}},
    {"MeshesIsObject", [](Gltf& d) { d.json["meshes"] = json::object(); }, {"meshes", "expected an array"}},
    {"NodeIsNumber", [](Gltf& d) { d.json["nodes"][0] = 7; }, {"nodes[0]", "is 7", "expected an object"}},
    {"Draco",
     [](Gltf& d) { d.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     {"extensionsRequired[0]", "KHR_draco_mesh_compression", "not supported"}},
    {"Meshopt",
     [](Gltf& d) {
       d.json["extensionsRequired"] = {"KHR_texture_transform", "EXT_meshopt_compression"};
     },
     {"extensionsRequired[1]", "EXT_meshopt_compression"}},
    {"Basisu",
     [](Gltf& d) { d.json["extensionsRequired"] = {"KHR_texture_basisu"}; },
     {"KHR_texture_basisu"}},
    {"ControlCharacters", [](Gltf& d) { d.json["extensionsRequired"] = {"a\nb\x1b[31m"}; }, {"a?b?[31m"}},
    // Buffers
    {"BufferTooShort",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 1000}, {"uri", "data:;base64,AAAA"}}};
     },
     {"buffers[0].byteLength", "is 1000", "3 bytes"}},
    {"BufferWithoutUri",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 8}}};
     },
     {"buffers[0]", "\"uri\""}},
    {"BufferMissing",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 8}, {"uri", "absent.bin"}}};
     },
     {"buffers[0].uri", "absent.bin"}},
    {"BadBase64",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "data:;base64,AA!A"}}};
     },
     {"buffers[0].uri", "base64", "character 2"}},
    {"NotBase64",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "data:text/plain,abc"}}};
     },
     {"buffers[0].uri", "not base64"}},
    {"UriParent",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "../secret.bin"}}};
     },
     {"buffers[0].uri", "leaves the model's folder"}},
    {"UriEncodedParent",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "a/%2e%2E/%2e./x.bin"}}};
     },
     {"buffers[0].uri", "leaves the model's folder"}},
    {"UriAbsolute",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "/etc/hostname"}}};
     },
     {"absolute path"}},
    {"UriEncodedAbsolute",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "%2Fetc%2Fhostname"}}};
     },
     {"absolute path"}},
    {"UriBackslash",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "..\\x.bin"}}};
     },
     {"backslash"}},
    {"UriHttp",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "http://host/x.bin"}}};
     },
     {"buffers[0].uri", "names a scheme"}},
    {"UriFile",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "file:x.bin"}}};
     },
     {"names a scheme"}},
    {"UriNul",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "x.bin%00.png"}}};
     },
     {"control character"}},
    {"UriBrokenPercent",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", "x%4"}}};
     },
     {"percent code"}},
    {"UriEmpty",
     [](Gltf& d) {
       d.json["buffers"] = {{{"byteLength", 3}, {"uri", ""}}};
     },
     {"is empty"}},
    // BufferViews
    {"ViewPastBuffer",
     [](Gltf& d) { view(d, 0)["byteLength"] = 100000; },
     {"bufferViews[0]", "within the buffer"}},
    {"ViewOffsetOverflows",
     [](Gltf& d) { view(d, 0)["byteOffset"] = std::size_t{1} << 53; },
     {"bufferViews[0]"}},
    {"ViewOffsetNegative",
     [](Gltf& d) { view(d, 0)["byteOffset"] = -4; },
     {"bufferViews[0].byteOffset", "is -4", "0 or more"}},
    {"ViewOffsetFraction",
     [](Gltf& d) { view(d, 0)["byteOffset"] = 0.5; },
     {"bufferViews[0].byteOffset", "is 0.5"}},
    {"ViewOfBufferIndexBeyond32Bits",
     [](Gltf& d) { view(d, 0)["buffer"] = std::size_t{1} << 32; },
     {"bufferViews[0].buffer", "buffers[4294967296] does not exist"}},
    {"ViewOfNoBuffer",
     [](Gltf& d) { view(d, 0)["buffer"] = 4; },
     {"bufferViews[0].buffer", "buffers[4] does not exist", "1 entry"}},
    {"StrideTooSmall", [](Gltf& d) { view(d, 0)["byteStride"] = 8; }, {"accessors[0]", "byteStride 8"}},
    {"StrideZero", [](Gltf& d) { view(d, 0)["byteStride"] = 0; }, {"bufferViews[0].byteStride"}},
    {"StrideHuge", [](Gltf& d) { view(d, 0)["byteStride"] = 4096; }, {"bufferViews[0].byteStride"}},
    {"StrideOdd",
     [](Gltf& d) { view(d, 0)["byteStride"] = 14; },
     {"bufferViews[0].byteStride", "is 14", "multiple of 4"}},
    {"StridePastView", [](Gltf& d) { view(d, 0)["byteStride"] = 16; }, {"accessors[0]", "do not fit"}},
    // Accessors
    {"CountPastView",
     [](Gltf& d) { accessor(d, 0)["count"] = 4; },
     {"accessors[0]", "4 elements of 12 bytes"}},
    {"CountHuge", [](Gltf& d) { accessor(d, 0)["count"] = 4294967295u; }, {"accessors[0]", "do not fit"}},
    {"CountBeyond32Bits",
     [](Gltf& d) { accessor(d, 0)["count"] = std::size_t{1} << 40; },
     {"accessors[0].count"}},
    {"CountBeyond64Bits", [](Gltf& d) { accessor(d, 0)["count"] = 1e300; }, {"accessors[0].count"}},
    {"CountZero", [](Gltf& d) { accessor(d, 0)["count"] = 0; }, {"accessors[0].count", "is 0"}},
    {"OffsetNegative",
     [](Gltf& d) { accessor(d, 0)["byteOffset"] = -12; },
     {"accessors[0].byteOffset", "is -12"}},
    {"OffsetPastView", [](Gltf& d) { accessor(d, 0)["byteOffset"] = 4; }, {"accessors[0]", "from byte 4"}},
    {"NoBufferView", [](Gltf& d) { accessor(d, 0).erase("bufferView"); }, {"accessors[0]", "no bufferView"}},
    {"UnknownComponentType",
     [](Gltf& d) { accessor(d, 0)["componentType"] = 5130; },
     {"accessors[0].componentType", "is 5130", "5126 (float)"}},
    {"IntegerPosition",
     [](Gltf& d) { accessor(d, 0)["componentType"] = 5123; },
     {"accessors[0].componentType", "is 5123"}},
    {"NormalizedFloat",
     [](Gltf& d) { accessor(d, 0)["normalized"] = true; },
     {"accessors[0]", "5126 normalized"}},
    {"UnknownType",
     [](Gltf& d) { accessor(d, 0)["type"] = "VEC5"; },
     {"accessors[0].type", "\"VEC5\"", "VEC3"}},
    {"PositionMatrix",
     [](Gltf& d) { accessor(d, 0)["type"] = "MAT3"; },
     {"accessors[0].type", "\"MAT3\"", "\"VEC3\""}},
    {"SparseOffsetBeyond32Bits",
     [](Gltf& d) {
       set_sparse(d, {1, 2});
       accessor(d, 0)["sparse"]["values"]["byteOffset"] = std::size_t{1} << 32;
     },
     {"accessors[0].sparse.values.byteOffset", "is 4294967296"}},
    {"PositionVec2",
     [](Gltf& d) { accessor(d, 0)["type"] = "VEC2"; },
     {"accessors[0].type", "\"VEC2\"", "\"VEC3\""}},
    {"FloatIndices",
     [](Gltf& d) {
       primitive(d)["indices"] = d.accessor<float>({0, 1, 2}, "SCALAR");
     },
     {"accessors[4].componentType", "is 5126", "5121, 5123 or 5125"}},
    {"VectorIndices", [](Gltf& d) { primitive(d)["indices"] = 0; }, {"accessors[0].type", "\"SCALAR\""}},
    {"SparseTargetOutOfRange",
     [](Gltf& d) {
       set_sparse(d, {1, 3});
     },
     {"accessors[0].sparse.indices", "entry 1 is 3", "3 elements"}},
    {"SparseCountHuge",
     [](Gltf& d) {
       set_sparse(d, {1, 2});
       accessor(d, 0)["sparse"]["count"] = 1u << 30;
     },
     {"accessors[0].sparse.indices", "do not fit"}},
    {"SparseWithoutViewHuge",
     [](Gltf& d) {
       set_sparse(d, {1, 2});
       accessor(d, 0).erase("bufferView");
       accessor(d, 0)["count"] = 1u << 31;
     },
     {"accessors[0]", "no bufferView"}},
    // Primitives
    {"NoPosition",
     [](Gltf& d) { primitive(d)["attributes"].erase("POSITION"); },
     {attributes_place, "\"POSITION\" is missing"}},
    {"NoSuchAccessor",
     [](Gltf& d) { primitive(d)["attributes"]["NORMAL"] = 9; },
     {attributes_place + ".NORMAL", "accessors[9] does not exist"}},
    {"FewerNormals",
     [](Gltf& d) { accessor(d, 1)["count"] = 2; },
     {attributes_place + ".NORMAL", "has 2 elements but POSITION has 3"}},
    {"FewerUvs",
     [](Gltf& d) { accessor(d, 2)["count"] = 2; },
     {attributes_place + ".TEXCOORD_0", "has 2 elements"}},
    {"UvGap",
     [](Gltf& d) { primitive(d)["attributes"]["TEXCOORD_7"] = 2; },
     {attributes_place, "no TEXCOORD_1"}},
    {"IndexOutOfRange",
     [](Gltf& d) {
       primitive(d)["indices"] = d.accessor<std::uint32_t>({0, 1, 3}, "SCALAR");
     },
     {"meshes[0].primitives[0].indices", "index 2 is 3", "3 vertices"}},
    {"TwoIndices",
     [](Gltf& d) { accessor(d, 3)["count"] = 2; },
     {"meshes[0].primitives[0]", "has 2 indices", "multiple of 3"}},
    {"ShortStrip",
     [](Gltf& d) {
       accessor(d, 3)["count"] = 2;
       primitive(d)["mode"] = 5;
     },
     {"has 2 indices", "3 or more"}},
    {"UnknownMode", [](Gltf& d) { primitive(d)["mode"] = 7; }, {"meshes[0].primitives[0].mode", "is 7"}},
    {"ModeIsText", [](Gltf& d) { primitive(d)["mode"] = "4"; }, {"meshes[0].primitives[0].mode", "is \"4\""}},
    {"IndicesAreText",
     [](Gltf& d) { primitive(d)["indices"] = "x"; },
     {"meshes[0].primitives[0].indices", "is \"x\"", "whole number"}},
    {"IndicesWithoutView",
     [](Gltf& d) { accessor(d, 3).erase("bufferView"); },
     {"accessor[3]", "bufferView"}},
    {"NoSuchMaterial",
     [](Gltf& d) { primitive(d)["material"] = 0; },
     {"primitives[0].material", "materials[0] does not exist"}},
    {"NanPosition",
     [](Gltf& d) { replace_float(d, 0, 4, nan); },
     {attributes_place + ".POSITION", "vertex 1 is nan"}},
    {"InfiniteNormal",
     [](Gltf& d) { replace_float(d, 1, 8, -infinity); },
     {attributes_place + ".NORMAL", "vertex 2 is -inf"}},
    {"NanUv",
     [](Gltf& d) { replace_float(d, 2, 5, nan); },
     {attributes_place + ".TEXCOORD_0", "vertex 2 is nan"}},
    {"NanTangent",
     [](Gltf& d) {
       primitive(d)["attributes"]["TANGENT"] =
           d.accessor<float>({1, 0, 0, 1, 1, 0, 0, nan, 1, 0, 0, 1}, "VEC4");
     },
     {attributes_place + ".TANGENT", "vertex 1 is nan"}},
    // Nodes and scenes
    {"NodeCycle",
     [](Gltf& d) {
       d.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
       d.json["scenes"] = {{{"nodes", {0}}}};
     },
     {"nodes[1].children[0]", "nodes[0] is reached twice"}},
    {"NodeIsItsOwnChild",
     [](Gltf& d) {
       d.json["nodes"][0]["children"] = {0};
       d.json["scenes"] = {{{"nodes", {0}}}};
     },
     {"nodes[0].children[0]", "reached twice"}},
    {"NodeWithTwoParents",
     [](Gltf& d) {
       d.json["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
     },
     {"nodes[1] is reached twice"}},
    {"NoSuchNode",
     [](Gltf& d) {
       d.json["scenes"] = {{{"nodes", {5}}}};
     },
     {"scenes[0].nodes[0]", "nodes[5] does not exist"}},
    {"NoSuchScene", [](Gltf& d) { d.json["scene"] = 3; }, {"scene", "scenes[3] does not exist", "0 entries"}},
    {"NoSuchMesh",
     [](Gltf& d) { d.json["nodes"][0]["mesh"] = 3; },
     {"nodes[0].mesh", "meshes[3] does not exist"}},
    {"NoMesh", [](Gltf& d) { d.json["nodes"][0].erase("mesh"); }, {"no node of the scene shows a mesh"}},
    {"OnlyPoints", [](Gltf& d) { primitive(d)["mode"] = 0; }, {"no node of the scene shows a mesh"}},
    {"ShortMatrix",
     [](Gltf& d) {
       d.json["nodes"][0]["matrix"] = {1, 2, 3};
     },
     {"nodes[0].matrix", "has 3 entries", "16 numbers"}},
    {"MatrixOfText",
     [](Gltf& d) { d.json["nodes"][0]["matrix"] = std::vector<std::string>(16, "1"); },
     {"nodes[0].matrix[0]", "expected a number"}},
    {"ProjectiveMatrix",
     [](Gltf& d) { d.json["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     {"nodes[0].matrix", "affine"}},
    {"MatrixAndScale",
     [](Gltf& d) {
       d.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
       d.json["nodes"][0]["scale"] = {1, 1, 1};
     },
     {"nodes[0]", "matrix beside"}},
    {"ZeroRotation",
     [](Gltf& d) {
       d.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     {"nodes[0]", "not finite"}},
    {"ScaleOverflows",
     [](Gltf& d) {
       d.json["nodes"] = {{{"scale", {1e200, 1, 1}}, {"children", {1}}},
                          {{"scale", {1e200, 1, 1}}, {"mesh", 0}}};
     },
     {"nodes[1]", "not finite"}},
    // Materials
    {"NoSuchTexture",
     [](Gltf& d) {
       d.json["materials"] = {{{"normalTexture", {{"index", 2}}}}};
     },
     {"materials[0].normalTexture.index", "textures[2]"}},
    {"TextureWithoutIndex",
     [](Gltf& d) {
       d.json["materials"] = {{{"normalTexture", json::object()}}};
     },
     {"materials[0].normalTexture", "\"index\" is missing"}},
    {"TextureWithoutSource",
     [](Gltf& d) {
       use_normal_texture(d, json::object());
       d.json["textures"][0].erase("source");
     },
     {"textures[0]", "\"source\" is missing"}},
    {"ImageWithoutData",
     [](Gltf& d) { use_normal_texture(d, json::object()); },
     {"images[0]", "\"uri\" is missing"}},
    {"ImageLeavesFolder",
     [](Gltf& d) {
       use_normal_texture(d, {{"uri", "../map.png"}});
     },
     {"images[0].uri", "leaves the model's folder"}},
    {"ImageFromTheNet",
     [](Gltf& d) {
       use_normal_texture(d, {{"uri", "https://host/map.png"}});
     },
     {"images[0].uri", "names a scheme"}},
    {"ImageMissing",
     [](Gltf& d) {
       use_normal_texture(d, {{"uri", "absent.png"}});
     },
     {"images[0].uri", "absent.png"}},
    {"ImageDamaged",
     [](Gltf& d) {
       use_normal_texture(d, {{"bufferView", 0}});
     },
     {".gltf:images[0]"}},
    {"ImagePastBuffer",
     [](Gltf& d) {
       use_normal_texture(d, {{"bufferView", 0}});
       view(d, 0)["byteLength"] = 9999;
     },
     {"bufferViews[0]"}},
    {"UnknownWrap",
     [](Gltf& d) {
       use_normal_texture(d, {{"bufferView", 0}});
       d.json["textures"][0]["sampler"] = 0;
       d.json["samplers"] = {{{"wrapS", 1}}};
     },
     {"samplers[0].wrapS", "is 1", "10497"}},
    {"ScaleIsText",
     [](Gltf& d) {
       use_normal_texture(d, {{"bufferView", 0}}, {{"index", 0}, {"scale", "1"}});
     },
     {"normalTexture.scale", "expected a number"}},
    {"ScaleHuge",
     [](Gltf& d) {
       use_normal_texture(d, {{"bufferView", 0}}, {{"index", 0}, {"scale", 1e300}});
     },
     {"materials[0].normalTexture", "1e+300"}},
    {"TexCoordNegative",
     [](Gltf& d) {
       use_normal_texture(d, {{"bufferView", 0}}, {{"index", 0}, {"texCoord", -1}});
     },
     {"normalTexture.texCoord", "is -1"}},
    {"TransformOffsetShort",
     [](Gltf& d) {
       use_normal_texture(d, {{"bufferView", 0}},
                          {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {1}}}}}}});
     },
     {"materials[0].normalTexture.extensions.KHR_texture_transform.offset", "expected 2 numbers"}},
    {"DoubleSidedIsNumber",
     [](Gltf& d) {
       d.json["materials"] = {{{"doubleSided", 1}}};
     },
     {"materials[0].doubleSided", "true or false"}},
};

class BadGltfTest : public testing::TestWithParam<BadGltf> {};

TEST_P(BadGltfTest, IsRefusedWithItsPlace) {
  Gltf document = triangle();
  GetParam().spoil(document);
  expect_refusal("model.gltf", document.json.is_array() ? document.json.dump() : document.gltf(),
                 GetParam().fragments);
}

INSTANTIATE_TEST_SUITE_P(, BadGltfTest, testing::ValuesIn(all_bad_gltf),
                         [](const auto& entry) { return std::string(entry.param.name); });

TEST(BadModel, OtherFiles) {
  expect_refusal("model.fbx", "x", {"\".fbx\"", "expected .gltf, .glb or .obj"});
  expect_refusal("model", "x", {"no extension"});
  expect_refusal("model.gltf", "", {"is empty"});
  expect_refusal("model.obj", "", {"is empty"});
  EXPECT_THAT(refusal("a_folder/that_is_absent.glb"), HasSubstr("that_is_absent.glb"));
}

TEST(BadModel, BrokenJsonNamesItsLine) {
  expect_refusal("model.gltf", "{\n\"asset\": {\n}", {"model.gltf:3:", "not JSON"});
  expect_refusal("model.gltf", "{\n\n\"asset\" 3}", {"model.gltf:3:"});
  expect_refusal("model.gltf", "\x89PNG\r\n", {"not JSON"});
  expect_refusal("model.gltf", "{\"a\": 1e999}", {"JSON"});
  expect_refusal("model.gltf", std::string(1000000, '['), {"not JSON"});
  expect_refusal("model.gltf", "\"" + std::string(1000000, 'x'), {"not JSON"});
}

TEST(BadModel, EveryTruncationOfAFileIsRefused) {
  const std::string glb = triangle().glb();
  const std::string gltf = triangle().gltf();
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3";
  const TemporaryFolder folder;
  for (std::size_t size = 1; size < glb.size(); ++size)
    refusal(folder.write("model.glb", std::string_view(glb).substr(0, size)));
  // Without the final brace, not only without the line end.
  for (std::size_t size = 1; size < gltf.size(); ++size)
    refusal(folder.write("model.gltf", std::string_view(gltf).substr(0, size)));
  for (std::size_t size = 1; size < obj.size(); ++size)
    refusal(folder.write("model.obj", std::string_view(obj).substr(0, size)));
}

TEST(BadModel, GlbContainer) {
  const std::string good = triangle().glb();
  const auto with_word = [&](std::size_t offset, std::uint32_t value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
  };
  expect_refusal("model.glb", with_word(4, 1), {"GLB header", "version 1"});
  expect_refusal("model.glb", with_word(8, 0xFFFFFFFFu), {"GLB header", "4294967295"});
  expect_refusal("model.glb", with_word(8, 4), {"GLB header"});
  expect_refusal("model.glb", with_word(12, 0xFFFFFFFFu), {"GLB chunk 0", "4294967295"});
  expect_refusal("model.glb", with_word(16, 7), {"GLB chunk 0", "JSON"});
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, good.data() + 12, sizeof json_size);
  // A binary chunk that is longer than what is left, by as little as its own header.
  std::uint32_t binary_size = 0;
  std::memcpy(&binary_size, good.data() + 20 + json_size, sizeof binary_size);
  expect_refusal("model.glb", with_word(20 + json_size, binary_size + 8), {"GLB chunk 1"});
  expect_refusal("model.glb", with_word(24 + json_size, 7), {"buffers[0]"});
}

TEST(BadModel, RandomlyDamagedFilesAreReadOrRefused) {
  const unsigned seed = 4711;
  std::mt19937 random(seed);
  Gltf document = triangle();
  use_normal_texture(document, {{"bufferView", 0}},
                     {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 3}}}}}}});
  set_sparse(document, {1, 2});
  document.json["materials"] = json::array();
  primitive(document)["targets"] = {{{"POSITION", 0}, {"NORMAL", 1}}};
  document.json["meshes"][0]["weights"] = {0.5};
  const std::string glb = document.glb();
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\nusemtl a\nf 1/1/1 -2/1/1 3/1/1 1 \\\n2\n";
  const TemporaryFolder folder;
  int read = 0;
  int refused = 0;
  for (int i = 0; i < 4000; ++i) {
    const bool is_glb = i % 2 == 0;
    std::string bytes = is_glb ? glb : obj;
    for (int change = 0; change < 1 + i % 3; ++change)
      bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    try {
      const Model model = read_model(folder.write(is_glb ? "model.glb" : "model.obj", bytes));
      EXPECT_FALSE(model.meshes.empty());
      ++read;
    } catch (const InputError&) {
      ++refused;
    }
  }
  std::printf("seed %u: %d read, %d refused\n", seed, read, refused);
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

TEST(BadModel, ObjNamesTheLine) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n";
  const auto expect = [](const std::string& text, const std::vector<std::string>& fragments) {
    expect_refusal("model.obj", text, fragments);
  };
  expect("v nan 0 0\nf 1 1 1\n", {"model.obj:1:", "\"nan\"", "not a finite number"});
  expect("v 0 0 0\nv 0 inf 0\n", {"model.obj:2:", "\"inf\""});
  expect("v 0 0 1e39\n", {"model.obj:1:", "1e39"});
  expect("v 0 0 1e999\n", {"model.obj:1:", "1e999"});
  expect("v 0 0\n", {"model.obj:1:", "missing"});
  expect("v 0 0 zero\n", {"model.obj:1:", "zero"});
  expect("v 0 0 1,5\n", {"model.obj:1:", "1,5"});
  expect("\n\nvt\n", {"model.obj:3:", "missing"});
  expect("vn 0 0 -nan\n", {"model.obj:1:", "-nan"});
  expect("# nothing\nv 0 0 0\n", {"model.obj: has no faces"});
  expect(good + "f 1 2 4\n", {"model.obj:6:", "v 4", "has 3"});
  expect(good + "f 1 2 -4\n", {"model.obj:6:", "v -4"});
  expect(good + "f 1 2 0\n", {"model.obj:6:", "\"0\""});
  expect(good + "f 1/2 2/1 3/1\n", {"model.obj:6:", "vt 2", "has 1"});
  expect(good + "f 1//1 2//1 3//-2\n", {"model.obj:6:", "vn -2"});
  expect(good + "f 1 2\n", {"model.obj:6:", "2 corners", "3 or more"});
  expect(good + "f 1/1/1/1 2 3\n", {"model.obj:6:", "\"1/1/1/1\""});
  expect(good + "f 1 2 x\n", {"model.obj:6:", "\"x\""});
  expect(good + "f 1 2 3.5\n", {"model.obj:6:", "\"3.5\""});
  expect(good + "f 1 2 99999999999999999999\n", {"model.obj:6:", "\"99999999999999999999\""});
  expect(good + "f 1 2 -9223372036854775808\n", {"model.obj:6:", "\"-9223372036854775808\""});
  expect(good + "f 1 2 9223372036854775807\n", {"model.obj:6:", "\"9223372036854775807\""});
  expect(good + "f 1 2 4294967297\n", {"model.obj:6:", "\"4294967297\""}); // 1 modulo 2^32
  expect(good + "f 1 2 2147483647\n", {"model.obj:6:", "v 2147483647", "has 3"});
  expect(good + "f 1 2 -2147483648\n", {"model.obj:6:", "v -2147483648"});
  expect(good + "f 1/x 2/1 3/1\n", {"model.obj:6:", "\"1/x\""});
  expect(good + "f 1 \\\n2 \\\n7\n", {"model.obj:8:"});
}

} // namespace
} // namespace surfgrad::io
