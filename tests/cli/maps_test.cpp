// convert, blend and inspect as their users meet them.

#include "cli/program.hpp"
#include "io/image_file.hpp"
#include "support/images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace surfgrad {
namespace {

namespace fs = std::filesystem;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A normal map of waves that repeat, green up.
image::Image waves(int side, image::Depth depth = image::Depth::unorm16) {
  image::Image map = image::make_image(side, side, 3, depth);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double phase = 2 * std::numbers::pi * (3 * x + 2 * y) / side;
      const double n[] = {-0.3 * std::cos(phase), -0.2 * std::cos(phase), 1};
      for (int c = 0; c < 3; ++c)
        map.at(x, y, c) = test::stored(0.5 * n[c] / std::hypot(n[0], n[1], n[2]) + 0.5, depth);
    }
  return map;
}

/// Directions of any length.
image::Image colour() {
  test::Random random(1841);
  return test::random_image(random, 8, 8, 3, image::Depth::unorm8);
}

void write_map(const Folder& folder, const std::string& name, const image::Image& map) {
  io::write_image(folder.path() / name, map, map.depth);
}

image::Image read(const Folder& folder, const std::string& name) {
  return io::read_image(folder.path() / name);
}

Outcome run(const Folder& folder, const std::vector<std::string>& arguments) {
  return run_program(arguments, folder.path());
}

/// Runs it for machines; it must succeed and say nothing else.
nlohmann::json summary(const Folder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--json", "-q"});
  const Outcome outcome = run(folder, arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.error, IsEmpty());
  return nlohmann::json::parse(outcome.out);
}

TEST(ConvertCommand, FlipsGreenAndBackByteForByte) {
  const Folder folder;
  write_map(folder, "n.png", waves(150)); // more rows than are written at a time
  const auto told = summary(folder, {"convert", "n.png", "-o", "down.png", "--green", "down"});
  EXPECT_EQ(told["rearranged"], true);
  EXPECT_NE(read(folder, "down.png").texels, read(folder, "n.png").texels);
  summary(folder, {"convert", "down.png", "-o", "up.png", "--from-green", "down"});
  EXPECT_EQ(text_of(folder.path() / "up.png"), text_of(folder.path() / "n.png"));
}

TEST(ConvertCommand, HeightsAndBackThroughTheScaleThatIsTold) {
  const Folder folder;
  write_map(folder, "n.png", waves(64));
  const auto heights = summary(folder, {"convert", "n.png", "-o", "h.png", "--to", "height"});
  EXPECT_LT(heights["not_integrable"], 1e-3);
  EXPECT_EQ(read(folder, "h.png").channels, 1);
  const std::string scale = std::to_string(heights["slope_scale"].get<double>());
  summary(folder, {"convert", "h.png", "-o", "again.png", "--from", "height", "--slope-scale", scale});
  const image::Image before = read(folder, "n.png");
  const image::Image after = read(folder, "again.png");
  for (std::size_t i = 0; i < before.texels.size(); ++i) EXPECT_NEAR(after.texels[i], before.texels[i], 1e-3);
  // In units of length: relief over width, times the texels of a row.
  const auto relief = summary(
      folder, {"convert", "h.png", "-o", "r.png", "--from", "height", "--height", "0.03", "--size", "1.5"});
  EXPECT_NEAR(relief["slope_scale"], 0.02 * 64, 1e-9);
  EXPECT_NEAR(summary(folder, {"convert", "h.png", "-o", "r.png", "--from", "height"})["slope_scale"],
              0.02 * 64, 1e-9);
}

TEST(ConvertCommand, WritesLevelsAndTheRoughnessOfWhatTheyHide) {
  const Folder folder;
  write_map(folder, "n.png", waves(32));
  summary(folder,
          {"convert", "n.png", "-o", "o.png", "--mips", "--roughness", "r.png", "--base-roughness", "0.2"});
  for (int level = 0; level < 6; ++level) {
    const std::string suffix = level == 0 ? ".png" : "_mip" + std::to_string(level) + ".png";
    EXPECT_EQ(read(folder, "o" + suffix).width, 32 >> level);
    EXPECT_EQ(read(folder, "r" + suffix).width, 32 >> level);
  }
  EXPECT_NEAR(read(folder, "r.png").at(3, 3, 0), 0.2, 0.5 / 255);
  EXPECT_GT(read(folder, "r_mip5.png").at(0, 0, 0), 0.45);
  EXPECT_NEAR(read(folder, "o_mip5.png").at(0, 0, 0), 0.5, 2.0 / 65535); // waves have no mean slope
}

