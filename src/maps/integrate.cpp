#include "maps/integrate.hpp"

#include "diagnostic/error.hpp"
#include "image/parallel.hpp"
#include "maps/lines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace surfgrad::maps {
namespace {

using image::Image;

constexpr double pi = std::numbers::pi;

/// Tells of the parts of the work, and stops between them where asked to.
class Parts {
 public:
  Parts(const Report& report, int count) : report_(report), count_(count) {}
  void done() {
    if (report_.progress && !report_.progress(static_cast<double>(++done_) / count_)) throw Cancelled();
  }

 private:
  const Report& report_;
  int count_;
  int done_ = 0;
};

/// What a kernel does to the frequencies of an axis.
struct Axis {
  std::vector<double> frequency, along, across; ///< in radians a texel; of a kernel

  Axis(const Weights& weights, std::size_t length) {
    for (std::size_t k = 0; k < length; ++k) {
      const double turns = static_cast<double>(k) / static_cast<double>(length);
      frequency.push_back(2 * pi * (turns > 0.5 ? turns - 1 : turns));
      along.push_back(response_along(weights, frequency.back()));
      across.push_back(response_across(weights, frequency.back()));
    }
  }
};

// Waves of which a kernel sees less than this part are left out of the heights. Slopes that it did not make,
// or that were rounded, would come out multiplied by more than its inverse.
constexpr double least_seen = 1.0 / 32;

/// Turns the spectrum of ds + i dt into that of the heights: of all h the one for which |i D h - d|^2 is
/// least, D being the kernel's response.
void divide_by_response(float* spectrum, std::size_t width, std::size_t height,
                        const Integration& integration) {
  const Weights weights = weights_of(integration.kernel);
  const Axis s(weights, width);
  const Axis t(weights, height);
  const vec2<double> texels_a_unit{1 / integration.texel.x, 1 / integration.texel.y};
  const auto number = [&](std::size_t x, std::size_t y) { return spectrum + 2 * (y * width + x); };
  // A frequency and its negative together: ds and dt are real pictures, whose numbers at the two are
  // conjugate.
  image::in_parallel(height / 2 + 1, width, [&](std::size_t y) {
    const std::size_t opposite_y = (height - y) % height;
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t opposite_x = (width - x) % width;
      if (opposite_y == y && opposite_x < x) continue;
      float* const here = number(x, y);
      float* const there = number(opposite_x, opposite_y);
      const Complex z{here[0], here[1]};
      const Complex mirrored{there[0], -there[1]};
      const Complex ds = 0.5 * (z + mirrored);
      const Complex i_dt = 0.5 * (z - mirrored);
      const Complex dt{i_dt.imag(), -i_dt.real()};
      const vec2<double> seen =
          texels_a_unit * vec2<double>{s.along[x] * t.across[y], t.along[y] * s.across[x]};
      const vec2<double> there_is = texels_a_unit * vec2<double>{s.frequency[x], t.frequency[y]};
      const double squared = dot(seen, seen);
      const bool is_seen = squared > least_seen * least_seen * dot(there_is, there_is);
      const Complex sum = seen.x * ds + seen.y * dt;
      const Complex h = is_seen ? Complex{sum.imag() / squared, -sum.real() / squared} : Complex{};
      here[0] = static_cast<float>(h.real());
      here[1] = static_cast<float>(h.imag());
      there[0] = static_cast<float>(h.real());
      there[1] = static_cast<float>(-h.imag());
    }
  });
}

Image integrate_wrapped(Image slopes, const Integration& integration, const Report& report) {
  const auto width = static_cast<std::size_t>(slopes.width);
  const auto height = static_cast<std::size_t>(slopes.height);
  float* const values = slopes.texels.floats().data();
  const auto forward = [](Fourier& fourier, Complex* line) { fourier.transform(line); };
  const auto backward = [](Fourier& fourier, Complex* line) { fourier.inverse(line); };
  Parts parts(report, 5);
  each_complex_row<Fourier>(values, width, height, forward);
  parts.done();
  each_column_pair<Fourier>(values, 2 * width, height, forward);
  parts.done();
  divide_by_response(values, width, height, integration);
  parts.done();
  each_column_pair<Fourier>(values, 2 * width, height, backward);
  parts.done();
  Image heights = image::make_image(slopes.width, slopes.height, 1, image::Depth::float32);
  float* const result = heights.texels.floats().data();
  each_complex_row<Fourier>(values, width, height, backward);
  for (std::size_t i = 0; i < width * height; ++i) result[i] = values[2 * i];
  parts.done();
  return heights;
}

