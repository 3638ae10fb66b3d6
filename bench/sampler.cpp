/// Race: a million lookups in a 2048x2048 normal map, two components each.
///
/// Peers   OpenImageIO's TextureSystem, and a scalar sampler without tricks (naive_sampler.hpp).
/// Method  The same slopes and the same lookups for everyone, coordinates and results in arrays. Coherent: a
///         raster a texel apart, turned by 30 degrees; random: anywhere. Results are compared first. Levels
///         lie close to 0.5, so that every trilinear lookup reads two.
///         Anisotropic lookups are 8 times as long as wide; OpenImageIO weights its probes otherwise than the
///         others, and its results differ by that. Decoding and mip levels are not timed.

#include "kernels.hpp"
#include "lookups.hpp"
#include "naive_sampler.hpp"
#include "race.hpp"
#include "scene/demo_maps.hpp"
#include "slope_pyramid.hpp"
#if SURFGRAD_BENCH_OIIO
#include "oiio_sampler.hpp"
#endif

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>

namespace surfgrad::bench {
namespace {

constexpr int map_size = 2048;
/// Lookups that one thread takes at a time.
constexpr int grain = 4096;

/// The same map with codes of 8 bits.
image::Image in_eight_bits(image::Image map) {
  for (float& code : map.texels.floats()) code = std::floor(code * 255 + 0.5F) / 255;
  map.depth = image::Depth::unorm8;
  return map;
}

LookupList coherent_lookups(int side) {
  LookupList list;
  const float step = std::sqrt(2.0F) / map_size; // a texel between the two levels
  const float c = std::cos(0.5235988F);
  const float s = std::sin(0.5235988F);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const float u = step * static_cast<float>(x);
      const float v = step * static_cast<float>(y);
      list.add(0.37F + c * u - s * v, 0.11F + s * u + c * v,
               0.3F + 0.4F * static_cast<float>(x) / static_cast<float>(side), map_size);
    }
  return list;
}

LookupList random_lookups(int count) {
  LookupList list;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> anywhere(0, 1);
  for (int i = 0; i < count; ++i) {
    const float at_s = anywhere(random);
    const float at_t = anywhere(random);
    list.add(at_s, at_t, 0.3F + 0.4F * anywhere(random), map_size);
  }
  return list;
}

using Kernel = void (*)(const image::Map&, const Lookups&, image::Filter, int, int);
Kernel sampler_on(simd::Isa isa) { return SURFGRAD_FUNCTION_OF_ISA(isa, sample_map); }

using AnisotropicKernel = void (*)(const image::Map&, const Lookups&, int, int, int);
AnisotropicKernel anisotropic_on(simd::Isa isa) { return SURFGRAD_FUNCTION_OF_ISA(isa, sample_anisotropic); }

/// Someone who takes lookups [begin, end).
struct Sampler {
  std::string name;
  std::function<void(Filtering, const LookupList&, int begin, int end, Samples&)> sample;
  bool reads_another_map = false; ///< finer codes: results differ
};

Sampler ours(const std::string& name, const image::Map& map, simd::Isa isa) {
  return {name, [&map, kernel = sampler_on(isa), anisotropic = anisotropic_on(isa)](
                    Filtering filtering, const LookupList& list, int begin, int end, Samples& results) {
            const Lookups lookups{list.s.data(),     list.t.data(),        list.lod.data(),
                                  list.width.data(), results.first.data(), results.second.data()};
            if (filtering == Filtering::anisotropic)
              anisotropic(map, lookups, anisotropy, begin, end);
            else
              kernel(map, lookups,
                     filtering == Filtering::bilinear ? image::Filter::bilinear : image::Filter::trilinear,
                     begin, end);
          }};
}

Sampler naive(const SlopePyramid& map) {
  return {"naive scalar sampler", [sampler = NaiveSampler(map)](Filtering filtering, const LookupList& list,
                                                                int begin, int end, Samples& results) {
            const auto each = [&](const auto& look_up) {
              for (std::size_t i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
                const vec2<float> v = look_up(list.s[i], list.t[i], list.lod[i]);
                results.first[i] = v.x;
                results.second[i] = v.y;
              }
            };
            if (filtering == Filtering::bilinear)
              each([&](float s, float t, float) { return sampler.bilinear(s, t); });
            else if (filtering == Filtering::trilinear)
              each([&](float s, float t, float lod) { return sampler.trilinear(s, t, lod); });
            else
              each([&](float s, float t, float lod) { return sampler.anisotropic(s, t, lod); });
          }};
}

using Gather = void (*)(Words, const WordPairs&, int, int);
Gather gather_on(simd::Isa isa) { return SURFGRAD_FUNCTION_OF_ISA(isa, gather_pairs); }

/// What bounds ours: the same words of the same map at indices known before.
class GatherLimit {
 public:
  GatherLimit(simd::Isa isa, const image::Map& map, const LookupList& list, Filtering filtering)
      : kernel_(gather_on(isa)), words_(map.texels()), sums_(list.s.size()) {
    pairs_.count = filtering == Filtering::trilinear ? 4 : 2;
    pairs_.sums = sums_.data();
    for (std::size_t k = 0; k < static_cast<std::size_t>(pairs_.count); ++k) {
      const int level = static_cast<int>(k) / 2;
      const auto texel = [&](float s, int size) {
        const int i = static_cast<int>(std::floor((s - std::floor(s)) * static_cast<float>(size) - 0.5F));
        return i < 0 ? size - 1 : i;
      };
      for (std::size_t i = 0; i < list.s.size(); ++i)
        at_[k].push_back(static_cast<std::int32_t>(map.word(level, texel(list.s[i], map.width(level)),
                                                            texel(list.t[i], map.height(level)) + (k & 1U))));
      pairs_.at[k] = at_[k].data();
    }
  }
  void run(int begin, int end) const { kernel_(words_, pairs_, begin, end); }

