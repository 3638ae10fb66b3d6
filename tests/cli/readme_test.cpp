// Every command that the README shows works as it stands, in the order it stands there.

#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace surfgrad {
namespace {

TEST(Readme, ItsCommandsWork) {
  // A copy of what the commands read, so that the test leaves the checkout alone.
  const Folder folder;
  const std::filesystem::path source = SURFGRAD_SOURCE_DIR;
  std::filesystem::create_directories(folder.path() / "build/demo");
  std::filesystem::copy(source / "examples", folder.path() / "examples",
                        std::filesystem::copy_options::recursive);
  EXPECT_GE(run_commands_of("README.md", folder), 3);
}

} // namespace
} // namespace surfgrad