/// The rise from each place of a line to the next one, in `rise`, of slopes with this distance in memory.
void rises(const float* slopes, std::size_t distance, std::size_t count, double texel,
           std::vector<double>& rise) {
  const auto slope = [&](std::size_t i) { return static_cast<double>(slopes[i * distance]); };
  rise.resize(count); // the last one is not used
  if (count < 2) return;
  if (count == 2) {
    rise[0] = 0.5 * texel * (slope(0) + slope(1));
    return;
  }
  rise[0] = texel / 12 * (5 * slope(0) + 8 * slope(1) - slope(2));
  rise[count - 2] = texel / 12 * (5 * slope(count - 1) + 8 * slope(count - 2) - slope(count - 3));
  for (std::size_t i = 1; i + 2 < count; ++i)
    rise[i] = texel / 24 * (13 * (slope(i) + slope(i + 1)) - slope(i - 1) - slope(i + 2));
}

/// The right side of the Poisson equation: what flows out of each texel, along both axes by `weight`.
Image divergence(const Image& slopes, vec2<double> texel, vec2<double> weight) {
  const auto width = static_cast<std::size_t>(slopes.width);
  const auto height = static_cast<std::size_t>(slopes.height);
  Image result = image::make_image(slopes.width, slopes.height, 1, image::Depth::float32);
  std::vector<float> scratch(slopes.texels.size());
  const float* const values = slopes.texels.read(0, scratch.size(), scratch.data());
  float* const sums = result.texels.floats().data();
  image::in_parallel(height, width, [&](std::size_t y) {
    thread_local std::vector<double> rise;
    rises(values + 2 * y * width, 2, width, texel.x, rise);
    for (std::size_t x = 0; x < width; ++x)
      sums[y * width + x] =
          static_cast<float>(weight.x * ((x + 1 < width ? rise[x] : 0.0) - (x > 0 ? rise[x - 1] : 0.0)));
  });
  image::in_parallel(width, 8 * height, [&](std::size_t x) {
    thread_local std::vector<double> rise;
    rises(values + 2 * x + 1, 2 * width, height, texel.y, rise);
    for (std::size_t y = 0; y < height; ++y)
      sums[y * width + x] = static_cast<float>(
          sums[y * width + x] + weight.y * ((y + 1 < height ? rise[y] : 0.0) - (y > 0 ? rise[y - 1] : 0.0)));
  });
  return result;
}

Image integrate_clamped(Image slopes, const Integration& integration, const Report& report) {
  Parts parts(report, 6);
  // Rises are compared as slopes: along the longer side of a texel the same error of the height counts less.
  const vec2<double> weight{1 / (integration.texel.x * integration.texel.x),
                            1 / (integration.texel.y * integration.texel.y)};
  Image heights = divergence(slopes, integration.texel, weight);
  slopes = {};
  parts.done();
  const auto width = static_cast<std::size_t>(heights.width);
  const auto height = static_cast<std::size_t>(heights.height);
  float* const values = heights.texels.floats().data();
  const auto forward = [](Cosine& cosine, Complex* line) { cosine.transform(line); };
  const auto backward = [](Cosine& cosine, Complex* line) { cosine.inverse(line); };
  each_row_pair<Cosine>(values, width, height, forward);
  parts.done();
  each_column_pair<Cosine>(values, width, height, forward);
  parts.done();
  // The Laplacian of cosines.
  const auto laplacian = [](std::size_t k, std::size_t count) {
    const double half = std::sin(0.5 * pi * static_cast<double>(k) / static_cast<double>(count));
    return -4 * half * half;
  };
  image::in_parallel(height, width, [&](std::size_t y) {
    const double along_t = weight.y * laplacian(y, height);
    for (std::size_t x = 0; x < width; ++x) {
      const double both = weight.x * laplacian(x, width) + along_t;
      float& value = values[y * width + x];
      value = x == 0 && y == 0 ? 0.0f : static_cast<float>(value / both);
    }
  });
  parts.done();
  each_column_pair<Cosine>(values, width, height, backward);
  parts.done();
  each_row_pair<Cosine>(values, width, height, backward);
  parts.done();
  return heights;
}

} // namespace

Image heights_of_slopes(Image slopes, const Integration& integration, const Report& report) {
  return integration.borders == Borders::wrap ? integrate_wrapped(std::move(slopes), integration, report)
                                              : integrate_clamped(std::move(slopes), integration, report);
}

} // namespace surfgrad::maps
