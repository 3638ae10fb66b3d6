#pragma once

#include "diagnostic/report.hpp"

#include <string>
#include <string_view>

namespace surfgrad::cli {

/// What the program says while it works: a progress bar on a terminal, warnings, a summary.
/// Everything but the summary goes to standard error.
class Console {
 public:
  Console(std::string job, bool quiet);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Callbacks for a job. They refer to this console.
  [[nodiscard]] Report report();
  void warn(std::string_view text);
  /// A line on standard output, unless quiet.
  void say(std::string_view text);

 private:
  void show(double fraction);
  void clear();

  std::string job_;
  bool quiet_;
  bool bar_;       // standard error is a terminal and may be drawn on
  int shown_ = -1; // percent on the screen, -1 for none
};

} // namespace surfgrad::cli