TEST(ConvertCommand, TakesFoldersAndPatternsAndTellsOfFailuresAtTheEnd) {
  const Folder folder;
  fs::create_directory(folder.path() / "in");
  write_map(folder, "in/a.png", waves(8));
  write_map(folder, "in/b.png", waves(8));
  write_map(folder, "in/grey.png", image::make_image(4, 4, 1));
  folder.write("in/no.png", "no picture");
  folder.write("in/readme.txt", "not looked at");
  image::Image nan = waves(4);
  nan.depth = image::Depth::float32;
  nan.at(2, 1, 0) = std::numeric_limits<float>::quiet_NaN();
  write_map(folder, "in/nan.exr", nan);
  const Outcome all = run(folder, {"convert", "in", "--out-dir", "out", "--green", "down", "-q"});
  EXPECT_EQ(all.status, 1);
  EXPECT_TRUE(fs::exists(folder.path() / "out/a.png"));
  EXPECT_TRUE(fs::exists(folder.path() / "out/b.png"));
  EXPECT_FALSE(fs::exists(folder.path() / "out/grey.png"));
  EXPECT_THAT(all.error, HasSubstr("in/grey.png: has one channel"));
  EXPECT_THAT(all.error, HasSubstr("in/nan.exr: column 2, row 2 from the top: is not a number"));
  EXPECT_THAT(all.error, HasSubstr("in/no.png: "));
  EXPECT_THAT(all.error, HasSubstr("3 of 5 maps failed"));
  const auto some = summary(folder, {"convert", "in/[ab].png", "--out-dir", "two"});
  EXPECT_EQ(some["maps"].size(), 2u);
  EXPECT_EQ(run(folder, {"convert", "in/*.tga", "--out-dir", "two"}).status, 1);
  EXPECT_EQ(run(folder, {"convert", "out", "two", "--out-dir", "two"}).status, 2); // a.png twice
}

TEST(ConvertCommand, RefusesWhatItCannotDoBeforeItWrites) {
  const Folder folder;
  write_map(folder, "n.png", waves(8));
  write_map(folder, "colour.png", colour());
  struct Case {
    std::vector<std::string> arguments;
    int status;
    const char* says;
  };
  const Case cases[] = {
      {{"n.png", "-o", "o.jpg"}, 1, ".png"},
      {{"n.png", "-o", "o.png", "--depth", "half"}, 1, "o.png"},
      {{"none.png", "-o", "o.png"}, 1, "none.png: no such file"},
      {{"colour.png", "-o", "o.png"}, 1, "colour.png: is no normal map: "},
      {{"n.png", "-o", "n.png", "--green", "down"}, 1, "would replace a map that is read"},
      {{"n.png", "-o", "o.png", "--from-channels", "rga"}, 1, "n.png: has no channel a; it has r, g, b"},
      {{"n.png", "-o", "o.png", "--from-channels", "rr"}, 2, "\"rr\""},
      {{"n.png", "-o", "o.png", "--to-channels", "r"}, 2, "two or three channels"},
      {{"n.png", "-o", "o.png", "--height", "0.1"}, 2, "is for height maps"},
      {{"n.png", "-o", "o.png", "--to", "height", "--size", "2"}, 2, "--size"},
      {{"n.png", "-o", "o.png", "--to", "object"}, 2, "--mesh"},
      {{"n.png", "-o", "o.png", "--mesh", "m.obj"}, 2, "--mesh"},
      {{"n.png", "-o", "o.png", "--roughness", "r.png"}, 2, "--roughness"},
      {{"n.png", "-o", "o.png", "--range", "-1"}, 2, "slope above 0"},
      {{"n.png", "-o", "o.png", "--resize", "0"}, 2, "0"},
      {{"n.png"}, 2, "--output or --out-dir"},
      {{"n.png", "-o", "o.png", "--mips", "--roughness", "o_mip1.png"}, 2, "is already written by"},
  };
  for (const Case& wrong : cases) {
    std::vector<std::string> arguments = wrong.arguments;
    arguments.insert(arguments.begin(), "convert");
    const Outcome outcome = run(folder, arguments);
    EXPECT_EQ(outcome.status, wrong.status) << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(wrong.says));
    EXPECT_THAT(folder.files(), ElementsAre("colour.png", "n.png")) << wrong.says;
  }
}

