// The program as its users meet it: what it writes, what it says, how it exits.

#include "cli/program.hpp"
#include "io/file.hpp"
#include "io/image_file.hpp"
#include "support/images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace surfgrad {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Commands, VersionAndHelpSucceed) {
  const Folder folder;
  EXPECT_THAT(run_program({"--version"}, folder.path()).out, HasSubstr("surfgrad "));
  for (const char* verb : {"render", "bake"}) {
    const Outcome help = run_program({verb, "--help"}, folder.path());
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("--size"));
    EXPECT_THAT(help.out, HasSubstr("Examples:"));
  }
}

TEST(Commands, RenderWritesThePictureAndSaysSo) {
  const Folder folder;
  const Outcome run =
      run_program({"render", "-o", "a.png", "--size", "40x30", "--samples", "1"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.out, "wrote a.png (40x30)\n");
  EXPECT_THAT(run.error, IsEmpty()); // no progress bar in a pipe
  const image::Image picture = io::read_image(folder.path() / "a.png");
  EXPECT_EQ(picture.width, 40);
  EXPECT_EQ(picture.height, 30);
}

TEST(Commands, BakeWritesEverySpaceAndFormat) {
  const Folder folder;
  for (const char* space : {"tangent", "object", "world"})
    for (const char* name : {"n.png", "n.tif", "n.exr"}) {
      const Outcome run =
          run_program({"bake", "-o", name, "--size", "16", "--space", space, "-q"}, folder.path());
      EXPECT_EQ(run.status, 0) << run.error;
      EXPECT_THAT(run.out, IsEmpty());
      EXPECT_EQ(io::read_image(folder.path() / name).width, 16);
    }
  EXPECT_THAT(folder.files(), ElementsAre("n.exr", "n.png", "n.tif"));
}

/// Vectors of length one where the picture shows something, which must be a good part of it.
void expect_unit_or_zero(const image::Image& picture) {
  double worst = 0;
  int seen = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double length =
          std::hypot(double(picture.at(x, y, 0)), double(picture.at(x, y, 1)), double(picture.at(x, y, 2)));
      if (length == 0) continue;
      worst = std::max(worst, std::abs(length - 1));
      ++seen;
    }
  // Normalised in float: 3 eps (normalize_or_zero).
  EXPECT_LE(worst, 3.6e-7);
  EXPECT_GT(seen, picture.width * picture.height / 10);
}

TEST(Commands, EveryAovIsWrittenRawAndEncoded) {
  const Folder folder;
  for (const std::string aov : {"beauty", "normal", "base_normal", "surfgrad", "uv"}) {
    for (const char* name : {"a.exr", "a.png"}) {
      const Outcome run =
          run_program({"render", "-o", name, "--aov", aov, "--size", "24", "--samples", "1"}, folder.path());
      ASSERT_EQ(run.status, 0) << run.error;
    }
    const image::Image raw = io::read_image(folder.path() / "a.exr");
    const image::Image code = io::read_image(folder.path() / "a.png");
    ASSERT_EQ(raw.texels.size(), code.texels.size());
    double worst = 0;
    for (std::size_t i = 0; i < raw.texels.size(); ++i) {
      const double v = raw.texels[i];
      const double encoded = aov == "beauty" ? v : aov == "uv" ? v - std::floor(v) : 0.5 * v + 0.5;
      worst = std::max(worst, std::abs(255 * std::clamp(encoded, 0.0, 1.0) - 255 * code.texels[i]));
    }
    // Half a code is what rounding to 8 bits costs; the rest is for float arithmetic.
    EXPECT_LE(worst, 0.5001) << aov;
    if (aov == "normal" || aov == "base_normal") expect_unit_or_zero(raw);
  }
}

TEST(Commands, JsonSummaryIsOneLineForMachines) {
  const Folder folder;
  const Outcome run = run_program({"bake", "-o", "n.png", "--size", "16", "--json"}, folder.path());
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.out, HasSubstr("\"covered_texels\":256"));
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1);
}

TEST(Commands, JsonComesQuietOrNotAndForAnyFileName) {
  const Folder folder;
  for (const std::string name : {"n.png", "n\xff.png"}) {
    const Outcome run = run_program({"render", "-o", name, "--size", "8", "--json", "-q"}, folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_THAT(run.out, HasSubstr("\"width\":8"));
  }
  EXPECT_THAT(folder.files(), ElementsAre("n.png", "n\xff.png"));
}

TEST(Commands, FullStandardOutputIsReportedAndFullStandardErrorIsNot) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const Folder folder;
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"bake", "-o", "n.png", "--size", "8"}}) {
    const Outcome run = run_program(arguments, folder.path(), {.out = "/dev/full"});
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.error, HasSubstr("surfgrad: standard output: cannot write"));
  }
  EXPECT_EQ(run_program({"bake", "none.json", "-o", "n.png"}, folder.path(), {.error = "/dev/full"}).status,
            1);
  EXPECT_EQ(run_program({"bake", "-o"}, folder.path(), {.error = "/dev/full"}).status, 2);
}

