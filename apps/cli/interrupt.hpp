#pragma once

namespace surfgrad::cli {

/// From here on an interrupt (SIGINT, SIGTERM, SIGHUP) is only noted, so that the program can end in
/// an orderly way; a second one ends it at once, unless a file is being written. Signals that are
/// ignored (nohup, background jobs) stay ignored.
void note_interrupts();

[[nodiscard]] bool interrupted() noexcept;

/// Throws Cancelled after an interrupt.
void stop_if_interrupted();

/// Ends the program by the signal that was noted, so that whoever started it sees why.
[[noreturn]] void end_by_interrupt();

/// While one lives, a second interrupt waits: temporary files do not stay behind.
class Unbroken {
 public:
  Unbroken() noexcept;
  ~Unbroken();
  Unbroken(const Unbroken&) = delete;
  Unbroken& operator=(const Unbroken&) = delete;
};

} // namespace surfgrad::cli
