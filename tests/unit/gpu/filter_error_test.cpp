/// The error of a map that is filtered at snapped coordinates and levels stays below its bound, and near it.

#include "gpu/filter_error.hpp"
#include "gpu/material_shaders.hpp"
#include "image/pyramid.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

using image::Filter;
using image::Wrap;
using image::Wraps;

// Coarse, so that what snapping does dwarfs all rounding.
constexpr gpu::FilterPrecision coarse{1.0 / 16, 1.0 / 8};

/// A level of a map at a coordinate that is off by so many texels of it.
template <int N>
std::array<double, N> off_by(const image::Map& map, vec2<double> st, int level, Wraps wraps,
                             vec2<double> texels) {
  const vec2<double> at{image::detail::folded(st.x, wraps.s) + texels.x / map.width(level),
                        image::detail::folded(st.y, wraps.t) + texels.y / map.height(level)};
  // A level alone: trilinear at a whole LOD.
  return image::sample<N>(map, at, static_cast<double>(level), wraps, Filter::trilinear, true);
}

/// As a device whose coordinates and level are off by all that the precision allows, either way.
template <int N>
std::array<double, N> snapped(const image::Map& map, vec2<double> st, double lod, Wraps wraps, Filter filter,
                              const gpu::FilterPrecision& precision, Random& random) {
  const auto off = [&] {
    return vec2<double>{random.sign() * precision.texel, random.sign() * precision.texel};
  };
  if (filter == Filter::bilinear) return off_by<N>(map, st, 0, wraps, off());
  const double most = map.level_count - 1;
  const double level = std::clamp(std::clamp(lod, 0.0, most) + random.sign() * precision.level, 0.0, most);
  const int low = std::min(static_cast<int>(level), map.level_count - 1);
  const vec2<double> away = off();
  const auto fine = off_by<N>(map, st, low, wraps, away);
  if (low + 1 == map.level_count) return fine;
  return image::detail::mix<N>(fine, off_by<N>(map, st, low + 1, wraps, away), level - low);
}

/// Errors of many random lookups in units of their bound.
template <int N>
double compare(const std::string& what, const image::Map& map, Wraps wraps, Filter filter) {
  const double bound = gpu::filter_error(map, wraps, filter, coarse);
  Random random(11);
  Worst worst(what);
  for (int i = 0; i < 20000; ++i) {
    // Half of the lookups lie near the borders.
    const vec2<double> st = i % 2 == 0
                                ? random.vector2(-2, 2)
                                : vec2<double>{random.uniform(-0.05, 0.05), random.uniform(0.95, 1.05)};
    const double lod = random.uniform(-1, map.level_count);
    const auto exact = image::sample<N>(map, st, lod, wraps, filter, true);
    const auto got = snapped<N>(map, st, lod, wraps, filter, coarse, random);
    double square = 0;
    for (std::size_t c = 0; c < N; ++c) square += (got[c] - exact[c]) * (got[c] - exact[c]);
    worst.add(std::sqrt(square), 0, bound, i);
  }
  return worst.ratio();
}

template <int N>
image::Map random_map(int width, int height, image::TexelFormat format) {
  Random random(5);
  std::vector<float> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * N);
  for (float& texel : texels) texel = static_cast<float>(random.uniform(0, 1));
  const image::TexelRows rows = image::rows_of(texels, width, N);
  image::TexelCode code{format, 1};
  if (format == image::TexelFormat::slope16) code = image::code_for_slopes(rows, width, height);
  if (format == image::TexelFormat::unorm16) code.scale = 1.0 / 65535;
  return image::with_pyramid(rows, width, height, N, code);
}

TEST(FilterErrors, StayBelowTheirBoundAndNearIt) {
  constexpr Wrap all[] = {Wrap::repeat, Wrap::mirror, Wrap::clamp};
  // Sides that halve evenly, that do not, and single rows; in each format.
  const image::Map slopes = random_map<2>(16, 8, image::TexelFormat::slope16);
  const image::Map weights = random_map<1>(37, 21, image::TexelFormat::unorm16);
  const image::Map row = random_map<2>(13, 1, image::TexelFormat::floats);
  for (const Wrap s : all)
    for (const Wrap t : all)
      for (const Filter filter : {Filter::bilinear, Filter::trilinear}) {
        // Random lookups seldom meet the worst cell and the worst level together, but come within half of it.
        EXPECT_GT(compare<2>("slope16", slopes, {s, t}, filter), 0.5);
        EXPECT_GT(compare<1>("unorm16", weights, {s, t}, filter), 0.5);
        EXPECT_GT(compare<2>("one row", row, {s, t}, filter), 0.5);
      }
}

TEST(FilterErrors, OfNearestTexelsAreRounding) {
  const image::Map map = random_map<2>(16, 8, image::TexelFormat::slope16);
  EXPECT_LE(gpu::filter_error(map, {}, Filter::nearest, coarse), map.scale);
}

TEST(FilterErrors, OfARampAreItsSlope) {
  std::vector<float> texels(32);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = 0.25f * static_cast<float>(i);
  const image::Map map = image::with_pyramid(image::rows_of(texels, 32, 1), 32, 1, 1);
  // Clamped: 1/4 a texel. Repeated: the step from the last texel to the first, 31/4.
  EXPECT_NEAR(gpu::filter_error(map, {Wrap::clamp, Wrap::clamp}, Filter::bilinear, coarse), 0.25 / 16, 1e-4);
  EXPECT_NEAR(gpu::filter_error(map, {}, Filter::bilinear, coarse), 31 * 0.25 / 16, 1e-3);
  EXPECT_NEAR(gpu::longest_texel(map), 31 * 0.25, 0);
}

TEST(FilterErrors, GoByWhatTheLimitsPromise) {
  VkPhysicalDeviceLimits limits{};
  limits.subTexelPrecisionBits = 8;
  limits.mipmapPrecisionBits = 4;
  EXPECT_EQ(gpu::filter_precision(limits).texel, 1.0 / 256);
  EXPECT_EQ(gpu::filter_precision(limits).level, 1.0 / 16);
}

} // namespace
} // namespace surfgrad::test
