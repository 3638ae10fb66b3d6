#pragma once

#include <functional>
#include <string_view>

namespace surfgrad {

/// How a job talks to its caller. Libraries never print: they call these. Both may be empty.
struct Report {
  /// Fraction done in [0, 1]; returning false asks the job to stop (it then throws Cancelled).
  std::function<bool(double)> progress{};
  /// One line a warning: something was degenerate, clamped or ignored, and the job goes on.
  std::function<void(std::string_view)> warning{};

  /// For what a job does first: it can be asked to stop, and the fraction stays 0 for the job itself.
  [[nodiscard]] Report at_the_start() const {
    if (!progress) return *this;
    return {[ask = progress](double) { return ask(0); }, warning};
  }

  void warn(std::string_view text) const {
    if (warning) warning(text);
  }
};

} // namespace surfgrad
