// What a layer reads back of a baked map, in every encoding.

#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "io/image_file.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace surfgrad::bake {
namespace {

using surfgrad::test::Random;

constexpr int side = 96;

/// A half mirrored torus in two passes, its slopes up to about 1.
scene::Scene bumped(double steepest = 0.5) {
  Random random(1721);
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::half_mirrored_torus(24, 12));
  surfgrad::test::add_image(scene, "a", surfgrad::test::random_normal_map(random, 16, 16, steepest));
  stack::NormalMapLayer derived = surfgrad::test::normal_layer("a");
  derived.basis = stack::Basis::derived;
  derived.map.tile = {3, -2};
  derived.common.scale = 0.5;
  scene.materials[0].layers = {surfgrad::test::normal_layer("a"), stack::ResolveLayer{}, derived};
  return scene;
}

/// As a file holds it.
image::Image filed(const image::Image& map, image::Depth depth) {
  const bool floats = !image::is_integer(depth);
  return io::decode_image(io::encode_image(map, depth, floats ? io::ImageFormat::exr : io::ImageFormat::tiff),
                          floats ? "map.exr" : "map.tif");
}

/// The layer that reads a map baked with these options.
stack::Layer reader_of(const Options& options) {
  if (options.encoding == Encoding::derivative) {
    stack::DerivativeMapLayer layer;
    layer.common.key = "layers";
    layer.map.file.path = "baked";
    layer.map.filter = stack::Filter::nearest;
    layer.map.green = options.green;
    layer.code = {options.range, options.neutral};
    return layer;
  }
  stack::NormalMapLayer layer = surfgrad::test::normal_layer("baked");
  layer.map.filter = stack::Filter::nearest;
  layer.map.green = options.green;
  return layer;
}

struct Off {
  double mean, most;
};
/// How far the world-space normals of the mesh under its baked map are from those of the stack, in degrees.
Off read_back(const scene::Scene& scene, const Options& options) {
  const Baked baked = bake(scene, options);
  EXPECT_EQ(baked.clamped, 0);
  EXPECT_EQ(baked.beyond_range, 0);
  scene::Scene reader = scene;
  surfgrad::test::add_image(reader, "baked", filed(baked.map, options.depth));
  reader.materials[0].layers = {reader_of(options)};
  const Options world{.width = side, .height = side, .space = Space::world, .depth = image::Depth::float32};
  const image::Image expected = bake(scene, world).map;
  const image::Image got = bake(reader, world).map;
  Off off{0, 0};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const auto normal = [&](const image::Image& map) {
        return vec3<double>{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1};
      };
      const double angle = surfgrad::test::unit_angle(normal(got), normal(expected));
      off.mean += angle / (side * side);
      off.most = std::max(off.most, angle);
    }
  return off;
}

/// Half a step of a code in degrees, for slopes: the largest error along an axis.
double half_step_deg(image::Depth depth, double range) {
  const double most = depth == image::Depth::unorm8 ? 255 : 65535;
  return range / most * 57.3;
}

TEST(Encoding, IsReadBackAsTheSameNormals) {
  const scene::Scene scene = bumped();
  for (const Encoding encoding : {Encoding::rgb, Encoding::rg, Encoding::derivative})
    for (const stack::Green green : {stack::Green::up, stack::Green::down})
      for (const image::Depth depth :
           {image::Depth::unorm8, image::Depth::unorm16, image::Depth::half, image::Depth::float32}) {
        const Options options{.width = side,
                              .height = side,
                              .green = green,
                              .encoding = encoding,
                              .range = encoding == Encoding::derivative ? 2.0 : 1.0,
                              .depth = depth};
        const Off off = read_back(scene, options);
        std::printf("  encoding %d, green %d, depth %d: mean %.5f, most %.5f degrees\n",
                    static_cast<int>(encoding), static_cast<int>(green), static_cast<int>(depth), off.mean,
                    off.most);
        // Half a step along two or three axes, in a frame whose axes are within a factor of two of each
        // other; two channels amplify theirs by 1 / n_z, which stays below 2. Of half floats a step is 2^-11
        // at values near 1. Floats leave what the frames are rounded by.
        const double step = depth == image::Depth::half      ? 0x1p-12 * 2 * 57.3
                            : depth == image::Depth::float32 ? 1e-4
                                                             : half_step_deg(depth, options.range);
        EXPECT_LT(off.most, 2 * std::sqrt(3.0) * 2 * step);
        EXPECT_GT(off.mean, depth == image::Depth::float32 ? 0 : 0.01 * step); // codes were rounded indeed
      }
}

TEST(Encoding, WithAWholeNeutralCodeLeavesWhatIsFlatExactlyFlat) {
  scene::Scene scene = bumped();
  scene.materials[0].layers.clear();
  for (const image::Depth depth : {image::Depth::unorm8, image::Depth::unorm16}) {
    const Options options{.width = side,
                          .height = side,
                          .encoding = Encoding::derivative,
                          .range = 4,
                          .neutral = stack::NeutralCode::whole,
                          .depth = depth,
                          .dither = depth == image::Depth::unorm8};
    EXPECT_LT(read_back(scene, options).most, 1e-4) << "what float normals are rounded by";
  }
}

