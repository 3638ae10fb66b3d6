// Vulkan devices that fail, lack something or have little: one line and exit status 3, and the output that
// was there stays as it was; or the same picture.

#include "cli/program.hpp"
#include "io/image_file.hpp"
#include "support/images.hpp"
#include "support/software_driver.hpp"
#include "support/vulkan_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>

namespace surfgrad {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* older = "an older picture";

class FaultyDevice : public testing::Test {
 protected:
  void SetUp() override {
    test::choose_software_driver();
    // What the driver never frees is not the program's (support/software_driver.cpp).
    setenv("LSAN_OPTIONS", "detect_leaks=0", 1);
    folder_.write("quad.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
                              "f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n");
    test::Random random(3);
    std::string layers;
    for (const char* name : {"a.png", "b.png", "c.png"}) {
      io::write_image(folder_.path() / name,
                      test::random_normal_map(random, 64, 64, 0.5, image::Depth::unorm8),
                      image::Depth::unorm8);
      layers += (layers.empty() ? "" : ", ") +
                std::string(R"({ "type": "normal_map", "scale": 0.5, "map": ")") + name + "\" }";
    }
    folder_.write("s.json", R"({ "surfgrad": 1, "mesh": "quad.obj", "layers": [ )" + layers + " ] }");
  }
  void TearDown() override { unsetenv("LSAN_OPTIONS"); }

