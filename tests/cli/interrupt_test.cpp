// Ctrl-C: the program ends by the signal, and the folder holds the whole output or nothing.

#include "cli/program.hpp"
#include "io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

namespace surfgrad {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Interrupt, DuringTheWorkLeavesNothing) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Folder folder;
    // One thread takes many times as long as the pause; an early signal must do no harm either.
    Running program({"bake", "-o", "n.png", "--size", "4000", "--threads", "1"}, folder.path());
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    program.send(signal);
    const Outcome run = program.wait();
    EXPECT_EQ(run.signal, signal) << run.status << run.error;
    EXPECT_THAT(run.out, IsEmpty());
    EXPECT_THAT(folder.files(), IsEmpty());
  }
}

bool a_file_is_being_written(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::error_code gone;
    const std::uintmax_t size = entry.path().extension() == ".partial" ? entry.file_size(gone) : 0;
    if (!gone && size > 0) return true;
  }
  return false;
}

TEST(Interrupt, DuringTheWritingLeavesTheOldFileOrAllOfTheNewOne) {
  const Folder folder;
  io::write_image(folder.path() / "n.exr", image::make_image(1, 1, 3), image::Depth::half);
  // Tens of megabytes take long enough to be met while written.
  Running program({"bake", "-o", "n.exr", "--size", "1500"}, folder.path());
  while (!program.ended() && !a_file_is_being_written(folder.path())) {
  }
  program.send(SIGINT);
  program.send(SIGTERM); // an impatient user leaves no half a file either
  const Outcome run = program.wait();
  EXPECT_TRUE(run.signal == SIGINT || run.signal == SIGTERM) << run.status << run.error;
  ASSERT_THAT(folder.files(), ElementsAre("n.exr"));
  // The first signal may come while the finished file is moved into place.
  EXPECT_THAT(io::read_image(folder.path() / "n.exr").width, testing::AnyOf(1, 1500));
}

} // namespace
} // namespace surfgrad
