#pragma once

/// How every race is run: contestants take turns, so that whatever else the machine does strikes all of
/// them; a figure is the median of the rounds. Results are printed as JSON, one object a line.

#include <functional>
#include <string>
#include <vector>

namespace surfgrad::bench {

/// Seconds of one run: processor time of all threads of the process, and time on the wall.
struct Time {
  double cpu = 0;
  double wall = 0;
};

/// Runs the work and takes its time. No other thread of the process must be at work.
[[nodiscard]] Time timed(const std::function<void()>& work);

/// A run for a contestant: the work over and over, as often as takes this many seconds the first time, and
/// the time of one.
[[nodiscard]] std::function<Time()> repeated(double seconds, std::function<void()> work);

/// What a program of this folder was asked for: [--quick] [--threads N].
struct Request {
  bool quick = false;             ///< small sizes and few rounds: does it run, not how fast
  std::vector<int> threads{1, 2}; ///< thread counts to race with
  int rounds = 7;

  /// A run of a small kernel takes this long: the processor clock of threads ticks in milliseconds.
  [[nodiscard]] double seconds_a_run() const { return quick ? 0.02 : 0.15; }
};
[[nodiscard]] Request parse_request(int argc, char** argv);

struct Contestant {
  std::string name{};
  std::function<Time()> run{};
};

/// One comparison: every contestant does the same work.
struct Heat {
  std::string race{};  ///< e.g. `sampler`
  std::string title{}; ///< e.g. `trilinear, coherent`
  std::string unit{};  ///< what one item is, e.g. `pixel`
  double items = 1;    ///< in one run
  int threads = 1;
  int rounds = 7;
};

/// The rounds of one contestant, in order.
struct Result {
  std::string name{};
  std::vector<Time> rounds{};
};

/// Runs every contestant once unrecorded, then `rounds` times in turn.
[[nodiscard]] std::vector<Result> run_quietly(const Heat& heat, const std::vector<Contestant>& contestants);
/// The same, and prints a `time` line for each.
std::vector<Result> run(const Heat& heat, const std::vector<Contestant>& contestants);

[[nodiscard]] double median(std::vector<double> values);

enum class Clock { cpu, wall };

/// Median over the rounds of how much longer `slow` took than `fast`.
[[nodiscard]] double times_faster(const Result& slow, const Result& fast, Clock clock = Clock::cpu);

/// A bound that a figure should keep.
struct Target {
  double value = 0;
  bool at_most = false; ///< else at least
};

/// Prints a `ratio` line: `value` is a factor.
void report_ratio(const Heat& heat, const std::string& what, double value);
void report_ratio(const Heat& heat, const std::string& what, double value, Target target);
/// Prints a `value` line: anything with a unit.
void report_value(const Heat& heat, const std::string& what, double value, const std::string& unit);
void report_value(const Heat& heat, const std::string& what, double value, const std::string& unit,
                  Target target);
/// Prints a `growth` line: what the runs of a heat cost, one for each number in `x`.
///
/// heat  its title says what x counts; the numbers are nanoseconds of processor time an item
/// Returns the cost of one more: the slope of the line closest to the figures.
double report_growth(const Heat& heat, const std::string& name, const std::vector<int>& x,
                     const std::vector<Result>& results);
/// Prints a `note` line.
void report_note(const std::string& race, const std::string& text);
/// Prints an `absent` line: a peer that could not take part.
void report_absent(const std::string& race, const std::string& peer, const std::string& reason);

/// Runs the work with at most this many threads.
void limited_to(int threads, const std::function<void()>& work);

/// Calls work(begin, end) on `threads` threads that share [0, count) in blocks of `grain`.
void on_threads(int threads, int count, int grain, const std::function<void(int, int)>& work);

} // namespace surfgrad::bench
