/// The device gives the engine's answer: the gallery's stacks rendered by both, the demo baked by both, and
/// next to the same picture however it is cut into tiles: the same bytes where tiles are composed in parts.

#include "bake/bake.hpp"
#include "gallery/figures.hpp"
#include "golden/golden_scenes.hpp"
#include "gpu/backend.hpp"
#include "render/render.hpp"
#include "scene/demo_maps.hpp"
#include "stack/uses.hpp"
#include "stacks.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/vulkan.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

namespace surfgrad::test {
namespace {

// What the project promises of every stack, in degrees: mean, and all but one pixel in a thousand.
constexpr double most_mean = 0.005;
constexpr double most_usual = 0.05;

struct Agreement {
  double mean = 0, usual = 0, worst = 0; ///< angles in degrees
  std::size_t count = 0;
};

/// Of two pictures of vectors; pixels without a surface are left out.
Agreement agreement(const image::Image& a, const image::Image& b) {
  std::vector<double> angles;
  for (std::size_t i = 0; i + 2 < a.texels.size(); i += 3) {
    const vec3<double> u{a.texels[i], a.texels[i + 1], a.texels[i + 2]};
    const vec3<double> v{b.texels[i], b.texels[i + 1], b.texels[i + 2]};
    if (max_abs(u) == 0 && max_abs(v) == 0) continue;
    angles.push_back(unit_angle(u, v));
  }
  Agreement result;
  result.count = angles.size();
  if (angles.empty()) return result;
  std::sort(angles.begin(), angles.end());
  for (const double angle : angles) result.mean += angle / static_cast<double>(angles.size());
  result.usual = angles[static_cast<std::size_t>(0.999 * static_cast<double>(angles.size() - 1))];
  result.worst = angles.back();
  return result;
}

TEST(Agreements, AreOfNormalsAlone) {
  const auto angle = [](std::vector<float> a, std::vector<float> b) {
    image::Image u, v;
    u.texels = std::move(a);
    v.texels = std::move(b);
    return agreement(u, v).worst;
  };
  const std::vector<float> up{0, 0, 1};
  EXPECT_EQ(angle(up, up), 0);
  EXPECT_NEAR(angle(up, {0, 1, 0}), 90, 1e-9);
  EXPECT_EQ(angle(up, {0, 0, 0}), 180);
  EXPECT_EQ(angle({0, 0, 0}, up), 180);
  EXPECT_EQ(angle(up, {0, 0, NAN}), 180);
  EXPECT_EQ(angle(up, {0, 0, 1.001f}), 180);
  EXPECT_EQ(angle(up, {0, 0, 0.4f}), 180);
}

double largest_difference(const image::Image& a, const image::Image& b) {
  double largest = a.texels.size() == b.texels.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < a.texels.size() && largest < HUGE_VAL; ++i)
    largest = std::max(largest, std::abs(double{a.texels[i]} - double{b.texels[i]}));
  return largest;
}

class SameAnswer : public VulkanTest {
 protected:
  static void TearDownTestSuite() {
    shared_backend.reset();
    VulkanTest::TearDownTestSuite();
  }
  static const gpu::Backend& backend() {
    if (!shared_backend) shared_backend = std::make_unique<gpu::Backend>(device());
    return *shared_backend;
  }
  static std::vector<gallery::Panel> panels_of(const char* figure) {
    for (gallery::Figure& each : gallery::built_in_figures())
      if (each.id == figure) return each.panels;
    ADD_FAILURE() << "the gallery has no figure " << figure;
    return {};
  }