TEST(Commands, ViewTakesTwoAnglesAndLeavesTheSceneItsPlace) {
  const Folder folder;
  folder.write("s.json", R"({ "surfgrad": 1, "mesh": "m.obj", "layers": [] })");
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  const auto texels = [&](std::vector<std::string> arguments) {
    const std::vector<std::string> rest{"-o", "a.exr", "--size", "16", "--aov", "normal"};
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    return test::values_of(io::read_image(folder.path() / "a.exr"));
  };
  const std::vector<float> before = texels({"--view", "-30", "15", "s.json"});
  EXPECT_EQ(before, texels({"s.json", "--view", "-30", "15"}));
  EXPECT_NE(before, texels({"s.json", "--view", "30", "-15"}));
}

TEST(Commands, ResultsDoNotDependOnTheNumberOfThreads) {
  const Folder folder;
  const auto texels = [&](const std::vector<std::string>& threads) {
    std::vector<std::string> arguments{"bake", "-o", "a.exr", "--size", "64"};
    arguments.insert(arguments.end(), threads.begin(), threads.end());
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    return test::values_of(io::read_image(folder.path() / "a.exr"));
  };
  EXPECT_EQ(texels({"--threads", "1"}), texels({})); // all there are
}

TEST(Commands, CompressionChangesTheFileAndNotThePicture) {
  const Folder folder;
  const auto bake = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bake", "-o", output, "--size", "64"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(arguments, folder.path()).status, 0);
    return io::read_file(folder.path() / output);
  };
  const auto fast = bake("fast.png", {});
  const auto small = bake("small.png", {"--compress", "small"});
  EXPECT_EQ(bake("again.png", {"--compress", "fast"}), fast);
  EXPECT_LT(small.size(), fast.size());
  EXPECT_EQ(io::decode_image(small, "small").texels, io::decode_image(fast, "fast").texels);
  const Outcome wrong = run_program({"bake", "-o", "a.png", "--compress", "tiny"}, folder.path());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.error, HasSubstr("small"));
}

TEST(Commands, UsageErrorsExitWith2AndWriteNothing) {
  const Folder folder;
  const std::vector<std::vector<std::string>> wrong{{},
                                                    {"rendr"},
                                                    {"render"},
                                                    {"render", "-o"},
                                                    {"render", "-o", "a.png", "--size", "0"},
                                                    {"render", "-o", "a.png", "--size", "10x"},
                                                    {"render", "-o", "a.png", "--size", "99999"},
                                                    {"render", "-o", "a.png", "--aov", "depth"},
                                                    {"render", "-o", "a.png", "--samples", "0"},
                                                    {"bake", "-o", "a.png", "--space", "screen"},
                                                    {"bake", "-o", "a.png", "--depth", "12"},
                                                    {"bake", "-o", "a.png", "--threads", "-1"},
                                                    {"bake", "one.json", "two.json", "-o", "a.png"},
                                                    {"bake", "", "-o", "a.png"},
                                                    {"bake", "-o", ""},
                                                    {"render", "-o", "a.png", "--environment", ""},
                                                    {"render", "-o", "a.png", "--view", "30"},
                                                    {"render", "-o", "a.png", "--view", "30", "91"},
                                                    {"render", "-o", "a.png", "--view", "30", "nan"},
                                                    {"render", "-o", "a.png", "--view", "inf", "0"},
                                                    {"render", "-o", "a.png", "--view", "30", "x"}};
  for (const auto& arguments : wrong) {
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 2) << testing::PrintToString(arguments) << run.error;
    EXPECT_FALSE(run.error.empty());
  }
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(Commands, OutputsThatCannotBeWrittenAreRefusedBeforeTheWork) {
  const Folder folder;
  const std::vector<std::pair<std::vector<std::string>, int>> wrong{
      {{"bake", "-o", "a.jpg"}, 1},
      {{"bake", "-o", "missing/a.png"}, 1},
      {{"bake", "-o", "a.png", "--depth", "float"}, 1},
      {{"render", "-o", "."}, 1}};
  for (const auto& [arguments, status] : wrong) {
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, status) << testing::PrintToString(arguments) << run.error;
    EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
  }
  EXPECT_THAT(folder.files(), IsEmpty());
}

} // namespace
} // namespace surfgrad
