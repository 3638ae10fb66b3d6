// The roughness that a shader gives: of maps whose slopes are known, far away and near, on a device.

#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/shader.hpp"
#include "gpu/texture.hpp"
#include "image/pyramid.hpp"
#include "stacks.hpp"
#include "support/random.hpp"
#include "support/vulkan.hpp"

#include <surfgrad/vec.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace surfgrad::shadergen::test {
namespace {

using surfgrad::test::Random;

constexpr int side = 64;

/// A normal map of Gaussian slopes, each texel its own.
struct Scatter {
  std::vector<float> codes{};
  double variance = 0; ///< of its slopes, the mean of both axes: what was drawn, not what was asked for

  Scatter(Random& random, double deviation) {
    vec2<double> sum{}, squares{};
    for (int i = 0; i < side * side; ++i) {
      // Box and Muller's pair.
      const double r = deviation * std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
      const double angle = random.uniform(0, 6.283185307179586);
      const vec2<double> slope{r * std::cos(angle), r * std::sin(angle)};
      sum = sum + slope;
      squares = squares + slope * slope;
      const vec3<double> n = normalize_or_zero(vec3<double>{-slope.x, -slope.y, 1});
      for (const double c : {n.x, n.y, n.z}) codes.push_back(static_cast<float>(0.5 * c + 0.5));
    }
    constexpr double share = 1.0 / (side * side);
    const vec2<double> spread = share * squares - (share * sum) * (share * sum);
    variance = 0.5 * (spread.x + spread.y);
  }
};

class Roughness : public surfgrad::test::VulkanTest {
 protected:
  void SetUp() override {
    VulkanTest::SetUp();
    Random random(20261122);
    for (const auto& [name, deviation] : {std::pair{"smooth", 0.05}, {"rough", 0.1}, {"coarse", 0.2}})
      maps_.emplace(name, Scatter(random, deviation));
  }

  [[nodiscard]] double variance_of(const char* map) const { return maps_.at(map).variance; }

