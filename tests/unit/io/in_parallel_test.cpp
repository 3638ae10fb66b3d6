// Jobs on all threads whose first error, in their order, is always the same.

#include "diagnostic/error.hpp"
#include "io/in_parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace surfgrad::io {
namespace {

TEST(InParallel, EveryJobIsDoneOnce) {
  std::vector<std::atomic<int>> done(100);
  std::vector<std::function<void()>> jobs;
  for (std::atomic<int>& one : done) jobs.emplace_back([&one] { ++one; });
  const auto errors = run_in_parallel(jobs, {});
  EXPECT_EQ(errors.size(), 100u);
  EXPECT_TRUE(std::all_of(errors.begin(), errors.end(), [](const auto& error) { return !error; }));
  EXPECT_TRUE(std::all_of(done.begin(), done.end(), [](const auto& one) { return one == 1; }));
  EXPECT_TRUE(run_in_parallel({}, {}).empty());
}

TEST(InParallel, JobsBeforeTheFirstErrorAreAlwaysDone) {
  std::atomic<int> done{0};
  std::vector<std::function<void()>> jobs;
  for (int i = 0; i < 50; ++i)
    jobs.emplace_back([&done, i] {
      // The first that fails does so last.
      if (i == 20) std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (i >= 20) throw InputError({.file = std::to_string(i)});
      ++done;
    });
  const auto errors = run_in_parallel(jobs, {});
  EXPECT_EQ(done, 20);
  EXPECT_TRUE(std::none_of(errors.begin(), errors.begin() + 20, [](const auto& error) { return !!error; }));
  EXPECT_TRUE(errors[20]);
}

TEST(InParallel, NoJobBeginsOnceToldToStop) {
  int done = 0;
  Report report;
  report.progress = [&](double) { return false; };
  EXPECT_THROW((void)run_in_parallel({[&] { ++done; }, [&] { ++done; }}, report), Cancelled);
  EXPECT_EQ(done, 0);
}

} // namespace
} // namespace surfgrad::io
