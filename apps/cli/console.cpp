#include "console.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>

namespace surfgrad::cli {

Console::Console(std::string job, bool quiet)
    : job_(std::move(job)), quiet_(quiet), bar_(!quiet && isatty(STDERR_FILENO) == 1) {}

Console::~Console() { clear(); }

Report Console::report() {
  return {[this](double fraction) {
            show(fraction);
            return true;
          },
          [this](std::string_view text) { warn(text); }};
}

void Console::warn(std::string_view text) {
  if (quiet_) return;
  clear();
  fmt::print(stderr, "surfgrad: warning: {}\n", text);
}

void Console::say(std::string_view text) {
  clear();
  if (!quiet_) fmt::print("{}\n", text);
}

void Console::show(double fraction) {
  const int percent = static_cast<int>(100 * fraction);
  if (!bar_ || percent <= shown_) return; // rows finish out of order: the bar never runs back
  shown_ = percent;
  constexpr int width = 40;
  const int filled = percent * width / 100;
  fmt::print(stderr, "\r{} [{:=<{}}{: <{}}] {:3}%", job_, "", filled, "", width - filled, percent);
  std::fflush(stderr);
}

void Console::clear() {
  if (shown_ < 0) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  shown_ = -1;
}

} // namespace surfgrad::cli
