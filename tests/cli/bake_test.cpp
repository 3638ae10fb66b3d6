// What the options of `surfgrad bake` make of the map, as its users meet it.

#include "cli/program.hpp"
#include "io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>

namespace surfgrad {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A quad over the lower left quarter of UV set 0, turned by a right angle, under a normal map.
void write_quad(const Folder& folder, const std::string& layers) {
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                        "vt 0 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\nf 1/1 2/2 3/3 4/4\n");
  folder.write("s.json", "{ \"surfgrad\": 1, \"mesh\": \"m.obj\",\n  \"layers\": [" + layers + "] }");
  image::Image map = image::make_image(8, 8, 3, image::Depth::unorm16);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const double slope[] = {0.6 * std::sin(2.0 * x), 0.6 * std::cos(3.0 * y)};
      const double length = std::hypot(slope[0], slope[1], 1.0);
      for (int c = 0; c < 3; ++c)
        map.at(x, y, c) = static_cast<float>(0.5 * (c < 2 ? slope[c] : 1.0) / length + 0.5);
    }
  io::write_image(folder.path() / "n.png", map, image::Depth::unorm16);
}
const std::string normal_map = R"({ "type": "normal_map", "map": "n.png", "basis": "derived" })";

nlohmann::json bake(const Folder& folder, const std::vector<std::string>& options,
                    const std::string& size = "32") {
  std::vector<std::string> arguments{"bake", "s.json", "--size", size, "--json", "-q"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome run = run_program(arguments, folder.path());
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.error, IsEmpty());
  return nlohmann::json::parse(run.out);
}

TEST(Bake, PadsBySixteenTexelsUnlessToldOtherwise) {
  const Folder folder;
  write_quad(folder, normal_map);
  const auto padded = bake(folder, {"-o", "a.png"}, "64");
  EXPECT_EQ(padded["covered_texels"], 32 * 32);
  // Strips of 16 texels along both sides, and the quarter disc of the corner: texel centres within 16 of one.
  int corner = 0;
  for (int y = 1; y <= 16; ++y)
    for (int x = 1; x <= 16; ++x) corner += x * x + y * y <= 256 ? 1 : 0;
  EXPECT_EQ(padded["padded_texels"], 2 * 16 * 32 + corner);
  EXPECT_EQ(bake(folder, {"-o", "a.png", "--padding", "0"})["padded_texels"], 0);
  const image::Image bare = io::read_image(folder.path() / "a.png");
  EXPECT_EQ(bare.at(16, 3, 2), 1.0f);
  bake(folder, {"-o", "a.png", "--padding", "2"});
  const image::Image map = io::read_image(folder.path() / "a.png");
  for (int c = 0; c < 3; ++c) EXPECT_EQ(map.at(17, 3, c), map.at(15, 3, c));
  EXPECT_EQ(map.at(18, 3, 2), 1.0f);
  EXPECT_EQ(bake(folder, {"-o", "a.png", "--padding", "fill"})["padded_texels"], 32 * 32 - 16 * 16);
  const image::Image full = io::read_image(folder.path() / "a.png");
  EXPECT_NE(full.at(31, 31, 0), bare.at(31, 31, 0));
}

TEST(Bake, DithersEightBitsUnlessToldOtherwise) {
  const Folder folder;
  write_quad(folder, normal_map);
  const auto texels = [&](std::vector<std::string> options) {
    options.insert(options.end(), {"-o", "a.png", "--depth", "8"});
    bake(folder, options);
    return io::read_image(folder.path() / "a.png").texels;
  };
  const auto dithered = texels({});
  EXPECT_EQ(dithered, texels({"--dither", "on"}));
  EXPECT_NE(dithered, texels({"--dither", "off"}));
}