 private:
  inline static std::unique_ptr<gpu::Backend> shared_backend;
};

/// Heights and what rays meet: half of the time.
bool has_heights(const std::string& figure) {
  return figure.find("heights") != std::string::npos || figure.find("parallax") != std::string::npos;
}

/// The largest angles of a test's scenes.
class Largest {
 public:
  ~Largest() {
    std::printf("  %d scenes; largest mean %.2g, 99.9 %% %.2g, worst %.2g degrees\n", scenes_, angles_.mean,
                angles_.usual, angles_.worst);
    EXPECT_GT(scenes_, 0);
  }
  /// Renders a scene on both.
  void compare(const gpu::Backend& backend, const scene::Scene& scene, const std::string& where) {
    render::Options options{.width = 64, .height = 64, .aov = render::Aov::normal};
    const render::Picture expected = render::render(scene, options);
    options.backend = &backend;
    const render::Picture got = render::render(scene, options);
    const Agreement a = agreement(expected.image, got.image);
    EXPECT_GT(a.count, 500u) << where << " shows next to nothing";
    EXPECT_LT(a.mean, most_mean) << where;
    EXPECT_LT(a.usual, most_usual) << where;
    // Silhouettes and steps of a stack (mip levels, hex tiles, borders of decals) might fall differently in a
    // pixel or two; on the driver of the tests none does.
    EXPECT_LT(a.worst, most_usual) << where;
    EXPECT_EQ(got.covered, expected.covered) << where;
    EXPECT_EQ(got.degenerate, expected.degenerate) << where;
    angles_.mean = std::max(angles_.mean, a.mean);
    angles_.usual = std::max(angles_.usual, a.usual);
    angles_.worst = std::max(angles_.worst, a.worst);
    ++scenes_;
  }

 private:
  Agreement angles_{};
  int scenes_ = 0;
};

/// Renders the figures with heights, or the others, on both.
void compare_figures(const gpu::Backend& backend, bool with_heights) {
  Largest largest;
  for (const gallery::Figure& figure : gallery::built_in_figures())
    for (const gallery::Panel& panel : figure.panels) {
      if (has_heights(figure.id) != with_heights) continue;
      largest.compare(backend, panel.scene(), figure.id + ", " + panel.id);
    }
}

TEST_F(SameAnswer, RendersTheGallerysHeights) { compare_figures(backend(), true); }
TEST_F(SameAnswer, RendersTheRestOfTheGallery) { compare_figures(backend(), false); }

/// Plates with stripes as opacity: something to read for every kind of layer.
image::Image normals_with_opacity(int size) {
  const image::Image normals = scene::plates_normal_map(size);
  const image::Image stripes = scene::stripes_mask(size);
  image::Image all = image::make_image(size, size, 4, image::Depth::unorm16);
  all.has_alpha = true;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      for (int c = 0; c < 3; ++c) all.at(x, y, c) = normals.at(x, y, c);
      all.at(x, y, 3) = stripes.at(x, y, 0);
    }
  return all;
}

/// Six faces in a row.
image::Image six_faces(int size) {
  const image::Image face = scene::weave_normal_map(size);
  image::Image cube = image::make_image(6 * size, size, 3, image::Depth::unorm16);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < 6 * size; ++x)
      for (int c = 0; c < 3; ++c) cube.at(x, y, c) = face.at(x % size, y, c);
  return cube;
}

/// The demo's torus under another stack.
scene::Scene torus_under(const shadergen::test::NamedStack& stack) {
  scene::Scene scene = scene::demo_scene();
  const auto map = std::make_shared<const image::Image>(normals_with_opacity(64));
  const auto cube = std::make_shared<const image::Image>(six_faces(32));
  scene.materials[0].layers = stack.layers;
  scene.materials[0].back_faces = stack.back_faces;
  scene.displace = stack.displace;
  for (stack::Layer& layer : scene.materials[0].layers)
    for (const stack::FileName* file : stack::files_of(layer))
      scene.images[file->path] = file->path.extension() == ".exr" ? cube : map;
  if (scene.displace && scene.displace->map) scene.images[scene.displace->map->file.path] = map;
  return scene;
}

TEST_F(SameAnswer, RendersEveryKindOfLayer) {
  Largest largest;
  for (const shadergen::test::NamedStack& stack : shadergen::test::every_kind())
    largest.compare(backend(), torus_under(stack), stack.name);
}

