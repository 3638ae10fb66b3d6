// Whole bakes as glTF: the model that is written shows the normals that were composed, and the Khronos
// validator finds no error in it.

#include "bake/bake.hpp"
#include "bake/model.hpp"
#include "displace/scene.hpp"
#include "io/image_file.hpp"
#include "oracles/oracle.hpp"
#include "support/temporary_folder.hpp"
#include "unit/io/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

namespace surfgrad {
namespace {

struct Case {
  const char* name;
  std::string mesh; ///< of the shared assets; empty: the demo's
  std::string rest; ///< of the document
  int uv_set = 0;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const std::string noise =
    R"("layers": [{ "type": "noise", "function": "turbulence", "space": "object", "frequency": FREQUENCY, "scale": 0.3 }])";

std::string noise_of(const char* frequency) {
  std::string text = noise;
  return text.replace(text.find("FREQUENCY"), 9, frequency);
}

const Case cases[] = {
    {"demo", "", ""},
    {"displaced_demo", "", R"("displace": { "function": "fractal_sum", "frequency": 3, "height": 0.1 })"},
    {"suzanne", "blenderio_suzanne/02_suzanne.gltf", ""},
    {"normal_tangent_test", "khr_NormalTangentTest/NormalTangentTest.glb", ""},
    {"normal_tangent_mirror_test", "khr_NormalTangentMirrorTest/NormalTangentMirrorTest.glb", ""},
    {"ogre_mirrored_uv", "ogre_mirrored_uv/testmirroreduvmesh_converted.obj", noise_of("0.2")},
    {"pirate", "mmikk_meshes/LP_Pirate.obj", noise_of("0.5")},
    {"second_uv_set", "khr_MultiUVTest/MultiUVTest.glb", noise_of("2"), 1},
    {"house", "pc_house/house.glb", noise_of("2"), 1},
    {"boombox", "mx_boombox/boombox.glb", noise_of("20")},
    {"displaced_suzanne", "blenderio_suzanne/02_suzanne.gltf",
     noise_of("4") + R"(, "displace": { "function": "fractal_sum", "frequency": 2, "height": 0.05 })"},
};

/// A document of the case, beside which its mesh is named absolutely.
scene::Scene load(const Case& c) {
  std::string document = R"({ "surfgrad": 1)";
  if (!c.mesh.empty()) document += R"(, "mesh": ")" SURFGRAD_SHARED_DIR "/assets/mesh/" + c.mesh + "\"";
  if (!c.rest.empty()) document += ", " + c.rest;
  const test::TemporaryFolder folder;
  return scene::load_scene(folder.write("stack.json", std::string_view(document + " }")));
}

/// Whether a triangle lies over the texel's centre. Where none does a bake takes the nearest point of one
/// that reaches into the texel: the map decodes to its normal there, not at the centre.
std::vector<bool> centres_covered(const scene::Scene& scene, const bake::Options& options) {
  std::vector<bool> covered(static_cast<std::size_t>(options.width) *
                            static_cast<std::size_t>(options.height));
  for (const scene::Object& object : scene.objects) {
    const mesh::TriangleMesh& mesh = scene.meshes[object.mesh];
    for (const auto& triangle : mesh.triangles) {
      std::array<vec2<double>, 3> corner{};
      vec2<double> low{1e9, 1e9};
      vec2<double> high{-1e9, -1e9};
      for (std::size_t c = 0; c < 3; ++c) {
        const vec2<float> uv = mesh.uv_sets[static_cast<std::size_t>(options.uv_set)][triangle[c]];
        corner[c] = {double{uv.x} * options.width, double{uv.y} * options.height};
        low = {std::min(low.x, corner[c].x), std::min(low.y, corner[c].y)};
        high = {std::max(high.x, corner[c].x), std::max(high.y, corner[c].y)};
      }
      const auto area = [&](vec2<double> p, std::size_t e) {
        const vec2<double> from = corner[e];
        const vec2<double> to = corner[(e + 1) % 3];
        return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
      };
      const double sign = area(corner[2], 0) < 0 ? -1 : 1;
      for (int y = std::max(0, static_cast<int>(low.y)); y < std::min<double>(options.height, high.y); ++y)
        for (int x = std::max(0, static_cast<int>(low.x)); x < std::min<double>(options.width, high.x); ++x) {
          const vec2<double> p{x + 0.5, y + 0.5};
          bool is_inside = true;
          for (std::size_t e = 0; e < 3; ++e) is_inside = is_inside && sign * area(p, e) > 0;
          if (is_inside) covered[static_cast<std::size_t>(y * options.width + x)] = true;
        }
    }
  }
  return covered;
}

/// Angles between the world-space normals of two scenes over the centres of texels, sorted.
std::vector<double> angles_between(const scene::Scene& a, const scene::Scene& b,
                                   const bake::Options& options) {
  bake::Options world = options;
  world.space = bake::Space::world;
  world.depth = image::Depth::float32;
  world.padding = 0;
  const bake::Baked first = bake::bake(a, world);
  const bake::Baked second = bake::bake(b, world);
  EXPECT_EQ(first.covered, second.covered);
  const std::vector<bool> covered = centres_covered(b, options);
  std::vector<double> degrees;
  const auto normal = [](const image::Image& map, int x, int y) {
    return vec3<double>{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1};
  };
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) {
      if (!covered[static_cast<std::size_t>(y * options.width + x)]) continue;
      const vec3<double> n = normal(first.map, x, y);
      const vec3<double> m = normal(second.map, x, y);
      degrees.push_back(std::atan2(length(cross(n, m)), dot(n, m)) * 180 / std::numbers::pi);
    }
  std::ranges::sort(degrees);
  return degrees;
}

class BakedGltf : public testing::TestWithParam<Case> {};

TEST_P(BakedGltf, ShowsTheNormalsThatWereComposed) {
  const Case& c = GetParam();
  if (!c.mesh.empty() && !std::filesystem::exists(SURFGRAD_SHARED_DIR "/assets/mesh/" + c.mesh))
    GTEST_SKIP() << c.mesh << " is absent";
  const scene::Scene scene = load(c);
  const bake::Options options{
      .width = 256, .height = 256, .uv_set = c.uv_set, .padding = 16, .depth = image::Depth::unorm16};
  const bake::Baked baked = bake::bake(scene, options);
  const std::vector<std::byte> png = io::encode_image(baked.map, options.depth, io::ImageFormat::png);
  const std::vector<std::byte> glb = bake::encode_model_with_maps(
      scene, {.uv_set = c.uv_set, .normal_png = png, .is_repeated = baked.outside > 0});

  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("out.glb", glb);
  EXPECT_EQ(test::validator_errors({file}), "");
  const std::vector<double> degrees = angles_between(scene, scene::load_scene(file), options);
  double sum = 0;
  for (const double angle : degrees) sum += angle;
  const double mean = sum / static_cast<double>(degrees.size());
  const std::int64_t impossible = baked.singular + baked.clamped;
  const double most = degrees[degrees.size() - 1 - static_cast<std::size_t>(impossible)];
  std::printf("  %s: mean %.5f, most %.5f degrees over %zu texels\n", c.name, mean, most, degrees.size());
  EXPECT_LE(impossible, 2); // normals that no map in tangent space can hold
  EXPECT_GT(degrees.size(), 4000u);
  EXPECT_GT(mean, 0.0) << "two scenes of the same layers are compared";
  // The product's targets for maps of 16 bits.
  EXPECT_LT(mean, 0.01);
  EXPECT_LT(most, 0.1);
}

TEST(BakedGltfOfADocument, HasTheShapeOfItsMorphWeights) {
  io::test::Gltf model = io::test::triangle();
  model.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", model.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}};
  const test::TemporaryFolder folder;
  folder.write("m.gltf", model.gltf());
  const scene::Scene scene = scene::load_scene(
      folder.write("s.json", R"({ "surfgrad": 1, "mesh": "m.gltf", "morph": [3], )" + noise_of("2") + " }"));
  const bake::Baked baked = bake::bake(scene, {.width = 8, .height = 8, .depth = image::Depth::unorm16});
  const std::vector<std::byte> glb = bake::encode_model_with_maps(
      scene, {.normal_png = io::encode_image(baked.map, image::Depth::unorm16, io::ImageFormat::png)});
  const std::filesystem::path file = folder.write("out.glb", glb);
  EXPECT_EQ(test::validator_errors({file}), "");
  EXPECT_EQ(scene::load_scene(file).meshes.at(0).positions.at(0).z, 3);
}

INSTANTIATE_TEST_SUITE_P(Bake, BakedGltf, testing::ValuesIn(cases),
                         [](const auto& c) { return std::string(c.param.name); });

} // namespace
} // namespace surfgrad
