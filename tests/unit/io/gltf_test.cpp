#include "io/image_file.hpp"
#include "io/model_file.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace surfgrad::io {
namespace {

using nlohmann::json;
using test::Gltf;
using test::TemporaryFolder;
using test::triangle;
using testing::ElementsAre;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Model read(const Gltf& document) {
  const TemporaryFolder folder;
  return read_model(folder.write("model.gltf", document.gltf()));
}

vec3<double> transformed(const mat4<double>& m, vec3<double> p) {
  const vec4<double> q = m * vec4<double>{p.x, p.y, p.z, 1};
  return {q.x, q.y, q.z};
}

void expect_near(vec3<double> a, vec3<double> b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Gltf, TextureOriginMovesToTheLowerLeftAndTrianglesKeepTheirOrder) {
  const Model model = read(triangle());
  ASSERT_EQ(model.meshes.size(), 1u);
  const mesh::TriangleMesh& mesh = model.meshes[0];
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.positions[1].x, 1.0f);
  EXPECT_EQ(mesh.positions[2].y, 1.0f);
  EXPECT_EQ(mesh.normals[2].z, 1.0f);
  ASSERT_EQ(mesh.uv_sets.size(), 1u);
  EXPECT_EQ(mesh.uv_sets[0][0].y, 1.0f);
  EXPECT_EQ(mesh.uv_sets[0][1].x, 1.0f);
  EXPECT_EQ(mesh.uv_sets[0][1].y, 0.75f);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_TRUE(mesh.tangent_spaces.empty());
  ASSERT_EQ(model.objects.size(), 1u);
  EXPECT_EQ(model.objects[0].name, "nodes[0]");
  EXPECT_EQ(model.objects[0].world_from_object.x.x, 1.0);
  ASSERT_EQ(model.materials.size(), 1u);
  EXPECT_EQ(model.materials[0].name, "default");
  EXPECT_FALSE(model.materials[0].double_sided);
}

TEST(Gltf, BinaryFormHoldsTheSameModel) {
  const TemporaryFolder folder;
  const Model model = read_model(folder.write("MODEL.GLB", triangle().glb()));
  ASSERT_EQ(model.meshes.size(), 1u);
  EXPECT_EQ(model.meshes[0].positions[1].x, 1.0f);
  EXPECT_EQ(model.meshes[0].uv_sets[0][1].y, 0.75f);
  EXPECT_EQ(model.meshes[0].triangles, (Triangles{{0, 1, 2}}));
}

TEST(Gltf, ContentDecidesBetweenTheTwoForms) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_model(folder.write("binary.gltf", triangle().glb())).meshes.size(), 1u);
  EXPECT_EQ(read_model(folder.write("text.glb", "\xEF\xBB\xBF" + triangle().gltf())).meshes.size(), 1u);
}

