/// The angle that a plan derives from the errors of maps, against the normals of scenes whose maps really are
/// off by so much.

#include "engine/program.hpp"
#include "gpu/filter_plan.hpp"
#include "render/render.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

using shadergen::MapSite;

constexpr double error = 0.01; // of every texel of a map

/// A map of two slopes, or of weights.
image::Image smooth_map(int seed, double low, double high) {
  Random random(static_cast<std::uint64_t>(seed));
  image::Image image = image::make_image(24, 16, 3, image::Depth::float32);
  for (float& t : image.texels.floats()) t = static_cast<float>(random.uniform(low, high));
  return image;
}

/// The same with every texel off by `error` in one direction, which no filter takes back.
image::Image shifted(image::Image image, double angle, bool weights) {
  for (std::size_t i = 0; i < image.texels.size(); i += 3) {
    image.texels[i] += static_cast<float>(weights ? -error : error * std::cos(angle));
    if (!weights) image.texels[i + 1] += static_cast<float>(error * std::sin(angle));
  }
  return image;
}

stack::DerivativeMapLayer layer(stack::Basis basis, double scale = 1) {
  stack::DerivativeMapLayer result;
  result.common.key = "layers";
  result.common.scale = scale;
  result.map.file.path = "slopes";
  result.map.tile = {4, 3};
  result.basis = basis;
  return result;
}

struct Plan {
  scene::Scene scene;
  raster::Surface surface;
  std::vector<raster::UvSlot> slots;
  engine::MapLibrary library;
  gpu::FilterPlan plan;

  explicit Plan(scene::Scene given, bool even = true)
      : scene(std::move(given)), slots(slots_of(scene)),
        library(
            [this](const std::filesystem::path& file) -> const image::Image& { return scene.image(file); }),
        plan(made(even)) {}

 private:
  static std::vector<raster::UvSlot> slots_of(const scene::Scene& scene) {
    std::vector<raster::UvSlot> slots;
    engine::collect_uv_slots(scene.materials[0].layers, slots);
    return slots;
  }
  gpu::FilterPlan made(bool even) {
    surface = raster::place_mesh(scene.meshes[0], scene.objects[0].world_from_object, {0, 0, 0}, slots);
    return {engine::compile(scene.materials[0].layers, slots, library), gpu::mesh_reach({surface}, 0), even};
  }
};

scene::Scene scene_with(std::vector<stack::Layer> layers, mesh::TriangleMesh mesh = torus(48, 24),
                        vec3<double> scale = {1, 1, 1}) {
  scene::Scene scene = scene_of(std::move(mesh), scaling(scale));
  scene.materials[0].layers = std::move(layers);
  add_image(scene, "slopes", smooth_map(1, -0.6, 0.6));
  add_image(scene, "weights", smooth_map(2, 0.1, 0.9));
  return scene;
}

image::Image normals_of(const scene::Scene& scene) {
  return render::render(scene, {.width = 160, .height = 160, .aov = render::Aov::normal}).image;
}

double largest_angle(const image::Image& a, const image::Image& b) {
  double largest = 0;
  for (std::size_t i = 0; i + 2 < a.texels.size(); i += 3)
    largest = std::max(largest, unit_angle({a.texels[i], a.texels[i + 1], a.texels[i + 2]},
                                           {b.texels[i], b.texels[i + 1], b.texels[i + 2]}));
  return largest;
}

/// Counts an error of the maps at these sites and makes it; measured / bound.
double share_of_bound(const std::string& what, const scene::Scene& scene, const std::vector<MapSite>& sites) {
  Plan p(scene);
  bool slopes = false, weights = false;
  for (const MapSite& site : sites) {
    EXPECT_TRUE(p.plan.follows(site)) << what;
    p.plan.count(site, error);
    (site.mask ? weights : slopes) = true;
  }
  const double bound = p.plan.largest_angle() * 180 / std::numbers::pi;
  const image::Image expected = normals_of(scene);
  double largest = 0;
  for (const double angle : {0.3, 2.0, 3.9, 5.5}) {
    scene::Scene off = scene;
    if (slopes) add_image(off, "slopes", shifted(scene.image("slopes"), angle, false));
    if (weights) add_image(off, "weights", shifted(scene.image("weights"), 0, true));
    largest = std::max(largest, largest_angle(expected, normals_of(off)));
  }
  std::printf("  %s: largest angle %.3g of %.3g degrees, %.2g\n", what.c_str(), largest, bound,
              largest / bound);
  // The pictures' floats are off by some 1e-5 degrees.
  EXPECT_LE(largest, bound + 1e-4) << what;
  return largest / bound;
}