TEST(ConvertCommand, ObjectSpaceAndBackOverAMesh) {
  const Folder folder;
  // A quad that stands upright, mapped over the whole square: its tangent is x, its normal -y.
  folder.write("m.obj",
               "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  write_map(folder, "n.png", waves(32));
  summary(folder, {"convert", "n.png", "-o", "o.png", "--to", "object", "--mesh", "m.obj"});
  const image::Image tangent = read(folder, "n.png");
  const image::Image object = read(folder, "o.png");
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      EXPECT_NEAR(object.at(x, y, 0), tangent.at(x, y, 0), 1e-4);
      EXPECT_NEAR(object.at(x, y, 2), tangent.at(x, y, 1), 1e-4);
      EXPECT_NEAR(object.at(x, y, 1), 1 - tangent.at(x, y, 2), 1e-4);
    }
  summary(folder, {"convert", "o.png", "-o", "t.png", "--from", "object", "--mesh", "m.obj"});
  const image::Image again = read(folder, "t.png");
  for (std::size_t i = 0; i < again.texels.size(); ++i) EXPECT_NEAR(again.texels[i], tangent.texels[i], 2e-4);
}

TEST(InspectCommand, SaysWhatAMapIsAndMendsWhatIsCertain) {
  const Folder folder;
  write_map(folder, "n.png", waves(64));
  // Waves in one direction alone have curls that agree all the same.
  summary(folder, {"convert", "n.png", "-o", "down.png", "--green", "down"});
  const auto told = summary(folder, {"inspect", "down.png", "--preview", "p.png"});
  EXPECT_EQ(told["looks_like"], "tangent-space normals");
  EXPECT_EQ(told["green"]["value"], "down");
  EXPECT_EQ(told["along_s"]["repeats"], true);
  EXPECT_EQ(read(folder, "p.png").width, 1024);
  const auto mended = summary(folder, {"inspect", "down.png", "--fix", "-o", "up.png"});
  EXPECT_THAT(mended["fixed"], ElementsAre("turned green up"));
  EXPECT_EQ(text_of(folder.path() / "up.png"), text_of(folder.path() / "n.png"));
  const auto nothing = summary(folder, {"inspect", "n.png", "--fix", "-o", "same.png"});
  EXPECT_THAT(nothing["fixed"], IsEmpty());
  EXPECT_EQ(text_of(folder.path() / "same.png"), text_of(folder.path() / "n.png"));
  const Outcome words = run(folder, {"inspect", "down.png"});
  EXPECT_THAT(words.out, HasSubstr("green            down (certain)"));
}

TEST(InspectCommand, MendsLengthsAndTheTiltOfATiledMap) {
  const Folder folder;
  image::Image map = waves(64);
  for (std::size_t i = 0; i < map.texels.size(); i += 3) {
    map.texels.floats()[i] = 0.5f + 0.88f * (map.texels[i] - 0.5f) - 0.04f; // tilted
    map.texels.floats()[i + 1] = 0.5f + 0.88f * (map.texels[i + 1] - 0.5f);
    map.texels.floats()[i + 2] = 0.5f + 0.88f * (map.texels[i + 2] - 0.5f); // and shorter than 1
  }
  write_map(folder, "n.png", map);
  const auto mended = summary(folder, {"inspect", "n.png", "--fix", "-o", "m.png"});
  EXPECT_EQ(mended["fixed"].size(), 2u) << mended;
  const auto found = summary(folder, {"inspect", "m.png"});
  EXPECT_NEAR(found["mean_length"], 1, 1e-4);
  EXPECT_NEAR(found["mean_slope"][0], 0, 1e-4);
}

