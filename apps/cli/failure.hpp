#pragma once

#include <string>

namespace surfgrad::cli {

// Exit statuses, the same for every verb.
inline constexpr int input_is_wrong = 1;
inline constexpr int usage_is_wrong = 2;
inline constexpr int machine_lacks_something = 3;

/// What the user is told of an exception.
struct Failure {
  int status;
  std::string what; ///< one line
};

/// Of the exception that is being handled. Those that end the program whatever it is doing pass through:
/// Cancelled, and CLI::Error about the command line.
[[nodiscard]] Failure current_failure();

} // namespace surfgrad::cli