void mask(stack::DerivativeMapLayer& layer) {
  layer.common.mask.emplace();
  layer.common.mask->file.path = "weights";
}

TEST(FilterPlans, BoundTheAnglesOfOnePass) {
  // A slope near zero turns the normal by its whole error: the bound is nearly met.
  EXPECT_GT(share_of_bound("vertex tangents", scene_with({layer(stack::Basis::mikktspace)}), {{0}}), 0.5);
  EXPECT_GT(share_of_bound("derived", scene_with({layer(stack::Basis::derived, -1.5)}), {{0}}), 0.5);
  stack::DerivativeMapLayer faint = layer(stack::Basis::derived);
  faint.common.opacity = 0.5;
  EXPECT_GT(share_of_bound("opacity", scene_with({faint}), {{0}}), 0.5);
  // Coarse: tangents and normals part between vertices.
  EXPECT_GT(share_of_bound("coarse mesh", scene_with({layer(stack::Basis::mikktspace)}, torus(9, 6)), {{0}}),
            0.2);
}

TEST(FilterPlans, BoundTheAnglesOfMasksAndMixtures) {
  stack::DerivativeMapLayer masked = layer(stack::Basis::derived);
  mask(masked);
  EXPECT_GT(share_of_bound("mask", scene_with({masked}), {{0, true}}), 0.3);
  masked.common.blend = stack::Blend::mix;
  masked.map.tile = {1, 5};
  // At worst both layers are as steep as they can be, in opposite directions.
  EXPECT_GT(share_of_bound("mix", scene_with({layer(stack::Basis::derived), masked}), {{1, true}}), 0.1);
  EXPECT_GT(share_of_bound("all", scene_with({layer(stack::Basis::derived), masked}), {{0}, {1}, {1, true}}),
            0.1);
}

TEST(FilterPlans, BoundTheAnglesOfProjections) {
  stack::TriplanarLayer triplanar;
  triplanar.common.key = "layers";
  triplanar.files = {{"slopes"}};
  triplanar.map.content = stack::TriplanarContent::derivative;
  for (const stack::Space space : {stack::Space::object, stack::Space::world}) {
    triplanar.space = space;
    EXPECT_GT(share_of_bound("triplanar", scene_with({triplanar}, torus(48, 24), {3, 3, 3}), {{0}}), 0.3);
  }
  stack::PlanarLayer planar;
  planar.common.key = "layers";
  planar.file = {"slopes"};
  planar.map.content = stack::Content::derivative;
  EXPECT_GT(share_of_bound("planar", scene_with({planar}), {{0}}), 0.3);
}

TEST(FilterPlans, BoundTheAnglesThroughLaterPasses) {
  for (const stack::Basis basis : {stack::Basis::derived, stack::Basis::mikktspace}) {
    const std::vector<stack::Layer> layers{layer(stack::Basis::derived), stack::ResolveLayer{},
                                           layer(basis, 0.4)};
    // The worst frame is met nowhere: it needs the steepest slope of one pass along that of the other.
    EXPECT_GT(share_of_bound("two passes", scene_with(layers), {{0}}), 0.2);
    EXPECT_GT(share_of_bound("two passes, both", scene_with(layers), {{0}, {2}}), 0.2);
  }
  stack::NoiseLayer noise;
  noise.common.key = "layers";
  noise.common.scale = 0.1;
  noise.noise.frequency = 3;
  EXPECT_GT(share_of_bound("noise", scene_with({layer(stack::Basis::derived), stack::ResolveLayer{}, noise}),
                           {{0}}),
            0.2);
}

