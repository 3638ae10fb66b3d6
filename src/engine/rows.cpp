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
    const int finished = ++done;
    if (!report.progress) return;
    // Whoever finds the callback busy leaves the report to a later row.
    const std::unique_lock<std::mutex> lock(reporting, std::try_to_lock);
    if (lock && !report.progress(static_cast<double>(finished) / count)) stop = true;
  });
  if (stop) throw Cancelled();
}

} // namespace surfgrad::engine