TEST(Bake, EveryEncodingReadsBackThroughItsLayer) {
  const Folder folder;
  for (const auto& [options, layer] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{}, R"("type": "normal_map")"},
           {{"--green", "down"}, R"("type": "normal_map", "green": "down")"},
           {{"--encoding", "rg"}, R"("type": "normal_map")"},
           {{"--encoding", "derivative", "--range", "2"}, R"("type": "derivative_map", "range": 2)"},
           {{"--encoding", "derivative", "--range", "2", "--neutral", "whole", "--green", "down"},
            R"("type": "derivative_map", "range": 2, "neutral": "whole", "green": "down")"}})
    for (const std::string extension : {".png", ".tif", ".exr"}) {
      std::vector<std::string> arguments = options;
      if (extension == ".exr" && options.size() == 8) continue; // floats have no neutral code
      write_quad(folder, normal_map);
      bake(folder, {"-o", "expected.exr"});
      arguments.insert(arguments.end(), {"-o", "baked" + extension});
      const auto summary = bake(folder, arguments);
      EXPECT_EQ(summary.contains("texels_beyond_range"), options.size() > 2) << summary;
      write_quad(folder, "{ " + layer + ", \"map\": \"baked" + extension + "\", \"filter\": \"nearest\" }");
      bake(folder, {"-o", "got.exr"});
      const image::Image expected = io::read_image(folder.path() / "expected.exr");
      const image::Image got = io::read_image(folder.path() / "got.exr");
      ASSERT_EQ(got.texels.size(), expected.texels.size());
      double worst = 0;
      for (std::size_t i = 0; i < got.texels.size(); ++i)
        worst = std::max(worst, std::abs(double(got.texels[i]) - double(expected.texels[i])));
      // Half a step of 16 bits of slopes up to 2; z of two channels amplifies theirs by 1 / n_z < 1.5.
      EXPECT_LT(worst, 2.0 / 65535) << layer << extension;
    }
}

TEST(Bake, VerifyPrintsHowFarTheDecodedNormalsAreOff) {
  const Folder folder;
  write_quad(folder, normal_map);
  const auto summary = bake(folder, {"-o", "a.png", "--verify"});
  EXPECT_GT(summary["verified_on_screen"]["pixels"], 100000);
  EXPECT_GT(summary["verified_on_screen"]["mean_deg"], summary["verified"]["mean_deg"]);
  const auto fine = summary["verified"];
  EXPECT_EQ(fine["texels"], 16 * 16);
  EXPECT_LT(fine["mean_deg"], 0.01);
  EXPECT_LT(fine["most_deg"], 0.1);
  const auto coarse = bake(folder, {"-o", "a.png", "--verify", "--depth", "8"})["verified"];
  EXPECT_GT(coarse["mean_deg"], fine["most_deg"]);
  EXPECT_LT(coarse["mean_deg"], 0.35);
  const Outcome words =
      run_program({"bake", "s.json", "-o", "a.png", "--size", "32", "--verify"}, folder.path());
  EXPECT_THAT(words.out, HasSubstr("decoded, 256 texels are off by 0.00"));
  EXPECT_THAT(words.out, HasSubstr("pixels of a picture of 1024x1024 are off by "));
  // In tenths of a degree: a range too small for the slopes flattens them, and both numbers say so.
  const Outcome flat =
      run_program({"bake", "s.json", "-o", "a.png", "--encoding", "derivative", "--range", "0.3", "--verify"},
                  folder.path());
  EXPECT_THAT(flat.error, HasSubstr("steeper than the range of 0.3"));
  EXPECT_THAT(flat.error, HasSubstr("--range "));
}

TEST(Bake, SamplesAreCountedAsSuch) {
  const Folder folder;
  write_quad(folder, normal_map);
  const auto summary = bake(folder, {"-o", "a.png", "--samples", "3"});
  EXPECT_EQ(summary["covered_texels"], 16 * 16);
  EXPECT_EQ(summary["covered_samples"], 9 * 16 * 16);
  EXPECT_FALSE(summary.contains("singular_texels"));
}

