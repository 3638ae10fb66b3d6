#pragma once

#include "diagnostic/report.hpp"

#include <functional>

namespace surfgrad::engine {

/// Runs work(row) for every row in [0, count), in parallel and in no particular order, and reports
/// the fraction done. Rows must not depend on each other: results are the same for any number of
/// threads. Throws Cancelled when the progress callback asks to stop.
void for_each_row(int count, const Report& report, const std::function<void(int)>& work);

} // namespace surfgrad::engine