TEST(Gltf, IndicesOfEveryWidthOrNone) {
  Gltf document = triangle();
  const auto with_indices = [&](std::size_t accessor) {
    document.json["meshes"][0]["primitives"][0]["indices"] = accessor;
    return read(document).meshes[0].triangles;
  };
  const Triangles expected{{2, 0, 1}};
  EXPECT_EQ(with_indices(document.accessor<std::uint8_t>({2, 0, 1}, "SCALAR")), expected);
  EXPECT_EQ(with_indices(document.accessor<std::uint16_t>({2, 0, 1}, "SCALAR")), expected);
  EXPECT_EQ(with_indices(document.accessor<std::uint32_t>({2, 0, 1}, "SCALAR")), expected);
  document.json["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(read(document).meshes[0].triangles, (Triangles{{0, 1, 2}}));
}

TEST(Gltf, StripsAndFansKeepTheirFront) {
  Gltf document;
  // A strip zigzags upwards; a fan turns counter-clockwise around its first vertex.
  const std::size_t strip = document.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3");
  const std::size_t fan = document.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0}, "VEC3");
  document.mesh({{{"attributes", {{"POSITION", strip}, {"NORMAL", strip}}}, {"mode", 5}},
                 {{"attributes", {{"POSITION", fan}, {"NORMAL", fan}}}, {"mode", 6}}});
  const Model model = read(document);
  ASSERT_EQ(model.meshes.size(), 2u);
  EXPECT_EQ(model.meshes[0].triangles, (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(model.meshes[1].triangles, (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  for (const mesh::TriangleMesh& mesh : model.meshes)
    for (const auto& t : mesh.triangles) {
      const vec3<float> a = mesh.positions[t[0]];
      EXPECT_EQ(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).z, 1.0f);
    }
}

TEST(Gltf, PointsAndLinesAreLeftOut) {
  Gltf document = triangle();
  for (const int mode : {0, 1, 2, 3})
    document.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
  EXPECT_EQ(read(document).meshes.size(), 1u);
  EXPECT_EQ(read(document).objects.size(), 1u);
}

TEST(Gltf, InterleavedAttributes) {
  Gltf document;
  const std::vector<float> vertices{0, 0, 0, 9, 0.5f, 0.25f, 1, 0, 0, 9, 0.75f, 1, 0, 1, 0, 9, 0, 0};
  const std::size_t view = document.view(
      std::string_view(reinterpret_cast<const char*>(vertices.data()), vertices.size() * sizeof(float)), 24);
  document.json["accessors"] = {
      {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
      {{"bufferView", view}, {"byteOffset", 16}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}}};
  document.mesh({{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}, {"NORMAL", 0}}}}});
  const mesh::TriangleMesh mesh = read(document).meshes[0];
  EXPECT_EQ(mesh.positions[1].x, 1.0f);
  EXPECT_EQ(mesh.positions[2].y, 1.0f);
  EXPECT_EQ(mesh.uv_sets[0][0].x, 0.5f);
  EXPECT_EQ(mesh.uv_sets[0][0].y, 0.75f);
  EXPECT_EQ(mesh.uv_sets[0][1].x, 0.75f);
}

TEST(Gltf, SparseValuesReplaceThoseOfTheBufferViewOrZeros) {
  Gltf document = triangle();
  const std::size_t indices = document.view<std::uint8_t>({1, 2});
  const std::size_t values = document.view<float>({5, 6, 7, 8, 9, 10});
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                       {"values", {{"bufferView", values}}}};
  document.json["accessors"][0]["sparse"] = sparse;
  document.json["accessors"][1]["sparse"] = sparse;
  document.json["accessors"][1].erase("bufferView");
  const mesh::TriangleMesh mesh = read(document).meshes[0];
  EXPECT_EQ(mesh.positions[0].x, 0.0f);
  EXPECT_EQ(mesh.positions[1].x, 5.0f);
  EXPECT_EQ(mesh.positions[2].z, 10.0f);
  EXPECT_EQ(mesh.normals[0].z, 0.0f);
  EXPECT_EQ(mesh.normals[1].z, 7.0f);
}

TEST(Gltf, AllUvSetsInEveryNumberFormat) {
  Gltf document = triangle();
  json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_1"] = document.accessor<std::uint8_t>({0, 255, 51, 0, 255, 102}, "VEC2", true);
  attributes["TEXCOORD_2"] =
      document.accessor<std::uint16_t>({0, 65535, 13107, 0, 65535, 26214}, "VEC2", true);
  const mesh::TriangleMesh mesh = read(document).meshes[0];
  ASSERT_EQ(mesh.uv_sets.size(), 3u);
  for (const std::size_t set : {1u, 2u}) {
    EXPECT_FLOAT_EQ(mesh.uv_sets[set][0].y, 0.0f);
    EXPECT_FLOAT_EQ(mesh.uv_sets[set][1].x, 0.2f);
    EXPECT_FLOAT_EQ(mesh.uv_sets[set][2].y, 0.6f);
  }
}

TEST(Gltf, QuantizedMesh) {
  Gltf document;
  document.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  document.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const std::size_t position = document.accessor<std::int16_t>({0, 0, 0, -300, 0, 0, 0, 200, 0}, "VEC3");
  const std::size_t normal = document.accessor<std::int8_t>({0, 0, 127, 0, -128, 0, 64, 0, 0}, "VEC3", true);
  document.mesh({{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}}});
  const mesh::TriangleMesh mesh = read(document).meshes[0];
  EXPECT_EQ(mesh.positions[1].x, -300.0f);
  EXPECT_EQ(mesh.normals[0].z, 1.0f);
  EXPECT_EQ(mesh.normals[1].y, -1.0f); // -128 counts as -127
  EXPECT_FLOAT_EQ(mesh.normals[2].x, 64.0f / 127.0f);
}

