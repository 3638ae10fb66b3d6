#pragma once

#include <CLI/CLI.hpp>

#include <cstddef>
#include <string>

namespace surfgrad::cli {

/// One of several runs of the same command that share its work between them, as the jobs of an array do.
class Shard {
 public:
  void add_option(CLI::App& verb);

  /// Whether this run does the job of that number. Each belongs to exactly one shard.
  [[nodiscard]] bool has(std::size_t job) const { return job % count_ == index_; }

 private:
  std::size_t index_ = 0;
  std::size_t count_ = 1;
};

} // namespace surfgrad::cli