 private:
  Gather kernel_;
  Words words_;
  std::vector<std::int32_t> at_[4];
  std::vector<float> sums_;
  WordPairs pairs_;
};

const char* name_of(Filtering filtering) {
  return filtering == Filtering::bilinear    ? "bilinear"
         : filtering == Filtering::trilinear ? "trilinear"
                                             : "anisotropic 8:1";
}

void compare(const std::string& title, Filtering filtering, const LookupList& list,
             const std::vector<Sampler>& samplers) {
  const int count = static_cast<int>(list.s.size());
  Samples truth(list.s.size());
  samplers[0].sample(filtering, list, 0, count, truth);
  std::string text = title + ": largest difference from the naive sampler";
  for (std::size_t k = 1; k < samplers.size(); ++k) {
    if (samplers[k].reads_another_map) continue;
    Samples results(list.s.size());
    samplers[k].sample(filtering, list, 0, count, results);
    float worst = 0;
    for (std::size_t i = 0; i < list.s.size(); ++i)
      worst = std::max({worst, std::abs(results.first[i] - truth.first[i]),
                        std::abs(results.second[i] - truth.second[i])});
    text += fmt::format("{} {} {:.1e}", k == 1 ? ":" : ",", samplers[k].name, worst);
  }
  report_note("sampler", text);
}

/// The first is the naive one, the second ours.
void race(const Request& request, int threads, Filtering filtering, const char* order, const LookupList& list,
          const std::vector<Sampler>& samplers, const image::Map& map) {
  const int count = static_cast<int>(list.s.size());
  const Heat heat{"sampler", fmt::format("{}, {}", name_of(filtering), order),
                  "lookup",  double(count),
                  threads,   request.rounds};
  if (threads == request.threads[0]) compare(heat.title, filtering, list, samplers);
  Samples results(list.s.size());
  std::vector<Contestant> contestants;
  for (const Sampler& s : samplers)
    contestants.push_back({s.name, repeated(request.seconds_a_run(), [&, threads, filtering] {
                             on_threads(threads, count, grain, [&](int begin, int end) {
                               s.sample(filtering, list, begin, end, results);
                             });
                           })});
  const GatherLimit limit(simd::available_isas().back(), map, list, filtering);
  if (filtering != Filtering::anisotropic && map.format == image::TexelFormat::slope16)
    contestants.push_back({"limit: the gathers alone", repeated(request.seconds_a_run(), [&, threads] {
                             on_threads(threads, count, grain,
                                        [&](int begin, int end) { limit.run(begin, end); });
                           })});
  const std::vector<Result> r = run(heat, contestants);
  const bool judged = filtering == Filtering::trilinear && threads == 1;
  if (r.size() > samplers.size())
    report_value(heat, r[1].name + ", of what the gathers alone allow", 100 * times_faster(r.back(), r[1]),
                 "%");
  for (std::size_t k = 0; k < samplers.size(); ++k) {
    if (samplers[k].name.starts_with("surfgrad")) continue;
    const double factor = times_faster(r[k], r[1]);
    const std::string what = r[1].name + " over " + r[k].name;
    if (judged)
      report_ratio(heat, what, factor, {k == 0 ? 3.0 : 15.0});
    else
      report_ratio(heat, what, factor);
  }
}

void race(const Request& request) {
  const image::Image deep = scene::plates_normal_map(map_size);
  const image::Image flat = in_eight_bits(deep);
  const SlopePyramid pyramid = make_slope_pyramid(flat);
  const image::SlopeMap map8 = image::make_slope_map(flat, image::NormalChannels::xyz, true);
  const image::SlopeMap map16 = image::make_slope_map(deep, image::NormalChannels::xyz, true);
  const std::vector<simd::Isa> isas = simd::available_isas();
  const std::string fastest(simd::name_of(isas.back()));
  std::vector<Sampler> samplers{naive(pyramid),
                                ours("surfgrad " + fastest + ", 8-bit map", map8.map, isas.back()),
                                ours("surfgrad " + fastest + ", 16-bit map", map16.map, isas.back()),
                                ours("surfgrad one lane, 8-bit map", map8.map, simd::Isa::one_lane)};
  samplers[2].reads_another_map = true;
  for (const simd::Isa isa : isas)
    if (isa == simd::Isa::avx2 && isa != isas.back())
      samplers.push_back(ours("surfgrad avx2, 8-bit map", map8.map, isa));
#if SURFGRAD_BENCH_OIIO
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("surfgrad_bench_{}", std::random_device{}());
  std::filesystem::create_directories(folder);
  const OiioSampler oiio(pyramid, folder);
  samplers.push_back({"OpenImageIO " + OiioSampler::version(),
                      [&](Filtering filtering, const LookupList& list, int begin, int end, Samples& results) {
                        oiio.sample(filtering, list, begin, end, results);
                      }});
#else
  report_absent("sampler", "OpenImageIO", "not found when the races were built");
#endif
  const int side = request.quick ? 256 : 1024;
  const LookupList coherent = coherent_lookups(side);
  const LookupList random = random_lookups(side * side);
  for (const int threads : request.threads)
    for (const Filtering filtering : {Filtering::bilinear, Filtering::trilinear, Filtering::anisotropic}) {
      race(request, threads, filtering, "coherent", coherent, samplers, map8.map);
      race(request, threads, filtering, "random", random, samplers, map8.map);
    }
#if SURFGRAD_BENCH_OIIO
  std::filesystem::remove_all(folder);
#endif
}

} // namespace
} // namespace surfgrad::bench

int main(int argc, char** argv) { surfgrad::bench::race(surfgrad::bench::parse_request(argc, argv)); }
