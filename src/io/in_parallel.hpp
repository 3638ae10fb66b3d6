#pragma once

#include "diagnostic/report.hpp"

#include <exception>
#include <functional>
#include <vector>

namespace surfgrad::io {

/// Runs the jobs, e.g. the decoding of files, on all threads. Returns what each threw, or null.
///
/// Jobs begin in their order. After one failed, later ones may be left out, and their errors stay null:
/// whoever goes through the errors in order meets the one that tells the truth first, always the same.
/// Progress is asked between jobs, by one thread at a time, with the fraction 0. Throws Cancelled.
[[nodiscard]] std::vector<std::exception_ptr> run_in_parallel(const std::vector<std::function<void()>>& jobs,
                                                              const Report& report);

} // namespace surfgrad::io
