// Parallel rows: all of them, with progress that ends at 1 and can stop the job.

#include "engine/rows.hpp"

#include "diagnostic/error.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace surfgrad::engine {
namespace {

TEST(Rows, RunEachOnceAndReportUpToOne) {
  for (const std::size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    for (int repeat = 0; repeat < 50; ++repeat) {
      std::vector<std::atomic<int>> runs(97);
      std::vector<double> reported;
      Report report;
      report.progress = [&](double part) { // never called by two threads at once
        reported.push_back(part);
        return true;
      };
      for_each_row(97, report, [&](int row) { ++runs[static_cast<std::size_t>(row)]; });
      for (const auto& count : runs) EXPECT_EQ(count, 1);
      ASSERT_FALSE(reported.empty());
      EXPECT_EQ(reported.back(), 1);
      for (std::size_t i = 1; i < reported.size(); ++i) EXPECT_GE(reported[i], reported[i - 1]);
    }
  }
}

TEST(Rows, StopWhenTheCallbackAsksTo) {
  std::atomic<int> runs{0};
  Report report;
  report.progress = [](double) { return false; };
  EXPECT_THROW(for_each_row(100000, report, [&](int) { ++runs; }), Cancelled);
  EXPECT_LT(runs, 100000);
  EXPECT_THROW(for_each_row(1, report, [](int) {}), Cancelled);
}

TEST(Rows, PassOnWhatARowThrows) {
  EXPECT_THROW(for_each_row(10, {},
                            [](int row) {
                              if (row == 7) throw std::out_of_range("row");
                            }),
               std::out_of_range);
}

TEST(Rows, WithoutACallbackRunAllTheSame) {
  std::atomic<int> runs{0};
  for_each_row(10, {}, [&](int) { ++runs; });
  EXPECT_EQ(runs, 10);
}

} // namespace
} // namespace surfgrad::engine
