#include "engine/rows.hpp"

#include "diagnostic/error.hpp"

#include <tbb/parallel_for.h>

#include <atomic>
#include <mutex>

namespace surfgrad::engine {

void for_each_row(int count, const Report& report, const std::function<void(int)>& work) {
  std::atomic<int> done{0};
  std::atomic<bool> stop{false};
  std::mutex reporting;
  tbb::parallel_for(0, count, [&](int row) {
    if (stop) return;
    work(row);
    ++done;
    if (!report.progress) return;
    // Whoever finds the callback busy leaves the report to a later row, the last row to the end.
    const std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
    const int finished = done; // read inside the lock: reports never go back
    if (lock && finished < count && !report.progress(static_cast<double>(finished) / count)) stop = true;
  });
  if (!stop && report.progress && !report.progress(1)) stop = true;
  if (stop) throw Cancelled();
}

} // namespace surfgrad::engine
