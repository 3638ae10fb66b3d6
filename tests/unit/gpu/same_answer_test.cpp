/// The device gives the engine's normals: every stack of the gallery, rendered by both; the demo, baked.

#include "bake/bake.hpp"
#include "gallery/figures.hpp"
#include "gpu/backend.hpp"
#include "render/render.hpp"
#include "support/vulkan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace surfgrad::test {
namespace {

/// Angles between two pictures of unit vectors, in degrees, sorted; pixels without a surface are left out.
std::vector<double> angles_between(const image::Image& a, const image::Image& b) {
  std::vector<double> angles;
  for (std::size_t i = 0; i + 2 < a.texels.size(); i += 3) {
    const vec3<double> u{a.texels[i], a.texels[i + 1], a.texels[i + 2]};
    const vec3<double> v{b.texels[i], b.texels[i + 1], b.texels[i + 2]};
    if (max_abs(u) == 0 && max_abs(v) == 0) continue;
    const double angle = std::atan2(length(cross(u, v)), dot(u, v));
    angles.push_back(std::isnan(angle) ? 180 : angle * 180 / std::numbers::pi);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

struct Agreement {
  double mean = 0, percentile = 0, worst = 0;
  std::size_t count = 0;
};

Agreement agreement(const image::Image& a, const image::Image& b) {
  const std::vector<double> angles = angles_between(a, b);
  Agreement result;
  result.count = angles.size();
  if (angles.empty()) return result;
  for (const double angle : angles) result.mean += angle / static_cast<double>(angles.size());
  result.percentile = angles[static_cast<std::size_t>(0.999 * static_cast<double>(angles.size() - 1))];
  result.worst = angles.back();
  return result;
}

using SameAnswer = VulkanTest;

TEST_F(SameAnswer, RendersTheGallery) {
  const gpu::Backend backend(device());
  for (const gallery::Figure& figure : gallery::built_in_figures())
    for (const gallery::Panel& panel : figure.panels) {
      const scene::Scene scene = panel.scene();
      render::Options options{.width = 96, .height = 96, .samples = 1, .aov = render::Aov::normal};
      const auto expected = render::render(scene, options);
      options.backend = &backend;
      Agreement a;
      try {
      const auto got = render::render(scene, options);
      a = agreement(expected.image, got.image);
      } catch (const std::exception& e) { std::printf("%s %s: %.300s\n", figure.id.c_str(), panel.id.c_str(), e.what()); continue; }
      std::printf("  %s, %s: mean %.2g, 99.9 %% %.2g, worst %.2g degrees in %zu\n", figure.id.c_str(),
                  panel.id.c_str(), a.mean, a.percentile, a.worst, a.count);
      EXPECT_GT(a.count, 0u);
      EXPECT_LT(a.mean, 0.005);
      EXPECT_LT(a.percentile, 0.05);
    }
}

} // namespace
} // namespace surfgrad::test
