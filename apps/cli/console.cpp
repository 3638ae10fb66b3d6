#include "console.hpp"

#include "diagnostic/error.hpp"
#include "interrupt.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace surfgrad::cli {
namespace {

/// Errors are ignored: standard error may be closed or full, and the job matters more.
void put_on_stderr(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void put_line_on_stdout(std::string line) {
  line += '\n';
  if (std::fwrite(line.data(), 1, line.size(), stdout) != line.size() || std::fflush(stdout) != 0)
    throw MachineError(
        fmt::format("standard output: cannot write the summary: {}", std::generic_category().message(errno)));
}

} // namespace

void complain(std::string_view text) noexcept {
  put_on_stderr("surfgrad: ");
  put_on_stderr(text);
  put_on_stderr("\n");
}

Console::Console(std::string job, bool quiet)
    : job_(std::move(job)), quiet_(quiet), bar_(!quiet && isatty(STDERR_FILENO) == 1) {}

Console::~Console() { clear(); }

Report Console::report() {
  return {[this](double fraction) {
            show(fraction);
            return !interrupted();
          },
          [this](std::string_view text) { warn(text); }};
}

void Console::warn(std::string_view text) {
  if (quiet_) return;
  clear();
  complain(fmt::format("warning: {}", text));
}

void Console::say(std::string_view text) {
  clear();
  if (!quiet_) put_line_on_stdout(std::string(text));
}

void Console::say_json(const nlohmann::json& summary) {
  clear();
  // File names may hold any bytes; compact, without indentation.
  put_line_on_stdout(summary.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void Console::show(double fraction) {
  const int percent = static_cast<int>(100 * fraction);
  if (!bar_ || percent <= shown_) return; // rows finish out of order: the bar never runs back
  shown_ = percent;
  constexpr int width = 40;
  const int filled = percent * width / 100;
  put_on_stderr(fmt::format("\r{} [{:=<{}}{: <{}}] {:3}%", job_, "", filled, "", width - filled, percent));
}

void Console::clear() {
  if (shown_ < 0) return;
  put_on_stderr("\r\x1b[K");
  shown_ = -1;
}

} // namespace surfgrad::cli
