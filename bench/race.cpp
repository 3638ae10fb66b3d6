#include "race.hpp"

#include <nlohmann/json.hpp>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string_view>
#include <thread>
#include <utility>

namespace surfgrad::bench {
namespace {

double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void print(const nlohmann::ordered_json& line) { std::cout << line.dump() << std::endl; }

nlohmann::ordered_json line_of(const char* kind, const Heat& heat) {
  return {{"kind", kind}, {"race", heat.race}, {"case", heat.title}, {"threads", heat.threads}};
}

void add_target(nlohmann::ordered_json& line, Target target) {
  line["target"] = target.value;
  line["at_most"] = target.at_most;
}

} // namespace

Time timed(const std::function<void()>& work) {
  const double cpu = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  const double wall = seconds_of(CLOCK_MONOTONIC);
  work();
  const double passed = seconds_of(CLOCK_MONOTONIC) - wall;
  // The system books a thread's time when it stops or at a tick: let the others of this process fall asleep.
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return {seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu, passed};
}

std::function<Time()> repeated(double seconds, std::function<void()> work) {
  return [seconds, work = std::move(work), count = 0]() mutable {
    if (count == 0)
      count = std::clamp(static_cast<int>(seconds / std::max(timed(work).wall, 1e-9)), 1, 1 << 20);
    const Time all = timed([&] {
      for (int i = 0; i < count; ++i) work();
    });
    return Time{all.cpu / count, all.wall / count};
  };
}

Request parse_request(int argc, char** argv) {
  Request request;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--quick") {
      request.quick = true;
      request.rounds = 3;
    } else if (word == "--threads" && i + 1 < argc) {
      request.threads = {std::max(1, std::atoi(argv[++i]))};
    } else {
      std::fprintf(stderr, "usage: %s [--quick] [--threads N]\n", argv[0]);
      std::exit(2);
    }
  }
  return request;
}

namespace {

/// All processors work for a while. One that idled is slow when it is wanted again: on a virtual machine a
/// first turn of 0.3 s took up to twice as long after some seconds of sleep, and no longer after as many of
/// any work. Threads of the contestant before, which still spin for a moment, have fallen asleep by then.
void wake_processors() {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
    threads.emplace_back([until] {
      while (std::chrono::steady_clock::now() < until) {
      }
    });
  for (std::thread& thread : threads) thread.join();
}

} // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

std::vector<Result> run_quietly(const Heat& heat, const std::vector<Contestant>& contestants) {
  std::vector<Result> results;
  for (const Contestant& c : contestants) {
    results.push_back({c.name, {}});
    (void)c.run();
  }
  for (int round = 0; round < heat.rounds; ++round)
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      wake_processors();
      results[i].rounds.push_back(contestants[i].run());
    }
  return results;
}

std::vector<Result> run(const Heat& heat, const std::vector<Contestant>& contestants) {
  std::vector<Result> results = run_quietly(heat, contestants);
  for (const Result& r : results) {
    std::vector<double> cpu;
    std::vector<double> wall;
    for (const Time& t : r.rounds) {
      cpu.push_back(1e9 * t.cpu / heat.items);
      wall.push_back(1e9 * t.wall / heat.items);
    }
    nlohmann::ordered_json line = line_of("time", heat);
    line["name"] = r.name;
    line["unit"] = heat.unit;
    line["items"] = heat.items;
    line["rounds"] = heat.rounds;
    line["cpu_ns"] = median(cpu);
    line["wall_ns"] = median(wall);
    line["least_cpu_ns"] = *std::min_element(cpu.begin(), cpu.end());
    line["most_cpu_ns"] = *std::max_element(cpu.begin(), cpu.end());
    print(line);
  }
  return results;
}

double times_faster(const Result& slow, const Result& fast, Clock clock) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(slow.rounds.size(), fast.rounds.size()); ++i)
    ratios.push_back(clock == Clock::cpu ? slow.rounds[i].cpu / fast.rounds[i].cpu
                                         : slow.rounds[i].wall / fast.rounds[i].wall);
  return median(ratios);
}

void report_ratio(const Heat& heat, const std::string& what, double value) {
  nlohmann::ordered_json line = line_of("ratio", heat);
  line["what"] = what;
  line["value"] = value;
  print(line);
}

void report_ratio(const Heat& heat, const std::string& what, double value, Target target) {
  nlohmann::ordered_json line = line_of("ratio", heat);
  line["what"] = what;
  line["value"] = value;
  add_target(line, target);
  print(line);
}

void report_value(const Heat& heat, const std::string& what, double value, const std::string& unit) {
  nlohmann::ordered_json line = line_of("value", heat);
  line["what"] = what;
  line["value"] = value;
  line["unit"] = unit;
  print(line);
}

void report_value(const Heat& heat, const std::string& what, double value, const std::string& unit,
                  Target target) {
  nlohmann::ordered_json line = line_of("value", heat);
  line["what"] = what;
  line["value"] = value;
  line["unit"] = unit;
  add_target(line, target);
  print(line);
}

double report_growth(const Heat& heat, const std::string& name, const std::vector<int>& x,
                     const std::vector<Result>& results) {
  std::vector<double> ns;
  for (const Result& r : results) {
    std::vector<double> rounds;
    for (const Time& t : r.rounds) rounds.push_back(1e9 * t.cpu / heat.items);
    ns.push_back(median(rounds));
  }
  const double n = static_cast<double>(x.size());
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += ns[i] / n;
  }
  double xy = 0;
  double xx = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean_x) * (ns[i] - mean_y);
    xx += (x[i] - mean_x) * (x[i] - mean_x);
  }
  const double slope = xx > 0 ? xy / xx : 0;
  nlohmann::ordered_json line = line_of("growth", heat);
  line["name"] = name;
  line["unit"] = heat.unit;
  line["x"] = x;
  line["ns"] = ns;
  line["one_more"] = slope;
  print(line);
  return slope;
}

void report_note(const std::string& race, const std::string& text) {
  print({{"kind", "note"}, {"race", race}, {"text", text}});
}

void report_absent(const std::string& race, const std::string& peer, const std::string& reason) {
  print({{"kind", "absent"}, {"race", race}, {"peer", peer}, {"reason", reason}});
}

void limited_to(int threads, const std::function<void()>& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute(work);
}

void on_threads(int threads, int count, int grain, const std::function<void(int, int)>& work) {
  limited_to(threads, [&] {
    tbb::parallel_for(tbb::blocked_range<int>(0, (count + grain - 1) / grain),
                      [&](const tbb::blocked_range<int>& blocks) {
                        for (int b = blocks.begin(); b < blocks.end(); ++b)
                          work(b * grain, std::min(count, (b + 1) * grain));
                      });
  });
}

} // namespace surfgrad::bench