  /// What the layers make of a base roughness where a pixel is 2^lod texels wide.
  std::vector<float> roughness(const std::string& layers, const std::vector<float>& bases, int lod) {
    const NamedStack stack =
        parsed("rough", R"({ "surfgrad": 1, "back_faces": "same", "layers": [)" + layers + "] }");
    Options options = options_of(stack, Language::glsl);
    options.standalone = true;
    options.roughness = true;
    const Shader shader = generate(stack.layers, options);
    const std::string footprint = fmt::format("{:f}", std::ldexp(1.0 / side, lod));
    // A plane on which the texture coordinate is the position.
    const std::string place = "vec3(0.1 * float(i), 0.0, 0.0)";
    const std::map<std::string, std::string> values{{"roughness", "bases[i]"},
                                                    {"normal", "vec3(0.0, 0.0, 1.0)"},
                                                    {"st0", place + ".xy"},
                                                    {"dst0_dx", "vec2(" + footprint + ", 0.0)"},
                                                    {"dst0_dy", "vec2(0.0, " + footprint + ")"},
                                                    {"tangent0", "vec4(1.0, 0.0, 0.0, 1.0)"},
                                                    {"position", place},
                                                    {"world_position", place},
                                                    {"world_origin", "vec3(0.0)"},
                                                    {"dp_dx", "vec3(" + footprint + ", 0.0, 0.0)"},
                                                    {"dp_dy", "vec3(0.0, " + footprint + ", 0.0)"}};
    std::string fills;
    for (const SurfaceMember& member : shader.surface)
      fills += fmt::format("  s.{} = {};\n", member.name, values.at(member.name));
    const gpu::Spirv spirv =
        gpu::compile({.text = fmt::format("#version 450\n{}"
                                          "layout(local_size_x = 1) in;\n"
                                          "layout(binding = 40) readonly buffer In {{ float bases[]; }};\n"
                                          "layout(binding = 41) buffer Out {{ float results[]; }};\n"
                                          "void main() {{\n"
                                          "  int i = int(gl_GlobalInvocationID.x);\n"
                                          "  RoughSurface s;\n{}"
                                          "  results[i] = rough_normal(s).roughness;\n"
                                          "}}\n",
                                          shader.source, fills)});
    std::vector<gpu::Binding> bindings{{40}, {41}, {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    const auto decals_binding = static_cast<std::uint32_t>(shader.decals_binding);
    if (shader.decal_count > 0) bindings.push_back({decals_binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
    for (const TextureBinding& t : shader.textures)
      bindings.push_back({static_cast<std::uint32_t>(t.binding), VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
    const gpu::ComputePipeline pipeline(device(), spirv, bindings);
    gpu::BoundResources resources(device(), pipeline);
    const gpu::Buffer input = gpu::make_device_buffer(device(), std::as_bytes(std::span(bases)));
    const gpu::Buffer output(device(), 4 * bases.size(), gpu::Residence::result);
    const gpu::Buffer parameters = gpu::make_device_buffer(device(), shader.parameter_data);
    resources.bind(40, input);
    resources.bind(41, output);
    resources.bind(0, parameters);
    gpu::Buffer decals;
    if (shader.decal_count > 0) {
      decals = gpu::make_device_buffer(device(), shader.decal_data);
      resources.bind(decals_binding, decals);
    }
    const auto sampler = gpu::make_sampler(device(), gpu::Sampling::trilinear, gpu::Addressing::repeat,
                                           gpu::Addressing::repeat);
    std::vector<gpu::Texture> textures;
    for (const TextureBinding& t : shader.textures)
      textures.emplace_back(
          device(), image::with_pyramid(image::rows_of(maps_.at(t.files[0].path.string()).codes, side, 3),
                                        side, side, 3));
    for (std::size_t i = 0; i < textures.size(); ++i)
      resources.bind(static_cast<std::uint32_t>(shader.textures[i].binding), textures[i], sampler.get());
    device().run([&](VkCommandBuffer commands) {
      resources.dispatch(commands, static_cast<std::uint32_t>(bases.size()));
      gpu::barrier_after_writes(commands);
    });
    std::vector<float> result(bases.size());
    std::memcpy(result.data(), output.mapped().data(), 4 * result.size());
    return result;
  }

  /// Of the whole maps in one pixel.
  ///
  /// hidden            variance of the slopes along an axis
  /// of_the_worst_map  the largest variance of one map
  void expect_widened(const std::string& layers, double hidden, double of_the_worst_map) {
    const std::vector<float> bases{0.05F, 0.3F, 0.7F};
    const std::vector<float> results = roughness(layers, bases, 6);
    for (std::size_t i = 0; i < bases.size(); ++i) {
      const double alpha = double{bases[i]} * bases[i];
      const double truth = std::min(std::pow(alpha * alpha + 2 * hidden, 0.25), 1.0);
      // A map's estimate v falls short by 2 v^2 (support.glsl), and alpha^2 with that by a share of at most 2
      // v: its fourth root by v / 2. What a sample of 4096 slopes has of higher moments is a tenth of that.
      // Floats round 1 - |m| by some 2^-23 of variances from 0.0006 on: 1e-4 of a root.
      const double bound = 0.55 * of_the_worst_map + 1e-4;
      const double error = results[i] / truth - 1;
      std::printf("  base %.2f: %.4f, truth %.4f, relative error %+.4f, bound -%.4f\n", double{bases[i]},
                  double{results[i]}, truth, error, bound);
      EXPECT_GE(error, -bound) << layers;
      EXPECT_LE(error, 1e-4) << layers; // never rougher
    }
  }

 private:
  std::map<std::string, Scatter> maps_;
};

std::string layer(const char* map, const char* more = "") {
  return fmt::format(R"({{ "type": "normal_map", "map": "{}", "channels": "xyz"{} }})", map, more);
}

TEST_F(Roughness, FarAwayIsThatOfTheSlopes) {
  for (const char* map : {"smooth", "rough", "coarse"})
    expect_widened(layer(map), variance_of(map), variance_of(map));
}

TEST_F(Roughness, ScalesAndWeightsCountSquaredAndLayersAddUp) {
  const double smooth = variance_of("smooth"), rough = variance_of("rough");
  expect_widened(layer("rough", R"(, "scale": 0.5)"), 0.25 * rough, rough);
  expect_widened(layer("smooth", R"(, "scale": -2)") + "," +
                     layer("rough", R"(, "opacity": 0.5, "scale": 3)"),
                 4 * smooth + 2.25 * rough, rough);
}

TEST_F(Roughness, WhatAMixReplacesDoesNotCount) {
  const double smooth = variance_of("smooth"), rough = variance_of("rough");
  expect_widened(layer("rough") + "," + layer("smooth", R"(, "blend": "mix", "opacity": 0.75)"),
                 0.0625 * rough + 0.5625 * smooth, rough);
  // A derivative map hides what nobody knows, and replaces all the same.
  expect_widened(layer("rough") +
                     R"(, { "type": "derivative_map", "map": "smooth", "blend": "mix", "opacity": 0.5 })",
                 0.25 * rough, rough);
}

TEST_F(Roughness, PassesAddUp) {
  const double smooth = variance_of("smooth"), rough = variance_of("rough");
  expect_widened(layer("rough") + R"(, { "type": "resolve" }, )" +
                     layer("smooth", R"(, "blend": "mix", "opacity": 0.5)"),
                 rough + 0.25 * smooth, rough);
}

TEST_F(Roughness, TilesDoNotChangeIt) {
  expect_widened(layer("rough", R"(, "tile": [1, -1], "rotate": 90, "green": "down")"), variance_of("rough"),
                 variance_of("rough"));
}

TEST_F(Roughness, ProjectedMapsTellToo) {
  const double rough = variance_of("rough");
  expect_widened(R"({ "type": "planar", "map": "rough", "channels": "xyz", "space": "world", "axis": "z" })",
                 rough, rough);
  // The surface faces one plane, which has all the weight.
  expect_widened(R"({ "type": "triplanar", "map": "rough", "channels": "xyz", "space": "world" })", rough,
                 rough);
}

TEST_F(Roughness, DecalsAddMixAndReplace) {
  const double smooth = variance_of("smooth"), rough = variance_of("rough");
  expect_widened(layer("rough") +
                     R"(, { "type": "decal", "map": "smooth", "channels": "xyz", "falloff": 0, "instances": [
    { "blend": "mix", "opacity": 0.5 }, { "blend": "replace", "opacity": 0.5 }, { "scale": 2 },
    { "position": [9, 9, 9], "blend": "replace" } ] })",
                 rough / 16 + smooth / 16 + smooth / 4 + 4 * smooth, rough);
  // Heights tell nothing, and cover all the same.
  expect_widened(layer("rough") + R"(, { "type": "decal", "map": "smooth", "content": "height", "falloff": 0,
    "blend": "mix", "opacity": 0.5 })",
                 rough / 4, rough);
}

TEST_F(Roughness, NearIsTheBases) {
  const std::vector<float> bases{0.05F, 0.3F, 0.7F, 1};
  for (const int lod : {-3, 0}) {
    const std::vector<float> results = roughness(layer("coarse"), bases, lod);
    for (std::size_t i = 0; i < bases.size(); ++i) EXPECT_NEAR(results[i], bases[i], 1e-6F * bases[i]);
  }
}

TEST_F(Roughness, OfMapsThatTellNothingIsTheBases) {
  const std::vector<float> bases{0.05F, 0.7F};
  for (const std::string& layers :
       {std::string(R"({ "type": "derivative_map", "map": "coarse" })"),
        std::string(R"({ "type": "normal_map", "map": "coarse", "channels": "xy" })"),
        layer("coarse", R"(, "filter": "bilinear")")})
    EXPECT_EQ(roughness(layers, bases, 6), bases) << layers;
}

TEST_F(Roughness, EndsAtOne) {
  EXPECT_EQ(roughness(layer("coarse", R"(, "scale": 20)"), {0.3F}, 6), std::vector<float>{1.0F});
}

} // namespace
} // namespace surfgrad::shadergen::test