TEST(FilterPlans, CountNoisesByTheirSteepestGradient) {
  Random random(9);
  for (const stack::NoiseKind kind :
       {stack::NoiseKind::perlin, stack::NoiseKind::simplex, stack::NoiseKind::worley,
        stack::NoiseKind::fractal_sum, stack::NoiseKind::turbulence, stack::NoiseKind::ridged})
    for (const double power : {1.0, 2.5}) {
      stack::NoiseLayer noise;
      noise.common.key = "layers";
      noise.common.scale = -0.25;
      noise.noise = {.function = kind, .octaves = 3, .gain = 0.4, .power = power, .frequency = 3};
      if (power != 1) noise.noise.basis = stack::NoiseBasis::simplex;
      Plan p(scene_with({layer(stack::Basis::derived), stack::ResolveLayer{}, noise}));
      p.plan.count({0}, 1e-6);
      // An error of the first pass grows by the second's steepest gradient.
      const double most = p.plan.largest_angle() / 1e-6 - 1;
      double largest = 0;
      for (int i = 0; i < 50000; ++i)
        largest = std::max(largest,
                           0.25 * length(engine::evaluate(noise.noise, random.vector3(-5, 5), 0.0).gradient));
      std::printf("  noise %d, power %g: gradient %.3g of %.3g\n", static_cast<int>(kind), power, largest,
                  most);
      EXPECT_LE(largest, most * (1 + 1e-6)); // a quotient of small numbers
      EXPECT_GT(largest, 0.2 * most);        // octaves and powers are seldom at their worst together
    }
  stack::NoiseLayer root;
  root.common.key = "layers";
  root.noise.power = 0.5; // vertical at its zeros
  EXPECT_FALSE(
      Plan(scene_with({layer(stack::Basis::derived), stack::ResolveLayer{}, root})).plan.follows({0}));
}

TEST(FilterPlans, LeaveOutWhatTheyCannotFollow) {
  const auto follows = [](std::vector<stack::Layer> layers, const MapSite& site, bool even = true) {
    return Plan(scene_with(std::move(layers)), even).plan.follows(site);
  };
  stack::DerivativeMapLayer plain = layer(stack::Basis::derived);
  EXPECT_TRUE(follows({plain}, {0}));
  // A later pass that is known to magnify, or of which nothing is known.
  stack::NoiseLayer noise;
  noise.common.key = "layers";
  noise.noise.frequency = 40;
  EXPECT_FALSE(follows({plain, stack::ResolveLayer{}, noise}, {0}));
  stack::ObjectNormalMapLayer whole;
  whole.common.key = "layers";
  whole.map.file.path = "slopes";
  EXPECT_FALSE(follows({plain, stack::ResolveLayer{}, whole}, {0}));
  EXPECT_FALSE(follows({whole}, {0}));
  stack::ParallaxLayer parallax;
  parallax.common.key = "layers";
  parallax.map.file.path = "weights";
  EXPECT_FALSE(follows({plain, parallax, plain}, {0}));
  EXPECT_TRUE(follows({plain, parallax, plain}, {2}));
  EXPECT_FALSE(follows({parallax}, {0, true}));
  // After a parallax that keeps the smooth normal vertex tangents lean in no known way.
  parallax.normal = stack::ParallaxNormal::none;
  EXPECT_FALSE(follows({parallax, layer(stack::Basis::mikktspace)}, {1}));
  EXPECT_TRUE(follows({parallax, plain}, {1}));
  // A mask over what may be of any size.
  stack::DerivativeMapLayer mixed = plain;
  mask(mixed);
  mixed.common.blend = stack::Blend::mix;
  EXPECT_TRUE(follows({plain, mixed}, {1, true}));
  EXPECT_FALSE(follows({whole, mixed}, {1, true}));
  // Hex tiles weigh each other by their slopes.
  stack::DerivativeMapLayer hex = plain;
  hex.map.tiling = stack::Tiling::hex;
  EXPECT_FALSE(follows({hex}, {0}));
  // Space that is stretched: a gradient leans off the tangent plane.
  stack::PlanarLayer planar;
  planar.common.key = "layers";
  planar.file = {"slopes"};
  planar.map.content = stack::Content::derivative;
  EXPECT_TRUE(follows({planar}, {0}));
  EXPECT_FALSE(follows({planar}, {0}, false));
  planar.space = stack::Space::world;
  EXPECT_TRUE(follows({planar}, {0}, false));
}

TEST(FilterPlans, AddUp) {
  const std::vector<stack::Layer> layers{layer(stack::Basis::derived), layer(stack::Basis::derived, 2)};
  Plan p(scene_with(layers));
  EXPECT_EQ(p.plan.largest_angle(), 0);
  p.plan.count({0}, 0.01);
  EXPECT_NEAR(p.plan.largest_angle(), 0.01, 1e-12);
  p.plan.count({1}, 0.02);
  p.plan.count({1}, 0.01); // of several at one site the largest
  EXPECT_NEAR(p.plan.largest_angle(), 0.05, 1e-12);
  p.plan.count({1}, 100);
  EXPECT_NEAR(p.plan.largest_angle(), std::numbers::pi, 1e-12);
}

} // namespace
} // namespace surfgrad::test
