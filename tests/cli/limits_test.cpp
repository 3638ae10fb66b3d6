// More than the machine has, and numbers that are none: told in one line before the work starts.

#include "cli/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sched.h>
#include <sys/resource.h>

#include <cstddef>
#include <string>
#include <vector>

namespace surfgrad {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// What the program says where it may run on one core alone.
Outcome run_on_one_core(const std::vector<std::string>& arguments, const Folder& folder) {
  cpu_set_t before, one;
  EXPECT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  CPU_ZERO(&one);
  for (std::size_t core = 0; core < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++core)
    if (CPU_ISSET(core, &before)) CPU_SET(core, &one);
  EXPECT_EQ(sched_setaffinity(0, sizeof one, &one), 0); // the program inherits it
  const Outcome run = run_program(arguments, folder.path());
  EXPECT_EQ(sched_setaffinity(0, sizeof before, &before), 0);
  return run;
}

TEST(Limits, ThreadsAreFromOneToAsManyAsTheProcessMayUse) {
  const Folder folder;
  for (const char* verb : {"render", "bake", "displace", "gallery"})
    for (const char* threads : {"0", "-1", "2", "1000000000000", "1.5", "two", "1x", ""}) {
      // The scene does not exist: threads are looked at first.
      const Outcome run = run_on_one_core({verb, "-o", "none/a", "--threads", threads}, folder);
      EXPECT_EQ(run.status, 2) << verb << ' ' << threads << run.error;
      EXPECT_THAT(run.error, testing::StartsWith("--threads: "));
      EXPECT_THAT(run.error, HasSubstr("is not a number of threads that this process may use; use 1, or"));
    }
  EXPECT_EQ(run_on_one_core({"bake", "-o", "a.png", "--size", "8", "--threads", "1"}, folder).status, 0);
}

TEST(Limits, SizesThatNoPictureHasAreRefusedWithThoseThatAre) {
  const Folder folder;
  for (const char* verb : {"render", "bake", "gallery"})
    for (const char* size : {"0", "-5", "16385", "100000x100000", "8x0", "8x-8", "8x", "x8", "8x8x8", "1e3",
                             "8.5", "+8", " 8", "0x10", "99999999999999999999", "", "big"}) {
      const Outcome run = run_program({verb, "-o", "none/a", "--size", size}, folder.path());
      EXPECT_EQ(run.status, 2) << verb << ' ' << size << run.error;
      EXPECT_THAT(run.error, testing::StartsWith("--size: "));
      EXPECT_THAT(run.error, HasSubstr("use N or WIDTHxHEIGHT, each from 1 to 16384"));
    }
}

TEST(Limits, PicturesBeyondTheMachinesMemoryAreRefusedBeforeTheWork) {
  // The limit is this program's own for as long as it takes to start the other.
  if (*SURFGRAD_SANITIZED) GTEST_SKIP() << "the sanitizers' own memory is more than the limit";
  const Folder folder;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  const auto run_in = [&](rlim_t bytes, const std::vector<std::string>& arguments) {
    const rlimit little{bytes, before.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_AS, &little), 0); // the program inherits it
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(setrlimit(RLIMIT_AS, &before), 0);
    return run;
  };
  constexpr rlim_t gibibyte = rlim_t{1} << 30;
  // Its pictures are kept whole; others are written while they are made.
  const Outcome run = run_in(gibibyte, {"gallery", "-o", "pictures", "--size", "16000x8000"});
  EXPECT_EQ(run.status, 3) << run.error;
  EXPECT_THAT(run.error, HasSubstr("--size 16000x8000: the picture alone takes 1.9 GiB of memory"));
  EXPECT_THAT(run.error, HasSubstr("there are 1.0 GiB; try 11585x5792"));
  EXPECT_THAT(folder.files(), IsEmpty());
}

} // namespace
} // namespace surfgrad
