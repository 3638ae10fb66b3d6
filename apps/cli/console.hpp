#pragma once

#include "diagnostic/report.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace surfgrad::cli {

/// A line on standard error. Where that cannot be written there is nobody left to tell: ignored.
void complain(std::string_view text) noexcept;

/// What the program says while it works: a progress bar on a terminal, warnings, a summary.
/// Everything but the summary goes to standard error.
class Console {
 public:
  Console(std::string job, bool quiet);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Callbacks for a job, which stop it after an interrupt. They refer to this console.
  [[nodiscard]] Report report();
  void warn(std::string_view text);
  /// A line on standard output, unless quiet. Throws MachineError where it cannot be written.
  void say(std::string_view text);
  /// A summary for machines as one line, quiet or not; bytes that are not UTF-8 become U+FFFD.
  /// Throws MachineError where it cannot be written.
  void say_json(const nlohmann::json& summary);

 private:
  void show(double fraction);
  void clear();

  std::string job_;
  bool quiet_;
  bool bar_;       // standard error is a terminal and may be drawn on
  int shown_ = -1; // percent on the screen, -1 for none
};

} // namespace surfgrad::cli