TEST(InspectCommand, RefusesToMendWhatIsNoNormalMapAndGoesOn) {
  const Folder folder;
  write_map(folder, "a.png", colour());
  write_map(folder, "b.png", waves(32));
  const Outcome outcome = run(folder, {"inspect", "a.png", "b.png", "--fix", "--out-dir", "o", "-q"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.error, HasSubstr("a.png: does not look like a map of tangent-space normals"));
  EXPECT_TRUE(fs::exists(folder.path() / "o/b.png"));
  EXPECT_EQ(run(folder, {"inspect", "b.png", "--fix"}).status, 2);
  EXPECT_EQ(run(folder, {"inspect", "b.png", "-o", "x.png"}).status, 2);
}

TEST(BlendCommand, AddsTiledAndMaskedDetails) {
  const Folder folder;
  write_map(folder, "base.png", waves(64));
  write_map(folder, "detail.png", waves(32));
  image::Image mask = image::make_image(64, 64, 1);
  for (int y = 0; y < 64; ++y)
    for (int x = 32; x < 64; ++x) mask.at(x, y, 0) = 1;
  write_map(folder, "mask.png", mask);
  const auto told = summary(folder, {"blend", "base.png", "--detail", "detail.png", "--tile", "2", "--mask",
                                     "mask.png", "-o", "o.png"});
  // Twice as often in half as many texels: the same slopes, texel by texel.
  const image::Image base = read(folder, "base.png");
  const image::Image blended = read(folder, "o.png");
  EXPECT_NEAR(blended.at(3, 5, 0), base.at(3, 5, 0), 2e-5);
  EXPECT_NEAR(told["steepest_slope"], 0.6, 0.01); // 0.3 of each where waves meet
  const auto both = summary(folder, {"blend", "base.png", "--detail", "base.png", "--detail", "base.png",
                                     "--weight", "1", "--weight", "-2", "-o", "flat.png"});
  EXPECT_NEAR(both["steepest_slope"], 0, 1e-4);
  const auto steep = summary(folder, {"blend", "base.png", "--detail", "base.png", "--weight", "9",
                                      "--derivative", "-o", "d.exr", "--depth", "half"});
  EXPECT_EQ(steep["clamped_texels"], 0); // float files hold any slope
  EXPECT_GT(summary(folder, {"blend", "base.png", "--detail", "base.png", "--weight", "9", "--derivative",
                             "-o", "d.png"})["clamped_texels"],
            0);
}

TEST(BlendCommand, RefusesWhatDoesNotFit) {
  const Folder folder;
  write_map(folder, "a.png", waves(32));
  write_map(folder, "b.png", waves(16));
  write_map(folder, "grey.png", image::make_image(16, 16, 1));
  const auto refused = [&](std::vector<std::string> arguments, int status, const char* says) {
    arguments.insert(arguments.begin(), "blend");
    const Outcome outcome = run(folder, arguments);
    EXPECT_EQ(outcome.status, status) << outcome.error;
    EXPECT_THAT(outcome.error, HasSubstr(says));
    EXPECT_THAT(folder.files(), ElementsAre("a.png", "b.png", "grey.png"));
  };
  refused({"a.png", "--detail", "b.png", "-o", "o.png"}, 1, "b.png: is 16x16, but a.png is 32x32");
  refused({"a.png", "--detail", "a.png", "--mask", "grey.png", "-o", "o.png"}, 1, "grey.png: is 16x16");
  refused({"a.png", "--detail", "grey.png", "-o", "o.png"}, 1, "grey.png: has one channel");
  refused({"a.png", "--detail", "b.png", "--tile", "0", "-o", "o.png"}, 2, "--tile");
  refused({"a.png", "--detail", "b.png", "--weight", "1", "--weight", "2", "-o", "o.png"}, 2,
          "given 2 times for 1");
  refused({"a.png", "--detail", "b.png", "--tile", "2", "-o", "b.png"}, 1, "would replace");
  refused({"a.png", "-o", "o.png"}, 2, "--detail");
}

} // namespace
} // namespace surfgrad
