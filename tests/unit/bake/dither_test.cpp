// The mask of blue noise, and what is rounded by it.

#include "bake/dither.hpp"

#include "bake/blue_noise.hpp"
#include "stage/bands.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <vector>

namespace surfgrad::bake {
namespace {

constexpr int side = blue_noise_side;
constexpr int area = side * side;

TEST(BlueNoise, HoldsEveryRankOnce) {
  std::vector<int> ranks(blue_noise().begin(), blue_noise().end());
  std::sort(ranks.begin(), ranks.end());
  std::vector<int> all(area);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(ranks, all);
}

/// Power of a mask's values in (0, 1) at the frequencies below a share of the highest, over the mean of all,
/// and its largest single one over that mean.
struct Spectrum {
  double low, peak;
};
Spectrum spectrum_of(const std::vector<double>& values, double share) {
  using Complex = std::complex<double>;
  std::vector<Complex> turns;
  for (int i = 0; i < side; ++i) turns.push_back(std::polar(1.0, 2 * std::numbers::pi * i / side));
  std::vector<Complex> rows(area), all(area);
  for (int y = 0; y < side; ++y)
    for (int u = 0; u < side; ++u)
      for (int x = 0; x < side; ++x) rows[y * side + u] += (values[y * side + x] - 0.5) * turns[u * x % side];
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u)
      for (int y = 0; y < side; ++y) all[v * side + u] += rows[y * side + u] * turns[v * y % side];
  double low = 0, sum = 0, peak = 0;
  int lows = 0;
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {
      if (u == 0 && v == 0) continue;
      const double frequency =
          std::hypot(u < side / 2 ? u : u - side, v < side / 2 ? v : v - side) / (side / 2);
      const double power = std::norm(all[v * side + u]);
      sum += power;
      peak = std::max(peak, power);
      if (frequency > share) continue;
      low += power;
      ++lows;
    }
  const double mean = sum / (area - 1);
  return {low / lows / mean, peak / mean};
}

TEST(BlueNoise, HasNextToNoLowFrequenciesAndNoPeak) {
  std::vector<double> mask, r2, gradient, white;
  surfgrad::test::Random random(1);
  const auto fraction = [](double v) { return v - std::floor(v); };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      mask.push_back((blue_noise()[static_cast<std::size_t>(y * side + x)] + 0.5) / area);
      r2.push_back(fraction(0.7548776662466927 * x + 0.5698402909980532 * y));
      gradient.push_back(fraction(52.9829189 * fraction(0.06711056 * x + 0.00583715 * y)));
      white.push_back(random.uniform(0, 1));
    }
  const auto print = [](const char* name, const Spectrum& s) {
    std::printf("  %s: power below a quarter of the highest frequency %.4f of the mean, peak %.1f of it\n",
                name, s.low, s.peak);
    return s;
  };
  const Spectrum own = print("void and cluster", spectrum_of(mask, 0.25));
  print("R2 sequence", spectrum_of(r2, 0.25));
  print("interleaved gradient", spectrum_of(gradient, 0.25));
  const Spectrum chance = print("white noise", spectrum_of(white, 0.25));
  EXPECT_LT(own.low, 0.02 * chance.low);
  // Power of noise is spread exponentially: the largest of n frequencies is about ln n means. Those of the
  // mask crowd in a ring that is at least a third of all.
  EXPECT_LT(own.peak, 3 * std::log(area));
}

/// One value everywhere, dithered in bands.
image::Image dithered(std::vector<float> value, int width, int height) {
  image::Image map = image::make_image(width, height, static_cast<int>(value.size()), image::Depth::float32);
  for (std::size_t i = 0; i < map.texels.size(); ++i) map.texels[i] = value[i % value.size()];
  image::Image result = map;
  Dither dither(height, {0.5f, 0.5f, 1.0f}, stage::into(result));
  for (int top = height; top > 0;) {
    image::Image band;
    stage::reshape(band, width, std::min(top, 23), 3);
    top -= band.height;
    stage::copy_values(map, top, band.height, band.texels.floats().data());
    dither.add(band);
  }
  return result;
}

TEST(Dither, GivesCodesWhoseMeanIsTheValue) {
  surfgrad::test::Random random(1711);
  for (int k = 0; k < 50; ++k) {
    const std::vector<float> value{static_cast<float>(random.uniform(0, 1)),
                                   static_cast<float>(random.uniform(0, 1)),
                                   static_cast<float>(random.uniform(0, 1))};
    const image::Image got = dithered(value, side, side);
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
          const double code = 255.0 * got.at(x, y, c);
          EXPECT_NEAR(code, std::round(code), 1e-4); // a float of code / 255
          EXPECT_LE(std::abs(code - 255.0 * value[static_cast<std::size_t>(c)]), 1.0001);
          sum += code;
        }
      // One threshold of 4096 is the step of the mean; float products may put it on the wrong side of one.
      EXPECT_NEAR(sum / area, 255.0 * value[static_cast<std::size_t>(c)], 1.01 / area) << c;
    }
  }
}

TEST(Dither, LeavesFlatTexelsAndTheEndsOfTheRangeAlone) {
  for (const auto& [value, code] :
       {std::pair<std::vector<float>, std::vector<float>>{{0.5f, 0.5f, 1}, {128, 128, 255}},
        {{0, 1, 1}, {0, 255, 255}},
        {{-1, 2, NAN}, {0, 255, 0}}}) {
    const image::Image got = dithered(value, 70, 70);
    for (std::size_t i = 0; i < got.texels.size(); ++i) ASSERT_EQ(got.texels[i], code[i % 3] / 255) << i;
  }
}

TEST(Dither, RepeatsItselfOverTheMapAndNotInTheChannels) {
  const float half_way = 102.5f / 255;
  const image::Image got = dithered({half_way, half_way, half_way}, 2 * side, side + 10);
  for (int c = 0; c < 3; ++c) {
    int equal = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        ASSERT_EQ(got.at(x, y, c), got.at(x + side, y, c));
        equal += got.at(x, y, c) == got.at(x, y, (c + 1) % 3) ? 1 : 0;
      }
    EXPECT_NEAR(equal, area / 2, area / 10) << c; // independent halves agree half the time
  }
}

} // namespace
} // namespace surfgrad::bake