TEST(Bake, NamesTheUnitSquareThatAMeshIsLaidOutInInstead) {
  const Folder folder;
  write_quad(folder, normal_map);
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                        "vt 1 0\nvt 1.5 0\nvt 1.5 0.5\nvt 1 0.5\nf 1/1 2/2 3/3 4/4\n");
  const Outcome run = run_program({"bake", "s.json", "-o", "a.png"}, folder.path());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("UV set 0 lies in the unit square from (1, 0) to (2, 1)"));
  EXPECT_THAT(run.error, HasSubstr("move its coordinates by (-1, 0)"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.png"));
}

TEST(Bake, RefusesAUvSetThatTheMeshLacksAndParallax) {
  const Folder folder;
  write_quad(folder, normal_map);
  const Outcome lacking = run_program({"bake", "s.json", "-o", "a.png", "--uv", "1"}, folder.path());
  EXPECT_EQ(lacking.status, 1);
  EXPECT_THAT(lacking.error, HasSubstr("has no texture coordinates (UV set 1)"));
  write_quad(folder, "\n { \"type\": \"parallax\", \"map\": \"n.png\" },\n" + normal_map);
  const Outcome parallax = run_program({"bake", "s.json", "-o", "a.png"}, folder.path());
  EXPECT_EQ(parallax.status, 1);
  EXPECT_THAT(parallax.error, HasSubstr("s.json:3: layers[0]: parallax depends on the viewer"));
  EXPECT_EQ(run_program({"render", "s.json", "-o", "a.png", "--size", "8"}, folder.path()).status, 0);
}

TEST(Bake, OptionsThatContradictEachOtherAreUsageErrors) {
  const Folder folder;
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--padding", "-1"},
                                             {"--padding", "257"},
                                             {"--padding", "4.5"},
                                             {"--padding", "full"},
                                             {"--samples", "0"},
                                             {"--samples", "17"},
                                             {"--uv", "8"},
                                             {"--green", "left"},
                                             {"--encoding", "rgba"},
                                             {"--encoding", "rg", "--space", "object"},
                                             {"--encoding", "derivative", "--space", "world"},
                                             {"--range", "2"},
                                             {"--encoding", "derivative", "--range", "0"},
                                             {"--encoding", "derivative", "--range", "nan"},
                                             {"--encoding", "derivative", "--range", "129"},
                                             {"--neutral", "whole"},
                                             {"--dither", "on"},
                                             {"--dither", "maybe", "--depth", "8"}}) {
    std::vector<std::string> arguments{"bake", "-o", "a.png", "--size", "8"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 2) << testing::PrintToString(options) << run.error;
    EXPECT_THAT(run.error,
                HasSubstr(options[0] == "--encoding" && options.size() > 2 && options[2] == "--range"
                              ? "--range"
                              : options[0]));
  }
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(BakeLostDetail, WritesLevelsOfTheMapAndOfItsRoughness) {
  const Folder folder;
  write_quad(folder, normal_map);
  const auto summary = bake(folder, {"-o", "o.png", "--samples", "2", "--roughness", "r.png", "--anisotropy",
                                     "a.png", "--base-roughness", "0.2", "--mips", "--gltf", "m.glb"});
  EXPECT_EQ(summary["lost_detail"].size(), 5u + 2 * 6); // 32 texels have 5 levels below theirs
  double before = 0.2;                                  // the base
  for (int level = 0; level < 6; ++level) {
    const std::string suffix = level == 0 ? ".png" : "_mip" + std::to_string(level) + ".png";
    const image::Image normals = io::read_image(folder.path() / ("o" + suffix));
    const image::Image roughness = io::read_image(folder.path() / ("r" + suffix));
    const image::Image anisotropy = io::read_image(folder.path() / ("a" + suffix));
    EXPECT_EQ(normals.width, 32 >> level);
    EXPECT_EQ(normals.depth, image::Depth::unorm16);
    EXPECT_EQ(roughness.width, 32 >> level);
    EXPECT_EQ(roughness.channels, 1);
    EXPECT_EQ(anisotropy.channels, 3);
    double mean = 0;
    const int covered = std::max(1, 16 >> level);
    for (int y = 0; y < covered; ++y)
      for (int x = 0; x < covered; ++x) mean += double{roughness.at(x, y, 0)} / (covered * covered);
    EXPECT_GE(mean, before) << level; // coarser levels lose more
    before = mean;
  }
  EXPECT_GT(before, 0.4);
  const Outcome run = run_program({"render", "m.glb", "-o", "p.png", "--size", "16"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.error;
}

TEST(BakeLostDetail, RefusesWhatCannotBeMeantBeforeAnythingIsWritten) {
  const Folder folder;
  write_quad(folder, normal_map);
  struct Case {
    std::vector<std::string> options;
    int status;
    const char* said;
  };
  const Case cases[] = {
      {{"--roughness", "r.png"}, 2, "--samples 2 or more"},
      {{"--anisotropy", "a.png", "--samples", "2"}, 2, "goes with --roughness"},
      {{"--roughness", "r.png", "--samples", "2", "--space", "world"}, 2, "--space tangent"},
      {{"--roughness", "r.png", "--samples", "2", "--base-roughness", "1.5"}, 2, "from 0 to 1"},
      {{"--roughness", "r.png", "--samples", "2", "--base-roughness", "gone.png"}, 1, "gone.png"},
      {{"--roughness", "o.png", "--samples", "2"}, 2, "is already written by --output"},
      {{"--roughness", "n.png", "--samples", "2"}, 1, "would replace a file of the scene"},
      {{"--roughness", "no/r.png", "--samples", "2"}, 1, "no"},
      {{"--roughness", "r.jpg", "--samples", "2"}, 1, "r.jpg"},
  };
  for (const Case& c : cases) {
    std::vector<std::string> arguments{"bake", "s.json", "--size", "32", "-o", "o.png"};
    arguments.insert(arguments.end(), c.options.begin(), c.options.end());
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, c.status) << c.said << ": " << run.error;
    EXPECT_THAT(run.error, HasSubstr(c.said));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "o.png")) << c.said;
  }
}

