/// Race: three derived bases from three texture coordinates, three slopes, one sum, one resolve.
///
/// Peers   the same text on one lane of float at -O3, and the machine's memory.
/// Method  Structure-of-arrays floats, 27 read and 3 written for every pixel. In cache: one tile of 1024
///         pixels (120 KiB, the second-level cache) over and over, a tile for each thread. From memory:
///         arrays far larger than the caches, results stored past them. The limit is a kernel that reads and
///         writes the same arrays in the same order and adds what it reads.

#include "kernels.hpp"
#include "race.hpp"

#include <surfgrad/vec.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>

namespace surfgrad::bench {
namespace {

/// Planes of random surfaces.
class Pixels {
 public:
  explicit Pixels(int count) {
    // An odd number of cache lines between planes, or all of them would fall into the same sets.
    const std::size_t stride = static_cast<std::size_t>(count) + 16 * 3;
    const std::size_t bytes = sizeof(float) * stride * (planes_in + planes_out);
    memory_.reset(static_cast<float*>(std::aligned_alloc(64, (bytes + 63) / 64 * 64)));
    std::mt19937 random(20);
    std::uniform_real_distribution<float> slope(-1, 1);
    std::uniform_real_distribution<float> rate(0.5F, 1.5F);
    float* plane[planes_in + planes_out];
    for (std::size_t k = 0; k < planes_in + planes_out; ++k) plane[k] = memory_.get() + k * stride;
    for (int i = 0; i < count; ++i) {
      plane[0][i] = 0.2F * slope(random);
      plane[1][i] = 0.2F * slope(random);
      plane[2][i] = rate(random);
      for (int k = 3; k < planes_in; ++k) plane[k][i] = slope(random);
      for (const int k : {3, 7, 9, 12, 13, 16, 17, 20}) plane[k][i] = rate(random); // nothing collapses
    }
    for (int k = planes_in; k < planes_in + planes_out; ++k)
      std::memset(plane[k], 0, sizeof(float) * static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < planes_in; ++k) planes_.in[k] = plane[k];
    for (std::size_t k = 0; k < planes_out; ++k) planes_.out[k] = plane[planes_in + k];
  }
  [[nodiscard]] const Planes& planes() const { return planes_; }

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  std::unique_ptr<float, Free> memory_;
  Planes planes_;
};

using Kernel = void (*)(const Planes&, int, int, Stores);
Kernel compose_on(simd::Isa isa) { return SURFGRAD_FUNCTION_OF_ISA(isa, compose_planes); }
Kernel sum_on(simd::Isa isa) { return SURFGRAD_FUNCTION_OF_ISA(isa, sum_planes); }

/// Every instruction set of this machine, one lane first.
std::vector<simd::Isa> contestants() {
  std::vector<simd::Isa> isas{simd::Isa::one_lane};
  for (const simd::Isa isa : simd::available_isas())
    if (isa != simd::Isa::reference && isa != simd::Isa::one_lane && isa != simd::Isa::lanes)
      isas.push_back(isa);
  return isas;
}

void check_equal(const Pixels& pixels, int count) {
  compose_on(simd::Isa::one_lane)(pixels.planes(), 0, count, Stores::cached);
  std::vector<float> truth;
  for (const float* plane : pixels.planes().out) truth.insert(truth.end(), plane, plane + count);
  for (const simd::Isa isa : contestants()) {
    compose_on(isa)(pixels.planes(), 0, count, Stores::streaming);
    std::size_t differing = 0;
    for (std::size_t k = 0; k < planes_out; ++k)
      for (int i = 0; i < count; ++i) {
        const float a = truth[k * static_cast<std::size_t>(count) + static_cast<std::size_t>(i)];
        differing += std::memcmp(&a, pixels.planes().out[k] + i, sizeof a) != 0;
      }
    if (differing > 0)
      report_note("compose", fmt::format("{}: {} values differ from the one-lane float's", simd::name_of(isa),
                                         differing));
  }
}

void race_in_cache(const Request& request, int threads) {
  constexpr int tile = 1024;
  constexpr int repeats = 500; // far more than it takes to wake a thread
  std::vector<std::unique_ptr<Pixels>> tiles;
  for (int t = 0; t < threads; ++t) tiles.push_back(std::make_unique<Pixels>(tile));
  check_equal(*tiles[0], tile);
  const Heat heat{"compose", "3 layers, in cache", "pixel", double(tile) * repeats * threads,
                  threads,   request.rounds};
  std::vector<Contestant> all;
  for (const simd::Isa isa : contestants())
    all.push_back(
        {std::string(simd::name_of(isa)), repeated(request.seconds_a_run(), [&, kernel = compose_on(isa)] {
           on_threads(threads, threads, 1, [&](int t, int) {
             for (int r = 0; r < repeats; ++r)
               kernel(tiles[static_cast<std::size_t>(t)]->planes(), 0, tile, Stores::cached);
           });
         })});
  const std::vector<Result> results = run(heat, all);
  const Result& fastest = results.back();
  std::vector<double> ns;
  for (const Time& t : fastest.rounds) ns.push_back(1e9 * t.cpu / heat.items);
  report_ratio(heat, fastest.name + " over one lane", times_faster(results[0], fastest), {8});
  report_value(heat, fastest.name + ", a core", median(ns), "ns/pixel", {3, true});
}

void race_from_memory(const Request& request, const Pixels& pixels, int count, int threads) {
  const Heat heat{"compose", "3 layers, from memory", "pixel", double(count), threads, request.rounds};
  const simd::Isa fastest = simd::available_isas().back();
  const auto contestant = [&](std::string name, Kernel kernel, Stores stores) {
    return Contestant{std::move(name), repeated(request.seconds_a_run(), [&, kernel, stores] {
                        on_threads(threads, count, 1 << 16,
                                   [&](int begin, int end) { kernel(pixels.planes(), begin, end, stores); });
                      })};
  };
  const std::string isa(simd::name_of(fastest));
  const std::vector<Result> results =
      run(heat, {contestant("float, one lane", compose_on(simd::Isa::one_lane), Stores::cached),
                 contestant(isa, compose_on(fastest), Stores::streaming),
                 contestant("memory: the same streams summed", sum_on(fastest), Stores::streaming)});
  report_ratio(heat, isa + " over one lane", times_faster(results[0], results[1]));
  report_value(heat, isa + ", of the streaming bandwidth", 100 * times_faster(results[2], results[1]), "%",
               {85});
  std::vector<double> rate;
  for (const Time& t : results[2].rounds)
    rate.push_back(1e-9 * sizeof(float) * (planes_in + planes_out) * count / (t.cpu / threads));
  report_value(heat, "streaming bandwidth", median(rate), "GB/s");
}

void race(const Request& request) {
  for (const int threads : request.threads) race_in_cache(request, threads);
  const int count = 1 << (request.quick ? 20 : 21);
  const Pixels pixels(count);
  for (const int threads : request.threads) race_from_memory(request, pixels, count, threads);
}

} // namespace
} // namespace surfgrad::bench

int main(int argc, char** argv) { surfgrad::bench::race(surfgrad::bench::parse_request(argc, argv)); }
