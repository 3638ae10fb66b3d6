// What composes: the processor or a Vulkan device. One that is not there is an error, never another.

#include "cli/program.hpp"
#include "io/image_file.hpp"
#include "support/software_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace surfgrad {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class DeviceOption : public testing::Test {
 protected:
  void SetUp() override {
    test::choose_software_driver();
    // What the driver never frees is not the program's (support/software_driver.cpp).
    setenv("LSAN_OPTIONS", "detect_leaks=0", 1);
    driver_ = std::getenv("VK_ICD_FILENAMES");
  }
  void TearDown() override {
    setenv("VK_ICD_FILENAMES", driver_.c_str(), 1);
    unsetenv("LSAN_OPTIONS");
  }
  void take_the_driver_away() { setenv("VK_ICD_FILENAMES", "/nowhere.json", 1); }

  Folder folder_;

 private:
  std::string driver_;
};

TEST_F(DeviceOption, ListsWhatItTakes) {
  const Outcome listed = run_program({"--list-devices"}, folder_.path());
  EXPECT_EQ(listed.status, 0) << listed.error;
  EXPECT_THAT(listed.out, StartsWith("cpu\nvulkan:0  "));
  EXPECT_THAT(listed.error, IsEmpty());
  take_the_driver_away();
  const Outcome without = run_program({"--list-devices"}, folder_.path());
  EXPECT_EQ(without.status, 0);
  EXPECT_EQ(without.out, "cpu\n");
  EXPECT_THAT(without.error, HasSubstr("no Vulkan driver is installed"));
}

TEST_F(DeviceOption, WithoutADriverIsOneLineAndStatusThree) {
  take_the_driver_away();
  for (const char* verb : {"bake", "render"}) {
    const Outcome outcome =
        run_program({verb, "-o", "out.png", "--size", "8", "--device", "vulkan"}, folder_.path());
    EXPECT_EQ(outcome.status, 3);
    EXPECT_THAT(outcome.error, StartsWith("surfgrad: cannot start Vulkan: no Vulkan driver is installed"));
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
  }
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST_F(DeviceOption, ThatIsNotThereIsStatusThree) {
  const Outcome outcome = run_program({"bake", "-o", "out.png", "--device", "vulkan:99"}, folder_.path());
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.error, HasSubstr("cannot use Vulkan device 99"));
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST_F(DeviceOption, RefusesOtherWords) {
  for (const char* word : {"cuda", "vulkan:", "vulkan:x", "vulkan:-1", ""}) {
    const Outcome outcome = run_program({"bake", "-o", "out.png", "--device", word}, folder_.path());
    EXPECT_EQ(outcome.status, 2) << word;
    EXPECT_THAT(outcome.error, HasSubstr("is not a device")) << word;
  }
  for (const char* tile : {"0", "-1", "513", "x"}) {
    const Outcome outcome =
        run_program({"bake", "-o", "out.png", "--device", "vulkan", "--max-tile", tile}, folder_.path());
    EXPECT_EQ(outcome.status, 2) << tile;
    EXPECT_THAT(outcome.error, AllOf(StartsWith("--max-tile: "), HasSubstr("512"))) << tile;
  }
  // The processor has tiles of its own.
  const Outcome outcome = run_program({"bake", "-o", "out.png", "--max-tile", "9"}, folder_.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.error, HasSubstr("--device"));
}

TEST_F(DeviceOption, FiltersByHardwareWhereItIsToldTo) {
  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",   "-o",     "out.exr", "--size", "64",
                                       "--device", "vulkan", "--aov",   "normal"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(arguments, folder_.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    return outcome.out;
  };
  EXPECT_THAT(picture({"--json"}), HasSubstr(R"("filter":"exact","filter_bound_deg":0.0)"));
  EXPECT_THAT(picture({}), Not(HasSubstr("hardware")));
  const std::string summary = picture({"--filter", "hardware"});
  EXPECT_THAT(summary, HasSubstr("1 of 4 maps filtered by hardware: normals at most 0."));
  EXPECT_THAT(summary, HasSubstr(" degrees from those of exact filters"));
  const std::string json = picture({"--filter", "hardware", "--json"});
  EXPECT_THAT(json, HasSubstr(R"("filter":"hardware","filter_bound_deg":0.)"));
  EXPECT_THAT(json, HasSubstr(R"("maps_sampled_by_hardware":1)"));
}

TEST_F(DeviceOption, RefusesFiltersThatAreNotThere) {
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bake", "-o", "out.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(arguments, folder_.path());
    EXPECT_EQ(outcome.status, 2);
    return outcome.error;
  };
  EXPECT_THAT(refused({"--device", "vulkan", "--filter", "soft"}),
              HasSubstr("\"soft\" is none of exact, hardware"));
  EXPECT_THAT(refused({"--filter", "exact"}), HasSubstr("--filter requires --device"));
  EXPECT_THAT(refused({"--device", "cpu", "--filter", "hardware"}), HasSubstr("use --device vulkan"));
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST_F(DeviceOption, GivesTheSamePictureInTilesOfAnySize) {
  const auto written = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bake", "-o", "out.exr", "--size", "40", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run_program(arguments, folder_.path());
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_THAT(outcome.out, HasSubstr(more.empty() ? R"("device":"cpu")" : R"("device":")"));
    return io::read_image(folder_.path() / "out.exr");
  };
  const image::Image expected = written({});
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--device", "vulkan"}, {"--device", "vulkan:0", "--max-tile", "9"}}) {
    const image::Image got = written(more);
    ASSERT_EQ(got.texels.size(), expected.texels.size());
    double largest = 0;
    for (std::size_t i = 0; i < got.texels.size(); ++i)
      largest = std::max(largest, std::abs(double{got.texels[i]} - double{expected.texels[i]}));
    // Components of n / 2 + 1/2: 0.05 degrees.
    EXPECT_LT(largest, 4.4e-4);
  }
}

} // namespace
} // namespace surfgrad