TEST(Bake, NeverReplacesAFileOfTheScene) {
  const Folder folder;
  write_quad(folder, normal_map);
  const Outcome run = run_program({"bake", "s.json", "--size", "32", "-o", "n.png"}, folder.path());
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("would replace a file of the scene"));
  EXPECT_EQ(io::read_image(folder.path() / "n.png").width, 8);
}

TEST(BakeUdim, WritesAMapForEachTileOfTheMesh) {
  const Folder folder;
  write_quad(folder, normal_map);
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                        "vt 0.5 1\nvt 1.5 1\nvt 1.5 1.5\nvt 0.5 1.5\nf 1/1 2/2 3/3 4/4\n");
  const auto summary = bake(folder, {"-o", "n.<UDIM>.png", "--padding", "0", "--verify"});
  ASSERT_EQ(summary["tiles"].size(), 2u);
  EXPECT_EQ(summary["tiles"][0]["udim"], 1011);
  EXPECT_EQ(summary["tiles"][0]["output"], "n.1011.png");
  EXPECT_EQ(summary["tiles"][1]["output"], "n.1012.png");
  for (const auto& tile : summary["tiles"]) {
    EXPECT_EQ(tile["covered_texels"], 16 * 16);
    EXPECT_LT(tile["verified"]["most_deg"], 0.1);
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "n.1001.png"));
  // What lies in the other tile is no reason for a warning.
  const Outcome run = run_program({"bake", "s.json", "--size", "32", "-o", "n.<UDIM>.png"}, folder.path());
  EXPECT_THAT(run.error, testing::Not(HasSubstr("unit square")));
}

TEST(BakeUdim, BelowTheFirstTileAndBesideOtherOutputsIsRefused) {
  const Folder folder;
  write_quad(folder, normal_map);
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                        "vt -0.5 0\nvt 0.5 0\nvt 0.5 0.5\nvt 0 0.5\nf 1/1 2/2 3/3 4/4\n");
  const Outcome low = run_program({"bake", "s.json", "--size", "32", "-o", "n.<UDIM>.png"}, folder.path());
  EXPECT_EQ(low.status, 1);
  EXPECT_THAT(low.error, HasSubstr("tiles 1001 to 9999"));
  const Outcome both =
      run_program({"bake", "s.json", "-o", "n.<UDIM>.png", "--gltf", "m.glb"}, folder.path());
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.error, HasSubstr("<UDIM>"));
}

} // namespace
} // namespace surfgrad
