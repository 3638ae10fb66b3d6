/// Maps that hardware filters: which they are, and that normals stay within the bound that is said.

#include "gpu/backend.hpp"
#include "render/render.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"
#include "support/vulkan.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::test {
namespace {

class HardwareFilter : public VulkanTest {
 protected:
  static gpu::Backend hardware(std::function<bool(VkFormat)> filters = {}) {
    return gpu::Backend(device(), gpu::Backend::usual_tile_side, SIZE_MAX,
                        {gpu::Filtering::hardware, std::move(filters)});
  }
  static image::Image normals(const scene::Scene& scene, const gpu::Backend& backend) {
    return render::render(scene, {.width = 96, .height = 96, .aov = render::Aov::normal, .backend = &backend})
        .image;
  }
  /// Renders a scene with both filters; `sampled` of its `maps` are to be filtered by hardware.
  static void compare(const std::string& what, const scene::Scene& scene, std::size_t sampled,
                      std::size_t maps) {
    const gpu::Backend backend = hardware();
    const image::Image got = normals(scene, backend);
    const image::Image expected = normals(scene, gpu::Backend(device()));
    const gpu::FilterReport report = backend.filter_report();
    EXPECT_EQ(report.sampled, sampled) << what;
    EXPECT_EQ(report.maps, maps) << what;
    const double bound = report.largest_angle * 180 / std::numbers::pi;
    double largest = 0, sum = 0;
    int count = 0;
    for (std::size_t i = 0; i + 2 < got.texels.size(); i += 3) {
      const vec3<double> a{got.texels[i], got.texels[i + 1], got.texels[i + 2]};
      if (max_abs(a) == 0) continue;
      const double angle =
          unit_angle(a, {expected.texels[i], expected.texels[i + 1], expected.texels[i + 2]});
      largest = std::max(largest, angle);
      sum += angle;
      ++count;
    }
    ASSERT_GT(count, 500) << what << " shows next to nothing";
    std::printf("  %s: %zu of %zu maps; mean %.2g, largest %.2g, bound %.2g degrees\n", what.c_str(),
                report.sampled, report.maps, sum / count, largest, bound);
    EXPECT_LE(largest, bound) << what;
    EXPECT_LT(bound, 90) << what << " is told nothing";
    if (sampled > 0) {
      EXPECT_GT(largest, 0) << what << " is read as before";
    }
    // The software driver weighs in float: what is read wrongly cannot hide below the bound of coarser
    // weights.
    if (device().info().kind == "processor") {
      EXPECT_LT(largest, 1e-3) << what;
    }
  }
};

stack::NormalMapLayer normal_map(const char* image = "normals") {
  stack::NormalMapLayer layer = normal_layer(image);
  layer.map.tile = {4, 2};
  return layer;
}

scene::Scene scene_with(std::vector<stack::Layer> layers) {
  Random random(3);
  scene::Scene scene = scene_of(torus(64, 32));
  scene.materials[0].layers = std::move(layers);
  add_image(scene, "normals", random_normal_map(random, 32, 16, 0.5, image::Depth::unorm8)); // slope16
  add_image(scene, "fine", random_normal_map(random, 21, 37, 0.5));                          // two floats
  add_image(scene, "mask", random_image(random, 16, 16, 1, image::Depth::unorm8));           // unorm16
  add_image(scene, "relief", random_image(random, 16, 16, 1));
  return scene;
}

TEST_F(HardwareFilter, KeepsTheDemoWithinItsBound) {
  // The dents of its second pass may magnify errors of the first: only the grain on top is filtered so. Near
  // enough to see it.
  scene::Scene scene = scene::demo_scene();
  scene.camera.zoom = 20;
  compare("demo", scene, 1, 4);
}

TEST_F(HardwareFilter, ReadsMapsOfEveryFormat) {
  compare("slope16", scene_with({normal_map()}), 1, 1);
  compare("floats", scene_with({normal_map("fine")}), 1, 1);
  stack::DerivativeMapLayer derivatives;
  derivatives.common.key = "layers";
  derivatives.map.file.path = "normals";
  derivatives.code.range = 0.5;
  derivatives.basis = stack::Basis::derived;
  compare("derivatives", scene_with({derivatives}), 1, 1);
  stack::HeightMapLayer heights;
  heights.common.key = "layers";
  heights.map.file.path = "relief";
  heights.map.wrap = stack::Wrap::mirror;
  heights.map.tile = {3, 3};
  heights.mode = stack::HeightMode::scale_free;
  heights.height = 0.02;
  compare("slopes of heights", scene_with({heights}), 1, 1);
}

TEST_F(HardwareFilter, FiltersAndWrapsAsTheEngine) {
  for (const stack::Filter filter :
       {stack::Filter::nearest, stack::Filter::bilinear, stack::Filter::trilinear})
    for (const auto& [wrap, wrap_t] : {std::pair(stack::Wrap::repeat, stack::Wrap::clamp),
                                       std::pair(stack::Wrap::mirror, stack::Wrap::repeat),
                                       std::pair(stack::Wrap::clamp, stack::Wrap::mirror)}) {
      stack::NormalMapLayer layer = normal_map();
      layer.map.filter = filter;
      layer.map.wrap = wrap;
      layer.map.wrap_t = wrap_t;
      layer.map.offset = {0.3, -1.7};
      layer.map.rotate_deg = 20;
      compare("filter " + std::to_string(static_cast<int>(filter)) + ", wrap " +
                  std::to_string(static_cast<int>(wrap)),
              scene_with({layer}), 1, 1);
    }
  stack::NormalMapLayer minified = normal_map();
  minified.map.tile = {60, 40};
  compare("minified", scene_with({minified}), 1, 1);
}

TEST_F(HardwareFilter, ReadsMasksAndProjections) {
  stack::NormalMapLayer masked = normal_map("fine");
  masked.common.blend = stack::Blend::mix;
  masked.common.mask.emplace();
  masked.common.mask->file.path = "mask";
  compare("mask", scene_with({normal_map(), masked}), 3, 3);
  masked.common.mask->tiling = stack::Tiling::hex;
  compare("hex mask", scene_with({normal_map(), masked}), 3, 3);
  stack::TriplanarLayer triplanar;
  triplanar.common.key = "layers";
  triplanar.files = {{"normals"}, {"fine"}, {"normals"}};
  compare("triplanar", scene_with({triplanar}), 2, 2);
}

TEST_F(HardwareFilter, LeavesTheRestToTheBuffers) {
  stack::NormalMapLayer layer = normal_map();
  layer.map.filter = stack::Filter::anisotropic;
  stack::NormalMapLayer encoded = normal_map();
  encoded.map.filter = stack::Filter::normal;
  stack::ParallaxLayer parallax;
  parallax.common.key = "layers";
  parallax.map.file.path = "relief";
  compare("anisotropic", scene_with({layer}), 0, 1);
  compare("encoded", scene_with({encoded}), 0, 1);
  compare("parallax", scene_with({parallax}), 0, 1);
  compare("parallax and normals", scene_with({parallax, normal_map()}), 1, 2);
  // One map of two passes, once out of the buffer.
  stack::NoiseLayer noise;
  noise.common.key = "layers";
  noise.noise.frequency = 40;
  compare("two passes", scene_with({normal_map(), stack::ResolveLayer{}, normal_map(), noise}), 1, 2);
}

TEST_F(HardwareFilter, FallsBackWhereADeviceDoesNotFilterTheFormat) {
  const scene::Scene scene = scene_with({normal_map()});
  const image::Image exact = normals(scene, gpu::Backend(device()));
  // Codes cannot be filtered: floats are.
  const gpu::Backend floats = hardware([](VkFormat format) { return format == VK_FORMAT_R32G32_SFLOAT; });
  EXPECT_NE(normals(scene, floats).texels, exact.texels);
  EXPECT_EQ(floats.filter_report().sampled, 1u);
  // Nothing can be.
  const gpu::Backend none = hardware([](VkFormat) { return false; });
  EXPECT_EQ(normals(scene, none).texels, exact.texels);
  EXPECT_EQ(none.filter_report().sampled, 0u);
  EXPECT_EQ(none.filter_report().largest_angle, 0);
}

} // namespace
} // namespace surfgrad::test
