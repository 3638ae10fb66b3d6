// The program as its users meet it: what it writes, what it says, how it exits.

#include "cli/program.hpp"
#include "io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  const Outcome run = run_program({"render", "-o", "a.png", "--size", "40x30", "--samples", "1"}, folder.path());
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

TEST(Commands, EveryAovIsWrittenRawAndEncoded) {
  const Folder folder;
  for (const char* aov : {"beauty", "normal", "base_normal", "surfgrad", "uv"})
    for (const char* name : {"a.exr", "a.png"}) {
      const Outcome run =
          run_program({"render", "-o", name, "--aov", aov, "--size", "24", "--samples", "1"}, folder.path());
      EXPECT_EQ(run.status, 0) << run.error;
    }
}

TEST(Commands, JsonSummaryIsOneLineForMachines) {
  const Folder folder;
  const Outcome run = run_program({"bake", "-o", "n.png", "--size", "16", "--json"}, folder.path());
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.out, HasSubstr("\"covered_texels\":256"));
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1);
}

TEST(Commands, ResultsDoNotDependOnTheNumberOfThreads) {
  const Folder folder;
  for (const char* threads : {"1", "2", "3"})
    ASSERT_EQ(run_program({"bake", "-o", std::string(threads) + ".exr", "--size", "64", "--threads", threads},
                          folder.path())
                  .status,
              0);
  const auto texels = [&](const char* name) { return io::read_image(folder.path() / name).texels; };
  EXPECT_EQ(texels("1.exr"), texels("2.exr"));
  EXPECT_EQ(texels("1.exr"), texels("3.exr"));
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
                                                    {"bake", "one.json", "two.json", "-o", "a.png"}};
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
