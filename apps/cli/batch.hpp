#pragma once

#include "failure.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad::cli {

/// The same job for each of several inputs: where one fails the others are still done.
class Batch {
 public:
  /// things  what the inputs are, for the count of those that failed: "scenes"
  /// size    how many there are
  Batch(std::string things, std::size_t size) : things_(std::move(things)), size_(size) {}

  /// Runs the job of one input. Returns how it failed, which is kept, or nothing. Throws Cancelled and
  /// CLI::Error as the job does.
  std::optional<Failure> run(const std::string& input, const std::function<void()>& job);

  /// After the last one. Throws SomeFailed if any did.
  void finish() const;

 private:
  std::string things_;
  std::size_t size_;
  std::vector<Failure> failures_{};
};

/// Of a batch. The status is the worst of its failures, what() a line for each.
class SomeFailed : public std::runtime_error {
 public:
  SomeFailed(int status, std::vector<std::string> lines);
  [[nodiscard]] int status() const { return status_; }
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

 private:
  int status_;
  std::vector<std::string> lines_;
};

} // namespace surfgrad::cli
