// Every language gives the engine's normals: the same random fragments through engine::compose in double and
// through what was generated, run on a device. The stacks hold what the gallery's do not.

#include "exported/runner.hpp"
#include "exported/truth.hpp"
#include "stacks.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/vulkan.hpp"

namespace surfgrad::shadergen::test {
namespace {

using surfgrad::test::Random;

class Languages : public surfgrad::test::VulkanTest {
 protected:
  void SetUp() override {
    VulkanTest::SetUp();
    Random random(90210);
    images_["normals"] = surfgrad::test::random_normal_map(random, 8, 8, 0.5);
    images_["slopes"] = surfgrad::test::random_image(random, 8, 8, 3);
    images_["heights"] = surfgrad::test::random_image(random, 8, 8, 3);
    images_["mask"] = surfgrad::test::random_image(random, 4, 4, 3);
  }

  /// Largest angle in degrees between the engine's normals and those of the language.
  double worst_angle(const NamedStack& stack, Language language, TextureOrigin origin) {
    Random random(1511);
    const Samples samples = random_samples(random, 512);
    Options options = options_of(stack, language);
    options.standalone = true;
    options.origin = origin;
    const Shader shader = generate(stack.layers, options);
    const Program program = normal_program(shader);
    const FindImage find = [this](const std::filesystem::path& file) -> const image::Image& {
      return images_.at(file);
    };
    Runner runner(device());
    const auto pipeline = runner.pipeline(shader, spirv_of({&program})[0]);
    const std::vector<float> normals =
        runner.run(*pipeline, shader, program, origin, find, inputs_of(shader, samples));
    engine::MapLibrary maps(find);
    const Truth truth(stack.layers, stack.back_faces, samples.slots, maps);
    double worst = 0;
    for (std::size_t i = 0; i < samples.all.size(); ++i)
      worst =
          std::max(worst, surfgrad::test::unit_angle({normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]},
                                                     truth.composed(samples.all[i]).normal));
    return worst;
  }

 private:
  std::map<std::filesystem::path, image::Image> images_;
};

/// What all of a language's spellings have a part in, textures aside.
NamedStack volumes() {
  return parsed("volumes", R"({ "surfgrad": 1, "back_faces": "flip", "layers": [
    { "type": "noise", "function": "worley", "frequency": 2.1, "scale": 0.1, "space": "world" },
    { "type": "noise", "function": "ridged", "frequency": 1.53, "scale": 0.05, "offset": [1.1, 2.2, 3.3] },
    { "type": "noise", "method": "perlin1985", "blend": "mix", "opacity": 0.4, "scale": 0.3 },
    { "type": "resolve" },
    { "type": "noise", "function": "fractal_sum", "basis": "simplex", "octaves": 6, "frequency": 1.1, "scale": 0.06 },
    { "type": "noise", "function": "turbulence", "octaves": 3, "power": 1.5, "blend": "mix", "opacity": 0.7 } ] })");
}

NamedStack maps() {
  return parsed("maps", R"({ "surfgrad": 1, "back_faces": "mirror", "layers": [
    { "type": "normal_map", "map": "normals", "tile": [3, -2], "rotate": 30 },
    { "type": "normal_map", "map": "normals", "scale": 0.5 },
    { "type": "derivative_map", "map": "slopes", "uv": 1, "basis": "derived", "blend": "mix", "range": 0.7, "green": "down",
      "mask": { "map": "mask", "channel": "g", "offset": [0.3, 0.1] } },
    { "type": "resolve" },
    { "type": "derivative_map", "map": "slopes", "range": 0.5, "tiling": "hex" },
    { "type": "height_map", "map": "heights", "height": 0.02, "channel": "b", "uv": 1 },
    { "type": "height_map", "map": "heights", "height": 0.02, "taps": "bicubic", "units": "object" } ] })");
}

NamedStack projections() {
  return parsed("projections", R"({ "surfgrad": 1, "back_faces": "same", "layers": [
    { "type": "planar", "map": "slopes", "content": "derivative", "range": 0.4, "axis": "y", "tile": 0.2 },
    { "type": "triplanar", "map": ["slopes", "heights", "mask"], "content": "derivative", "range": 0.3, "tile": 0.1,
      "space": "world", "blend": "mix", "opacity": 0.6, "convention": { "planes": "golubev" } } ] })");
}

NamedStack decals() {
  return parsed("decals", R"({ "surfgrad": 1, "back_faces": "flip", "layers": [
    { "type": "noise", "frequency": 2, "scale": 0.1, "space": "world" },
    { "type": "decal", "map": "slopes", "content": "derivative", "range": 0.5, "size": 2, "direction": [0.3, 0.2, -1],
      "wrap": "repeat", "space": "object", "mask": { "map": "mask" },
      "instances": [ {}, { "position": [0.4, 0.2, 0.1], "roll": 40, "blend": "mix", "opacity": 0.7 },
                     { "position": [-0.3, 0.1, 0.2], "blend": "replace", "opacity": 0.6 } ] },
    { "type": "decal", "shape": "cone", "map": "mask", "content": "derivative", "range": 0.2, "wrap": "repeat",
      "position": [0, 0, 2], "direction": [0, 0, -1], "depth": 4, "angle": 70 } ] })");
}

TEST_F(Languages, AllGiveTheEnginesNormals) {
  // Some hundred operations in float instead of double, on slopes of about 1: 100 * 2^-23 radians make 0.0007
  // degrees; coordinates of noise and of maps, of magnitude up to 10, bring as much again.
  constexpr double bound = 0.003;
  for (const NamedStack& stack : {volumes(), maps(), projections(), decals()})
    for (const Language language : every_language) {
      // A language of each origin; GLSL has both.
      const TextureOrigin usual =
          language == Language::hlsl ? TextureOrigin::upper_left : TextureOrigin::lower_left;
      const double worst = worst_angle(stack, language, usual);
      std::printf("%s in language %d: worst %.5f degrees, bound %g\n", stack.name.c_str(),
                  static_cast<int>(language), worst, bound);
      EXPECT_LE(worst, bound) << stack.name;
    }
  EXPECT_LE(worst_angle(maps(), Language::glsl, TextureOrigin::upper_left), bound);
}

} // namespace
} // namespace surfgrad::shadergen::test
