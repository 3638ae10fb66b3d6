// SURFGRAD_ISA through the whole program: the same file from every instruction set, one line about others.

#include "cli/program.hpp"
#include "simd/isa.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace surfgrad {
namespace {

using testing::HasSubstr;

/// The program inherits what the environment names.
Outcome run_with(const char* isa, const std::vector<std::string>& arguments, const Folder& folder) {
  setenv("SURFGRAD_ISA", isa, 1);
  const Outcome run = run_program(arguments, folder.path());
  unsetenv("SURFGRAD_ISA");
  return run;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(InstructionSets, ThatAreNoneAreRefusedInOneLineBeforeTheWork) {
  const Folder folder;
  for (const char* verb : {"render", "bake"}) {
    // The scene does not exist: the instruction set is looked at first.
    const Outcome run = run_with("nonsense", {verb, "none.json", "-o", "a.png"}, folder);
    EXPECT_EQ(run.status, 1) << run.error;
    EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
    EXPECT_THAT(run.error, HasSubstr("surfgrad: SURFGRAD_ISA: \"nonsense\" is no instruction set"));
    EXPECT_THAT(folder.files(), testing::IsEmpty());
  }
}

TEST(InstructionSets, ThatTheProcessorLacksEndWithStatus3) {
  const Folder folder;
  int lacking = 0;
  for (const simd::Isa isa : {simd::Isa::sse4, simd::Isa::avx2, simd::Isa::avx512}) {
    const auto has = simd::available_isas();
    const bool there = std::find(has.begin(), has.end(), isa) != has.end();
    if (there || std::find(has.begin(), has.end(), simd::Isa::sse4) == has.end()) continue;
    ++lacking;
    const std::string name(simd::name_of(isa));
    const Outcome run = run_with(name.c_str(), {"bake", "-o", "a.png", "--size", "8"}, folder);
    EXPECT_EQ(run.status, 3) << run.error;
    EXPECT_THAT(run.error, HasSubstr("this processor has no " + name));
  }
  if (lacking == 0) GTEST_SKIP() << "this processor has all of this program's instruction sets";
}

TEST(InstructionSets, WriteTheSameFile) {
  const Folder folder;
  for (const char* verb : {"render", "bake"}) {
    ASSERT_EQ(run_with("float", {verb, "-o", "float.png", "--size", "40x24"}, folder).status, 0);
    for (const simd::Isa isa : simd::available_isas()) {
      const std::string name(simd::name_of(isa));
      if (isa == simd::Isa::reference) continue; // in double: other roundings
      ASSERT_EQ(run_with(name.c_str(), {verb, "-o", "other.png", "--size", "40x24"}, folder).status, 0);
      EXPECT_TRUE(bytes_of(folder.path() / "float.png") == bytes_of(folder.path() / "other.png")) << name;
    }
  }
}

} // namespace
} // namespace surfgrad
