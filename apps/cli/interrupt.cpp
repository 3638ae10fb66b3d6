#include "interrupt.hpp"

#include "diagnostic/error.hpp"

#include <atomic>
#include <csignal>
#include <cstdlib>

namespace surfgrad::cli {
namespace {

// Any thread may run the handler: atomics without a lock are what it may touch.
std::atomic<int> noted{0};
std::atomic<bool> unbroken{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

extern "C" void note_interrupt(int number) {
  if (noted.exchange(number) == 0 || unbroken) return;
  std::signal(number, SIG_DFL);
  std::raise(number); // takes effect when this handler returns
}

} // namespace

void note_interrupts() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(number, note_interrupt) == SIG_IGN) std::signal(number, SIG_IGN);
}

bool interrupted() noexcept { return noted != 0; }

void stop_if_interrupted() {
  if (interrupted()) throw Cancelled();
}

void end_by_interrupt() {
  const int number = noted;
  std::signal(number, SIG_DFL);
  std::raise(number);
  std::_Exit(128 + number); // the status a shell shows for the signal, should it be blocked
}

Unbroken::Unbroken() noexcept { unbroken = true; }
Unbroken::~Unbroken() { unbroken = false; }

} // namespace surfgrad::cli
