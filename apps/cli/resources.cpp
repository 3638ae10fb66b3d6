#include "resources.hpp"

#include <tbb/info.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace surfgrad::cli {

int usable_cores() { return std::max(1, tbb::info::default_concurrency()); }

std::uint64_t usable_memory() {
  std::uint64_t most =
      static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    most = std::min<std::uint64_t>(most, limit.rlim_cur);
  // A number, or the word "max", which is not read; absent where there are no such groups.
  std::uint64_t container = 0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> container) most = std::min(most, container);
  return most;
}

} // namespace surfgrad::cli