TEST(Gltf, NodesComposeTheirTransforms) {
  Gltf document = triangle();
  const double h = std::sqrt(0.5);
  // Parent: a quarter turn around z after doubling x, then moved; child: a matrix that mirrors z.
  document.json["nodes"] = {
      {{"name", "parent"},
       {"translation", {10, 20, 30}},
       {"rotation", {0, 0, h, h}},
       {"scale", {2, 1, 1}},
       {"children", {1}}},
      {{"name", "child"}, {"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 1, 2, 3, 1}}}};
  const Model model = read(document);
  ASSERT_EQ(model.objects.size(), 1u);
  EXPECT_EQ(model.objects[0].name, "child");
  // (x, y, z) -> (x+1, y+2, 3-z) -> (2x+2, y+2, 3-z) -> (-y-2, 2x+2, 3-z) -> + (10, 20, 30).
  // Tolerance: a few roundings of numbers up to 40.
  expect_near(transformed(model.objects[0].world_from_object, {0, 0, 0}), {8, 22, 33}, 1e-13);
  expect_near(transformed(model.objects[0].world_from_object, {1, 2, 3}), {6, 24, 30}, 1e-13);
  EXPECT_EQ(model.meshes[0].triangles, (Triangles{{0, 1, 2}}));
}

TEST(Gltf, RotationsTurnAsQuaternionsOfAnyLength) {
  Gltf document = triangle();
  const vec3<double> q{0.3, -0.7, 0.2};
  const double w = 1.1;
  document.json["nodes"][0]["rotation"] = {q.x, q.y, q.z, w};
  const mat4<double> m = read(document).objects[0].world_from_object;
  const vec3<double> p{1, 2, 3};
  // v + 2 q x (q x v + w v) for a unit quaternion: another route than the matrix.
  const double square = dot(q, q) + w * w;
  const vec3<double> expected = p + (2 / square) * cross(q, cross(q, p) + w * p);
  expect_near(transformed(m, p), expected, 1e-14); // a few roundings of numbers up to 4
}

TEST(Gltf, SceneThatIsShown) {
  Gltf document = triangle();
  document.json["nodes"] = {
      {{"name", "a"}, {"mesh", 0}}, {{"name", "b"}, {"mesh", 0}}, {{"name", "c"}, {"children", {0}}}};
  const auto names = [&] {
    std::vector<std::string> result;
    for (const ModelObject& object : read(document).objects) result.push_back(object.name);
    return result;
  };
  EXPECT_THAT(names(), ElementsAre("b", "a")); // all nodes, parents in order
  document.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {1, 0}}}};
  EXPECT_THAT(names(), ElementsAre("a")); // the first scene
  document.json["scene"] = 1;
  EXPECT_THAT(names(), ElementsAre("b", "a"));
}

TEST(Gltf, NodesShareAMesh) {
  Gltf document = triangle();
  document.json["nodes"].push_back({{"mesh", 0}, {"translation", {1, 0, 0}}});
  const Model model = read(document);
  EXPECT_EQ(model.meshes.size(), 1u);
  ASSERT_EQ(model.objects.size(), 2u);
  EXPECT_EQ(model.objects[0].mesh, model.objects[1].mesh);
  EXPECT_EQ(model.objects[1].world_from_object.x.w, 1.0);
}

TEST(Gltf, MaterialsKeepTheirOrderAndSides) {
  Gltf document = triangle();
  document.json["materials"] = {{{"name", "skin"}}, {{"doubleSided", true}}};
  json& primitives = document.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives.push_back(primitives[0]);
  primitives[0]["material"] = 1;
  primitives[2]["material"] = 0;
  const Model model = read(document);
  ASSERT_EQ(model.materials.size(), 3u);
  EXPECT_EQ(model.materials[0].name, "skin");
  EXPECT_EQ(model.materials[1].name, "material_1");
  EXPECT_EQ(model.materials[2].name, "default");
  EXPECT_FALSE(model.materials[0].double_sided);
  EXPECT_TRUE(model.materials[1].double_sided);
  EXPECT_THAT(model.meshes[0].material_of_triangle, ElementsAre(1));
  EXPECT_THAT(model.meshes[1].material_of_triangle, ElementsAre(2));
  EXPECT_THAT(model.meshes[2].material_of_triangle, ElementsAre(0));
}

