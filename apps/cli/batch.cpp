#include "batch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace surfgrad::cli {

std::optional<Failure> Batch::run(const std::string& input, const std::function<void()>& job) {
  try {
    job();
    return {};
  } catch (...) {
    Failure failure = current_failure();
    // Of several inputs it must be said which one; a fault in the input itself says so already.
    if (size_ > 1 && !failure.what.starts_with(input)) failure.what = input + ": " + failure.what;
    failures_.push_back(failure);
    return failure;
  }
}

void Batch::finish() const {
  if (failures_.empty()) return;
  int status = 0;
  std::vector<std::string> lines;
  for (const Failure& failure : failures_) {
    status = std::max(status, failure.status);
    lines.push_back(failure.what);
  }
  if (size_ > 1) lines.push_back(fmt::format("{} of {} {} failed", failures_.size(), size_, things_));
  throw SomeFailed(status, std::move(lines));
}

SomeFailed::SomeFailed(int status, std::vector<std::string> lines)
    : std::runtime_error(fmt::format("{}", fmt::join(lines, "\n"))), status_(status),
      lines_(std::move(lines)) {}

} // namespace surfgrad::cli
