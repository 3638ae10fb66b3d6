// Every command that the README shows works as it stands, in the order it stands there.

#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace surfgrad {
namespace {

TEST(Readme, ItsCommandsWork) {
  // A copy of what the commands read, so that the test leaves the checkout alone.
  const Folder folder;
  const std::filesystem::path source = SURFGRAD_SOURCE_DIR;
  std::filesystem::create_directories(folder.path() / "build/demo");
  std::filesystem::copy(source / "examples", folder.path() / "examples",
                        std::filesystem::copy_options::recursive);
  std::ifstream readme(source / "README.md");
  const std::string program = "build/bin/surfgrad ";
  int commands = 0;
  for (std::string line; std::getline(readme, line);) {
    if (!line.starts_with(program)) continue;
    std::istringstream words(line.substr(program.size()));
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) arguments.push_back(word);
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 0) << line << "\n" << run.error;
    ++commands;
  }
  EXPECT_GE(commands, 3);
}

} // namespace
} // namespace surfgrad