/// A PNG of one texel with the given red.
std::string png(float red) {
  image::Image image = image::make_image(1, 1, 3);
  image.texels = {red, 0.0f, 1.0f};
  const std::vector<std::byte> bytes = encode_image(image, image::Depth::unorm8, ImageFormat::png);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(Gltf, NormalTexturesFromFilesDataAndBufferViews) {
  const TemporaryFolder folder;
  Gltf document = triangle();
  const std::size_t view = document.view(png(0.2f));
  document.json["images"] = {{{"uri", "maps/normal%20map+1%25.png"}},
                             {{"uri", "data:image/png;base64," + test::base64(png(0.4f))}},
                             {{"bufferView", view}, {"mimeType", "image/png"}},
                             {{"uri", "base_colour_that_does_not_exist.png"}}};
  document.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}, json::object()};
  document.json["textures"] = {
      {{"source", 0}, {"sampler", 0}}, {{"source", 1}, {"sampler", 1}}, {{"source", 2}}, {{"source", 3}}};
  document.json["materials"] = {{{"normalTexture", {{"index", 0}, {"scale", 0.5}, {"texCoord", 3}}},
                                 {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 3}}}}}},
                                {{"normalTexture", {{"index", 1}}}},
                                {{"normalTexture", {{"index", 2}}}},
                                {{"normalTexture", {{"index", 0}}}}};
  folder.write("maps/normal map+1%.png", png(0.6f));
  const std::filesystem::path file = folder.write("model.gltf", document.gltf());
  const Model model = read_model(file);
  ASSERT_EQ(model.materials.size(), 5u);
  const auto& normal = [&](std::size_t material) -> const ModelTexture& {
    return *model.materials[material].normal;
  };
  // 8-bit codes of the reds: exact after rounding.
  EXPECT_FLOAT_EQ(normal(0).image->at(0, 0, 0), 153.0f / 255.0f);
  EXPECT_FLOAT_EQ(normal(1).image->at(0, 0, 0), 102.0f / 255.0f);
  EXPECT_FLOAT_EQ(normal(2).image->at(0, 0, 0), 51.0f / 255.0f);
  EXPECT_EQ(normal(0).name, file.parent_path() / "maps/normal map+1%.png");
  EXPECT_EQ(normal(1).name, file.string() + ":images[1]");
  EXPECT_EQ(normal(3).image, normal(0).image);
  EXPECT_EQ(normal(0).scale, 0.5);
  EXPECT_EQ(normal(0).uv_set, 3);
  EXPECT_EQ(normal(0).wrap_s, image::Wrap::clamp);
  EXPECT_EQ(normal(0).wrap_t, image::Wrap::mirror);
  EXPECT_EQ(normal(1).scale, 1.0);
  EXPECT_EQ(normal(1).uv_set, 0);
  EXPECT_EQ(normal(1).wrap_s, image::Wrap::repeat);
  EXPECT_EQ(normal(2).wrap_t, image::Wrap::repeat);
  EXPECT_FALSE(model.materials[4].normal.has_value());
}

