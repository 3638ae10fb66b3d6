#pragma once

#include <optional>
#include <string>
#include <vector>

namespace surfgrad::bench {

/// A program that answers commands line by line.
class ChildProcess {
 public:
  /// words   program and arguments
  /// prefix  of the lines of its output that are answers; others are dropped
  ChildProcess(const std::vector<std::string>& words, std::string prefix);
  ~ChildProcess(); ///< closes its input and waits for it
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void tell(const std::string& line);
  /// The rest of the next answer; nothing when the program has ended.
  [[nodiscard]] std::optional<std::string> answer();

 private:
  std::string prefix_;
  int pid_ = -1;
  int to_ = -1;
  int from_ = -1;
  std::string read_;
};

} // namespace surfgrad::bench
