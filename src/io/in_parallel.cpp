#include "io/in_parallel.hpp"

#include "diagnostic/error.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cstddef>
#include <mutex>

namespace surfgrad::io {

std::vector<std::exception_ptr> run_in_parallel(const std::vector<std::function<void()>>& jobs,
                                                const Report& report) {
  std::vector<std::exception_ptr> errors(jobs.size());
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> first_failed{jobs.size()};
  std::atomic<bool> stopped{false};
  static std::mutex asking; // one for all: a job may have jobs of its own that ask
  const auto asked_to_stop = [&] {
    if (!report.progress) return false;
    const std::lock_guard one_at_a_time(asking);
    if (!stopped && !report.progress(0)) stopped = true;
    return stopped.load();
  };
  const auto run_next = [&](std::size_t) {
    const std::size_t i = next++;
    if (asked_to_stop() || i > first_failed) return;
    try {
      jobs[i]();
    } catch (...) {
      errors[i] = std::current_exception();
      std::size_t first = first_failed;
      while (i < first && !first_failed.compare_exchange_weak(first, i)) {
      }
    }
  };
  tbb::parallel_for(std::size_t{0}, jobs.size(), run_next, tbb::simple_partitioner());
  if (asked_to_stop()) throw Cancelled();
  return errors;
}

} // namespace surfgrad::io