TEST(Encoding, FlattensSlopesBeyondTheRangeAndSaysHowFarTheyGo) {
  const scene::Scene scene = bumped();
  Options options{.width = side, .height = side, .encoding = Encoding::derivative, .range = 0.25};
  const Baked narrow = bake(scene, options);
  EXPECT_GT(narrow.beyond_range, side * side / 10);
  EXPECT_GT(narrow.steepest, 0.5);
  const std::vector<float> values = test::values_of(narrow.map);
  EXPECT_EQ(*std::max_element(values.begin(), values.end()), 1.0f);
  options.range = 1.0001 * narrow.steepest;
  EXPECT_EQ(bake(scene, options).beyond_range, 0);
  // The direction stays: what is beyond in one slope is scaled in both.
  options.depth = image::Depth::float32;
  options.range = 1;
  const Baked free = bake(scene, options);
  EXPECT_EQ(free.beyond_range, 0); // floats hold any slope
  for (std::size_t i = 0; i < free.map.texels.size(); i += 2) {
    const vec2<double> slope{free.map.texels[i], free.map.texels[i + 1]};
    const vec2<double> kept{0.25 * (2.0 * narrow.map.texels[i] - 1),
                            0.25 * (2.0 * narrow.map.texels[i + 1] - 1)};
    const double scale = std::min(1.0, 0.25 / max_abs(slope));
    EXPECT_LT(max_abs(kept - scale * slope), 1e-6);
  }
}

TEST(Encoding, OfTwoChannelsRefusesOtherSpacesThanTheTangents) {
  for (const Encoding encoding : {Encoding::rg, Encoding::derivative})
    EXPECT_THROW((void)bake(bumped(), {.width = 8, .height = 8, .space = Space::world, .encoding = encoding}),
                 std::invalid_argument);
}

TEST(Verify, FindsWhatFilesRoundAway) {
  const scene::Scene scene = bumped();
  struct Case {
    Options options;
    double mean_bound;
  };
  for (const Case& c :
       {Case{{.depth = image::Depth::float32}, 1e-4}, Case{{.depth = image::Depth::unorm16}, 0.01},
        Case{{.depth = image::Depth::unorm8, .dither = true}, 0.35},
        Case{{.green = stack::Green::down, .encoding = Encoding::rg}, 0.01},
        Case{{.encoding = Encoding::derivative, .range = 2}, 0.01}, Case{{.space = Space::object}, 0.01},
        Case{{.space = Space::world}, 0.01}}) {
    Options options = c.options;
    options.width = side;
    options.height = side;
    const Baked baked = bake(scene, options);
    const Deviation got = verify(scene, options, filed(baked.map, options.depth)).texels;
    std::printf("  mean %.5f, 99.9 %% %.5f, most %.5f degrees\n", got.mean_deg, got.high_deg, got.most_deg);
    EXPECT_EQ(got.compared, side * side);
    EXPECT_EQ(got.left_out, 0);
    EXPECT_LT(got.mean_deg, c.mean_bound);
    EXPECT_LE(got.high_deg, got.most_deg);
    EXPECT_GE(got.most_deg, got.mean_deg);
    EXPECT_LT(got.most_deg, 10 * c.mean_bound);
  }
}

TEST(Verify, TellsTheWorstTexelAndHowManyAreFarOff) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::torus(24, 12));
  const Options options{.width = side, .height = side, .space = Space::world, .depth = image::Depth::float32};
  Baked baked = bake(scene, options);
  // Ten texels of 9216 turned by up to a right angle about an axis across their normal.
  for (int k = 1; k <= 10; ++k) {
    float* texel = &baked.map.texels[baked.map.index(9 * k, 7 * k)];
    const vec3<double> n{2.0 * texel[0] - 1, 2.0 * texel[1] - 1, 2.0 * texel[2] - 1};
    const vec3<double> across = normalize_or_zero(cross(n, vec3<double>{0.36, 0.48, 0.8}));
    const double angle = 9 * k * 3.14159265358979324 / 180;
    const vec3<double> turned = std::cos(angle) * n + std::sin(angle) * across;
    texel[0] = static_cast<float>(0.5 * turned.x + 0.5);
    texel[1] = static_cast<float>(0.5 * turned.y + 0.5);
    texel[2] = static_cast<float>(0.5 * turned.z + 0.5);
  }
  const Deviation got = verify(scene, options, baked.map).texels;
  EXPECT_NEAR(got.most_deg, 90, 1e-3);
  EXPECT_EQ(got.x, 90);
  EXPECT_EQ(got.y, 70);
  EXPECT_NEAR(got.mean_deg, 9.0 * 55 / (side * side), 1e-4);
  // Nine of 9216 are 0.98 in a thousand: the tenth, the least, is not exceeded by more.
  EXPECT_NEAR(got.high_deg, 9, 9.0 / 256 + 1e-4);
}

TEST(Verify, LeavesOutWhatNoMapCanHold) {
  scene::Scene scene = bumped();
  for (vec3<float>& n : scene.meshes[0].normals) n = {0, 0, 0};
  const Options options{.width = side, .height = side};
  const Deviation got = verify(scene, options, bake(scene, options).map).texels;
  EXPECT_EQ(got.compared, 0);
  EXPECT_EQ(got.left_out, side * side);
  EXPECT_EQ(got.mean_deg, 0);
}

} // namespace
} // namespace surfgrad::bake