TEST_F(SameAnswer, RendersRealModels) {
  if (!std::filesystem::exists(shared_assets())) GTEST_SKIP() << "no real assets at " << shared_assets();
  Largest largest;
  for (const GoldenScene& golden : golden_scenes()) largest.compare(backend(), load(golden), golden.name);
}

TEST_F(SameAnswer, BakesTheDemoInEverySpace) {
  const scene::Scene scene = scene::demo_scene();
  for (const bake::Space space : {bake::Space::tangent, bake::Space::object}) {
    bake::Options options{.width = 128, .height = 128, .space = space};
    const bake::Baked expected = bake::bake(scene, options);
    options.backend = &backend();
    const bake::Baked got = bake::bake(scene, options);
    // Components of n / 2 + 1/2: an angle of 0.05 degrees moves them by 4.4e-4.
    const double difference = largest_difference(expected.map, got.map);
    std::printf("  largest difference of a component %.2g\n", difference);
    EXPECT_LT(difference, 4.4e-4);
    EXPECT_EQ(got.covered, expected.covered);
    EXPECT_EQ(got.clamped, expected.clamped);
    EXPECT_EQ(got.degenerate, expected.degenerate);
  }
}

TEST_F(SameAnswer, ShadesWithSunlightThatTheReliefLetsThrough) {
  const scene::Scene scene = panels_of("parallax").back().scene();
  const scene::Scene shadowed = panels_of("parallax")[4].scene();
  for (const scene::Scene* each : {&scene, &shadowed}) {
    render::Options options{.width = 64, .height = 64, .samples = 1};
    const render::Picture expected = render::render(*each, options);
    options.backend = &backend();
    const render::Picture got = render::render(*each, options);
    // Where a shadow's border passes, one decision may fall differently: the mean over the surface tells.
    ASSERT_GT(expected.covered, 0);
    double sum = 0;
    for (std::size_t i = 0; i < got.image.texels.size(); ++i)
      sum += std::abs(double{got.image.texels[i]} - double{expected.image.texels[i]});
    const double mean = sum / (3 * static_cast<double>(expected.covered));
    std::printf("  mean difference %.2g\n", mean);
    EXPECT_LT(mean, 1e-4);
  }
}

TEST_F(SameAnswer, GivesEveryPictureThatARenderOffers) {
  // From behind, in mode flip: the surface gradient is turned, the base normal is not.
  const scene::Scene scene = panels_of("back-faces")[2].scene();
  for (const render::Aov aov : {render::Aov::base_normal, render::Aov::surfgrad, render::Aov::uv}) {
    render::Options options{.width = 64, .height = 64, .aov = aov};
    const render::Picture expected = render::render(scene, options);
    options.backend = &backend();
    const render::Picture got = render::render(scene, options);
    double largest = 0;
    for (const float v : test::values_of(expected.image)) largest = std::max(largest, std::abs(double{v}));
    EXPECT_GT(largest, 0.1) << "the picture is empty";
    // Surface gradients grow towards silhouettes: relative to the largest.
    EXPECT_LT(largest_difference(expected.image, got.image), 1e-4 * std::max(1.0, largest))
        << static_cast<int>(aov);
  }
}

TEST_F(SameAnswer, DoesNotDependOnTheTiles) {
  const scene::Scene scene = scene::demo_scene();
  bake::Options options{.width = 100, .height = 60};
  options.backend = &backend();
  const bake::Baked whole = bake::bake(scene, options);
  for (const int side : {5, 64}) {
    const gpu::Backend small(device(), side);
    options.backend = &small;
    // Where a triangle's interpolation begins depends on the tile, and rounds differently.
    EXPECT_LT(largest_difference(bake::bake(scene, options).map, whole.map), 1e-4) << side;
  }
  // A tile in parts is interpolated as a whole one.
  const gpu::Backend narrow(device(), gpu::Backend::usual_tile_side, 333);
  options.backend = &narrow;
  EXPECT_EQ(largest_difference(bake::bake(scene, options).map, whole.map), 0);
}

} // namespace
} // namespace surfgrad::test