  /// Bakes or renders in tiles of 16 x 16 unless `more` has another size.
  [[nodiscard]] Outcome run(const std::string& verb, const std::string& faults,
                            const std::vector<std::string>& more = {}) {
    const test::VulkanFaults layer(faults, counts_.path() / "counts");
    std::vector<std::string> arguments{verb, "s.json", "-o", "out.exr", "--size", "64", "--device", "vulkan"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (std::find(more.begin(), more.end(), "--max-tile") == more.end())
      arguments.insert(arguments.end(), {"--max-tile", "16"});
    return run_program(arguments, folder_.path());
  }
  /// What the last run did on the device.
  [[nodiscard]] std::map<std::string, int> counts() const {
    std::map<std::string, int> result;
    std::ifstream file(counts_.path() / "counts");
    std::string name;
    for (int count = 0; file >> name >> count;) result[name] = count;
    return result;
  }
  /// What a run without faults does.
  [[nodiscard]] std::map<std::string, int> usual_counts(const std::string& verb,
                                                        const std::vector<std::string>& more = {}) {
    const Outcome sound = run(verb, "", more);
    EXPECT_EQ(sound.status, 0) << sound.error;
    return counts();
  }
  /// A run with faults must end so and leave no trace.
  void expect_failure(const std::string& verb, const std::string& faults, const std::string& reason,
                      const std::vector<std::string>& more = {}) {
    folder_.write("out.exr", older);
    const std::vector<std::string> before = folder_.files();
    const Outcome outcome = run(verb, faults, more);
    EXPECT_EQ(outcome.status, 3) << verb << ' ' << faults << ": " << outcome.error;
    EXPECT_THAT(outcome.error, AllOf(StartsWith("surfgrad: cannot "), HasSubstr(reason))) << faults;
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_EQ(folder_.files(), before) << verb << ' ' << faults;
    EXPECT_EQ(text_of(folder_.path() / "out.exr"), older) << verb << ' ' << faults;
  }

  Folder folder_;

 private:
  Folder counts_;
};

TEST_F(FaultyDevice, ThatIsLostAtAnyTimeLeavesTheOutputAlone) {
  for (const std::string verb : {"bake", "render"}) {
    const auto usual = usual_counts(verb);
    const int uploads = usual.at("uploads"), all = usual.at("submissions");
    ASSERT_GE(uploads, 3) << "parameters, maps and what says where they are";
    ASSERT_EQ(all, usual.at("waits"));
    ASSERT_GE(all, uploads + 8) << "too few tiles for a middle";
    const std::string reason = "the device was lost";
    const auto middle = std::to_string((uploads + all) / 2);
    expect_failure(verb, "submit=" + middle, reason);
    expect_failure(verb, "wait=" + middle, reason);
    expect_failure(verb, "wait=" + std::to_string(all), reason);
    expect_failure(verb, "submit=" + std::to_string(uploads), reason); // while maps are uploaded
    expect_failure(verb, "wait=1", reason);
  }
}

TEST_F(FaultyDevice, ThatRunsOutOfMemoryLeavesTheOutputAlone) {
  const std::vector<std::string> alone{"--threads", "1"}; // each thread allocates
  const int all = usual_counts("bake", alone).at("allocations");
  ASSERT_GE(all, 9) << "two for each upload, three for tiles";
  for (const int n : {1, all / 2, all})
    expect_failure("bake", "allocate=" + std::to_string(n), "not enough memory on the device", alone);
  expect_failure("render", "allocate=2", "not enough memory on the device", alone);
}

TEST_F(FaultyDevice, ThatLacksAFeatureIsToldByItsName) {
  const std::map<std::string, std::string> rows{
      {"vulkan-1.0", "it lacks Vulkan 1.1"},
      {"no-compute", "it lacks a queue that computes"},
      {"robustBufferAccess", "it lacks the feature robustBufferAccess"},
      {"maxPerStageDescriptorStorageBuffers=4",
       "it lacks maxPerStageDescriptorStorageBuffers of 6 or more: it has 4"}};
  for (const auto& [fault, reason] : rows) {
    expect_failure("bake", fault, reason);
    const test::VulkanFaults layer(fault);
    const Outcome listed = run_program({"--list-devices"}, folder_.path());
    EXPECT_EQ(listed.status, 0) << listed.error;
    EXPECT_THAT(listed.out, HasSubstr("cannot be used, " + reason));
  }
}

TEST_F(FaultyDevice, ThatIsTooSmallForTheMaterialIsToldByTheLimit) {
  expect_failure("bake", "maxStorageBufferRange=20000", "a.png needs ");
  expect_failure("bake", "maxStorageBufferRange=20000",
                 " bytes in one buffer, maxStorageBufferRange is 20000; use smaller maps, or --device cpu");
  expect_failure("bake", "maxUniformBufferRange=31",
                 "its numbers need 32 bytes in one buffer, maxUniformBufferRange is 31; use fewer layers");
  // Each map has a buffer; four hold other things.
  const std::string each = "maxStorageBufferRange=30000 ";
  expect_failure(
      "render", each + "maxPerStageDescriptorStorageBuffers=6",
      "its maps need 3 buffers, all in all 7, maxPerStageDescriptorStorageBuffers is 6; use smaller maps");
  expect_failure("render", each + "maxPerStageResources=7",
                 "its maps need 3 buffers, all in all 7, maxPerStageResources is 7; use smaller maps");
}

TEST_F(FaultyDevice, ThatIsJustLargeEnoughGivesTheSameBytes) {
  const auto written = [&](const std::string& faults) {
    const Outcome outcome = run("bake", faults, {"--threads", "1", "--max-tile", "64"});
    EXPECT_EQ(outcome.status, 0) << faults << outcome.error;
    return outcome.error + text_of(folder_.path() / "out.exr"); // with what it warns about
  };
  const std::string expected = written("");
  const auto usual = counts();
  // Results that nobody writes would show.
  EXPECT_TRUE(written("fill") == expected);
  // 64 fragments at a time.
  EXPECT_TRUE(written("fill maxComputeWorkGroupCount=1") == expected);
  EXPECT_EQ(counts().at("submissions"), usual.at("submissions") + 63);
  // Maps in buffers of their own, and fragments of fewer than 7500 floats in all.
  EXPECT_TRUE(written("fill maxStorageBufferRange=30000 maxPerStageDescriptorStorageBuffers=7") == expected);
  EXPECT_GT(counts().at("uploads"), usual.at("uploads"));
  EXPECT_GT(counts().at("submissions"), usual.at("submissions") + 9);
}

} // namespace
} // namespace surfgrad
