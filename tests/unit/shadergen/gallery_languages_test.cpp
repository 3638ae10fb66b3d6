// What `surfgrad shader` writes of every stack of the gallery, run in every language on the fragments of its
// own picture, gives the engine's normals.

#include "displace/scene.hpp"
#include "exported/runner.hpp"
#include "exported/truth.hpp"
#include "gallery/figures.hpp"
#include "image/map.hpp"
#include "support/vulkan.hpp"

#include <map>
#include <regex>
#include <string>

namespace surfgrad::shadergen::test {
namespace {

/// A picture of the gallery: its material's stack and what it is seen on.
struct Panel {
  std::string name{};
  scene::Scene scene{};
  Shader shader{};
  Program program{};
  std::string code{}; ///< the program's, without comments: panels that differ in numbers and maps share it
};

TextureOrigin origin_of(Language language) { // that of the command line
  return language == Language::glsl ? TextureOrigin::lower_left : TextureOrigin::upper_left;
}

std::string without_comments(const std::string& text) {
  return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

/// A shader searches a relief in 64 steps, the engine finds where exactly a ray meets it.
bool searches_relief(const scene::Scene& scene) {
  for (const stack::Layer& layer : scene.materials[0].layers)
    if (const auto* parallax = std::get_if<stack::ParallaxLayer>(&layer))
      if (parallax->method == stack::ParallaxMethod::occlusion || parallax->self_shadow) return true;
  return false;
}

/// How far a device may be off the engine's mip level. Devices approximate levels, and choose a cube map's by
/// other measures. Slopes of heights are differences on a level instead of means over it, as smooth as on
/// another one.
double levels_off(const scene::Scene& scene) {
  for (const stack::Layer& layer : scene.materials[0].layers)
    if (const auto* heights = std::get_if<stack::HeightMapLayer>(&layer))
      if (heights->mode == stack::HeightMode::scale_free) return 1;
  return 0.25;
}

class GalleryShaders : public surfgrad::test::VulkanTest {
 protected:
  void compare(Language language);

 private:
  Shader exported(const scene::Scene& scene, Language language);
  std::vector<Panel> panels(Language language);

  std::map<std::filesystem::path, std::shared_ptr<const image::Image>> images_{};
  std::map<std::filesystem::path, stack::Channels> channels_{};
};

/// As the command line has it written, standalone.
Shader GalleryShaders::exported(const scene::Scene& scene, Language language) {
  Options options;
  options.language = language;
  options.standalone = true;
  options.back_faces = scene.materials[0].back_faces;
  options.origin = origin_of(language);
  options.displace = scene.displace ? &*scene.displace : nullptr;
  options.facts_of = [&](const stack::FileName& file) {
    const auto [known, is_new] = channels_.try_emplace(file.path, stack::Channels::xyz);
    if (is_new &&
        image::make_slope_map(scene.image(file.path), image::NormalChannels::automatic, true).channels ==
            image::NormalChannels::xy)
      known->second = stack::Channels::xy;
    return FileFacts{known->second, Codes::unorm16};
  };
  return generate(scene.materials[0].layers, options);
}

std::vector<Panel> GalleryShaders::panels(Language language) {
  std::vector<Panel> all;
  for (const gallery::Figure& figure : gallery::built_in_figures())
    for (const gallery::Panel& panel : figure.panels) {
      Panel p{figure.id + ", " + panel.id, panel.scene()};
      EXPECT_EQ(p.scene.materials.size(), 1u) << p.name;
      images_.insert(p.scene.images.begin(), p.scene.images.end());
      p.shader = exported(p.scene, language);
      p.program = normal_program(p.shader);
      p.code = without_comments(p.program.text);
      all.push_back(std::move(p));
    }
  EXPECT_GT(all.size(), 90u);
  return all;
}

/// By code.
using Pipelines = std::map<std::string, std::shared_ptr<const gpu::ComputePipeline>>;

Pipelines pipelines_of(const std::vector<Panel>& panels, const Runner& runner) {
  Pipelines pipelines;
  std::vector<const Panel*> unique;
  std::vector<const Program*> programs;
  for (const Panel& p : panels)
    if (pipelines.try_emplace(p.code).second) {
      unique.push_back(&p);
      programs.push_back(&p.program);
    }
  const std::vector<gpu::Spirv> spirv = spirv_of(programs);
  for (std::size_t i = 0; i < unique.size(); ++i)
    pipelines[unique[i]->code] = runner.pipeline(unique[i]->shader, spirv[i]);
  return pipelines;
}

void GalleryShaders::compare(Language language) {
  // Some hundred operations in float instead of double, on slopes of about 1: 100 * 2^-23 radians make 0.0007
  // degrees; the weights of linear filters, some 2^-23 of coordinates of up to 512 texels on slopes that
  // change by a tenth from texel to texel, bring as much again; twice the sum. Where coordinates count for
  // more, as for slopes of heights that are a pixel apart, what their rounding does to the engine's own
  // answer is allowed.
  constexpr double bound = 0.003;
  // Relief thinner than a 64th of a ray's way through it may be stepped over: a few pixels along outlines of
  // stones, and more where the way is a grazing sun's.
  constexpr double most_relief_missed = 0.002, most_shadow_missed = 0.01;

  const std::vector<Panel> all = panels(language);
  const FindImage find = [this](const std::filesystem::path& file) -> const image::Image& {
    return *images_.at(file);
  };
  engine::MapLibrary maps(find);
  Runner runner(device());
  const auto pipelines = pipelines_of(all, runner);
  Comparison total;
  double total_minified = 0;
  for (const Panel& p : all) {
    const scene::Material& material = p.scene.materials[0];
    const auto displaced = displace::displaced(p.scene);
    const scene::Scene& scene = displaced ? displaced->scene : p.scene;
    const Samples samples = samples_of(scene, 48, 0);
    EXPECT_GT(samples.all.size(), 500u) << p.name << " shows next to nothing";
    const auto run = [&](const Samples& some) {
      return runner.run(*pipelines.at(p.code), p.shader, p.program, origin_of(language), find,
                        inputs_of(p.shader, some));
    };
    const Truth truth(material.layers, material.back_faces, samples.slots, maps);
    const Comparison c = compared(truth, samples, run(samples), bound);
    const bool searches = searches_relief(p.scene);
    EXPECT_LE(c.wrong, searches ? most_relief_missed * c.count : 0)
        << p.name << ", worst " << c.worst << " degrees";
    EXPECT_LE(c.lit_otherwise, searches ? most_shadow_missed * c.count : 0) << p.name;
    EXPECT_EQ(p.shader.has_sunlight, c.shadowed > 0) << p.name;
    std::printf("  %-32s worst %.5f, mean %.6f degrees", p.name.c_str(), c.worst, c.mean);
    if (c.rounded > 0) std::printf(", %.1f %% by rounding", 100.0 * c.rounded / c.count);
    if (searches)
      std::printf(", missed %d of relief and %d of shadow of %d", c.wrong, c.lit_otherwise, c.count);
    total.add(c);

    const Samples minified = samples_of(scene, 48, 384);
    const MinifiedComparison m = compared_minified(truth, minified, run(minified), levels_off(p.scene));
    EXPECT_LE(m.angle, m.turn + bound) << p.name;
    std::printf("; minified %.4f, bound %.4f\n", m.angle, m.turn + bound);
    total_minified += m.angle / static_cast<double>(all.size());
  }
  std::printf("  %zu panels, %zu programs, %d fragments: worst %.5f, mean %.6f degrees; %d by rounding, %d "
              "missed; minified %.4f\n",
              all.size(), pipelines.size(), total.count, total.worst, total.mean, total.rounded, total.wrong,
              total_minified);
}

TEST_F(GalleryShaders, InGlsl) { compare(Language::glsl); }
TEST_F(GalleryShaders, InHlsl) { compare(Language::hlsl); }
TEST_F(GalleryShaders, InWgsl) { compare(Language::wgsl); }
TEST_F(GalleryShaders, InGodot) { compare(Language::godot); }

} // namespace
} // namespace surfgrad::shadergen::test