TEST(Gltf, TextureTransformFollowsTheFlip) {
  const unsigned seed = 20240607;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  Gltf document = triangle();
  document.json["extensionsUsed"] = {"KHR_texture_transform"};
  document.json["extensionsRequired"] = {"KHR_texture_transform"};
  document.json["images"] = {{{"uri", "data:image/png;base64," + test::base64(png(0.5f))}}};
  document.json["textures"] = {{{"source", 0}}};
  double worst = 0.0;
  for (int i = 0; i < 50; ++i) {
    const double ox = uniform(random), oy = uniform(random), sx = uniform(random), sy = uniform(random);
    const double angle = uniform(random), u = uniform(random), v = uniform(random);
    document.json["materials"] = {
        {{"normalTexture",
          {{"index", 0},
           {"texCoord", 1},
           {"extensions",
            {{"KHR_texture_transform",
              {{"offset", {ox, oy}}, {"rotation", angle}, {"scale", {sx, sy}}, {"texCoord", 2}}}}}}}}};
    const ModelTexture texture = *read(document).materials[0].normal;
    EXPECT_EQ(texture.uv_set, 2);
    // The definition: scale, turn counter-clockwise as one looks at the image (v points down), move.
    const std::complex<double> turned = std::polar(1.0, angle) * std::complex<double>(sx * u, -sy * v);
    const double s_expected = turned.real() + ox;
    const double t_expected = 1.0 - (-turned.imag() + oy);
    const double x = texture.tile.x * u, y = texture.tile.y * (1.0 - v);
    const double c = std::cos(texture.rotate_rad), s = std::sin(texture.rotate_rad);
    worst = std::max({worst, std::abs(c * x - s * y + texture.offset.x - s_expected),
                      std::abs(s * x + c * y + texture.offset.y - t_expected)});
  }
  std::printf("worst difference %.2g (seed %u)\n", worst, seed);
  EXPECT_LT(worst, 1e-13); // a few roundings of sums of numbers up to 20, in double
}

TEST(Gltf, TangentsBelongToTheSetOfTheNormalTextureAndKeepTheirSign) {
  Gltf document = triangle();
  json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TANGENT"] =
      document.accessor<float>({1, 0, 0, 1, 0, 1, 0, -1, 0, 0, 1, 1}, "VEC4");
  primitive["indices"] = document.accessor<std::uint16_t>({1, 2, 0}, "SCALAR");
  const auto check = [](const mesh::TriangleMesh& mesh, std::size_t set) {
    ASSERT_EQ(mesh.tangent_spaces.size(), set + 1);
    const auto& corners = mesh.tangent_spaces[set].corners;
    ASSERT_EQ(corners.size(), 3u);
    EXPECT_EQ(corners[0].y, 1.0f);
    EXPECT_EQ(corners[0].w, -1.0f);
    EXPECT_EQ(corners[1].z, 1.0f);
    EXPECT_EQ(corners[2].x, 1.0f);
    EXPECT_EQ(corners[2].w, 1.0f);
  };
  check(read(document).meshes[0], 0);

  primitive["attributes"]["TEXCOORD_1"] = 2;
  primitive["material"] = 0;
  document.json["images"] = {{{"uri", "data:image/png;base64," + test::base64(png(0.5f))}}};
  document.json["textures"] = {{{"source", 0}}};
  document.json["materials"] = {{{"normalTexture", {{"index", 0}, {"texCoord", 1}}}}};
  const mesh::TriangleMesh mesh = read(document).meshes[0];
  check(mesh, 1);
  EXPECT_TRUE(mesh.tangent_spaces[0].corners.empty());
}

TEST(Gltf, MissingNormalsBecomeFlatAndTangentsGo) {
  Gltf document = triangle();
  json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  attributes.erase("NORMAL");
  attributes["TANGENT"] = document.accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  const mesh::TriangleMesh mesh = read(document).meshes[0];
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const vec3<float>& normal : mesh.normals) EXPECT_EQ(normal.z, 1.0f);
  EXPECT_TRUE(mesh.tangent_spaces.empty());
  EXPECT_EQ(mesh.uv_sets.size(), 1u);
  EXPECT_EQ(mesh.material_of_triangle.size(), 1u);
}

TEST(Gltf, DeepDocumentsNeedNoDeepStack) {
  Gltf document = triangle();
  json& nodes = document.json["nodes"];
  constexpr std::size_t depth = 100000; // one call frame a level would overflow an 8 MB stack
  nodes = json::array();
  for (std::size_t i = 0; i < depth; ++i)
    nodes.push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  document.json["scenes"] = {{{"nodes", {0}}}};
  EXPECT_EQ(read(document).objects[0].world_from_object.x.w, static_cast<double>(depth));

  const TemporaryFolder folder;
  std::string text = triangle().gltf();
  text.insert(1, "\"extras\":" + std::string(1000000, '[') + std::string(1000000, ']') + ",");
  EXPECT_EQ(read_model(folder.write("deep.gltf", text)).meshes.size(), 1u);
}

} // namespace
} // namespace surfgrad::io
