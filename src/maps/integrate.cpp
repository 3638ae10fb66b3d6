#include "maps/integrate.hpp"

#include "image/parallel.hpp"
#include "maps/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

namespace surfgrad::maps {
namespace {

using Complex = std::complex<double>;

/// What a kernel makes of the waves of an axis of n texels, by their number of periods.
struct Waves {
  Waves(Kernel kernel, int n) {
    for (int k = 0; k < n; ++k) {
      const double w = 2 * std::numbers::pi * (2 * k <= n ? k : k - n) / n;
      along.push_back(slope_along(kernel, w));
      square.push_back(w * w);
      across.push_back(share_across(kernel, w));
    }
  }
  std::vector<double> along{};
  std::vector<double> across{};
  std::vector<double> square{}; ///< of the true slopes
};

// Waves whose slopes a kernel all but hides, those of nearly half a period a texel, would be made of noise,
// and huge. Where it shows less than this share of them they fade, with the square of the share.
constexpr double least_share = 1.0 / 3;

/// What is left of a wave.
///
/// shown, steepness  squares of its slopes as a kernel shows them, and as they are
double fade(double shown, double steepness) {
  return std::min(1.0, shown / (least_share * least_share * steepness));
}

/// Turns the spectrum of ds + i dt into that of the heights, and tells of what it leaves out.
void divide_by_slopes(std::vector<float>& pairs, int width, int height, Kernel kernel, Integrated& result) {
  const Waves s(kernel, width);
  const Waves t(kernel, height);
  struct Sums {
    double all = 0;
    double left_out = 0;
  };
  std::vector<Sums> rows(static_cast<std::size_t>(height / 2 + 1));
  const auto at = [&](int k, int l) {
    return pairs.data() +
           2 * (static_cast<std::size_t>(l) * static_cast<std::size_t>(width) + static_cast<std::size_t>(k));
  };
  // A wave and its mirror image together: ds and dt are the spectrum's symmetric halves.
  image::in_parallel(rows.size(), static_cast<std::size_t>(width), [&](std::size_t row) {
    const int l = static_cast<int>(row);
    const int l_back = (height - l) % height;
    for (int k = 0; k < width; ++k) {
      const int k_back = (width - k) % width;
      if (l_back == l && k_back < k) continue; // done with its partner
      float* const here = at(k, l);
      float* const back = at(k_back, l_back);
      const Complex a(here[0], here[1]);
      const Complex b(back[0], -back[1]);
      const Complex p = 0.5 * (a + b);
      const Complex q = Complex(0, -0.5) * (a - b);
      const double along_s = s.along[static_cast<std::size_t>(k)] * t.across[static_cast<std::size_t>(l)];
      const double along_t = t.along[static_cast<std::size_t>(l)] * s.across[static_cast<std::size_t>(k)];
      const double square = along_s * along_s + along_t * along_t;
      Complex h = 0;
      if (k != 0 || l != 0) {
        // The sine of pi is no exact zero.
        if (square > 1e-12) {
          const double kept =
              fade(square, s.square[static_cast<std::size_t>(k)] + t.square[static_cast<std::size_t>(l)]);
          h = kept * Complex(0, -1) * (along_s * p + along_t * q) / square;
        }
        const double count = here == back ? 1 : 2;
        rows[row].all += count * (std::norm(p) + std::norm(q));
        rows[row].left_out +=
            count * (std::norm(p - Complex(0, along_s) * h) + std::norm(q - Complex(0, along_t) * h));
      }
      here[0] = static_cast<float>(h.real());
      here[1] = static_cast<float>(h.imag());
      back[0] = static_cast<float>(h.real());
      back[1] = static_cast<float>(-h.imag());
    }
  });
  Sums sums;
  for (const Sums& row : rows) {
    sums.all += row.all;
    sums.left_out += row.left_out;
  }
  result.not_integrable = sums.all > 0 ? std::sqrt(sums.left_out / sums.all) : 0;
}

Integrated integrate_repeated(image::Image slopes, Kernel kernel) {
  const int width = slopes.width;
  const int height = slopes.height;
  // Both slopes as one complex picture, in their place.
  std::vector<float>& pairs = slopes.texels.floats();
  fourier(pairs, width, height);
  Integrated result;
  const double texels = static_cast<double>(width) * height;
  result.tilt = {pairs[0] / texels, pairs[1] / texels};
  divide_by_slopes(pairs, width, height, kernel, result);
  inverse_fourier(pairs, width, height);
  result.heights = image::make_image(width, height, 1, image::Depth::float32);
  std::vector<float>& heights = result.heights.texels.floats();
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = pairs[2 * i];
  return result;
}

/// The height from the k-th texel to the next: the integral of the slopes between their centres.
///
/// slope(k)  of n texels of a line
template <class Slope>
double step(const Slope& slope, int k, int n) {
  const double near = slope(k) + slope(k + 1);
  if (n < 3) return near / 2;
  if (k == 0) return (5 * slope(0) + 8 * slope(1) - slope(2)) / 12;
  if (k == n - 2) return (5 * slope(n - 1) + 8 * slope(n - 2) - slope(n - 3)) / 12;
  return (13 * near - slope(k - 1) - slope(k + 2)) / 24;
}

/// Sums over the rows of a picture, the same whatever the number of threads.
struct Sums {
  double slopes = 0;
  double squares = 0;
  double left_out = 0;
};

Integrated integrate_clamped(image::Image slopes) {
  const int width = slopes.width;
  const int height = slopes.height;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  const float* const slope = slopes.texels.floats().data();
  const auto step_s = [&](int x, int y) {
    return step([&](int k) { return double{slope[2 * at(k, y)]}; }, x, width);
  };
  const auto step_t = [&](int x, int y) {
    return step([&](int k) { return double{slope[2 * at(x, k) + 1]}; }, y, height);
  };
  const auto for_rows = [&](const auto& body) {
    image::in_parallel(static_cast<std::size_t>(height), static_cast<std::size_t>(width),
                       [&](std::size_t y) { body(static_cast<int>(y)); });
  };
  // Steps into each texel less those out of it: minus the discrete Laplacian of the heights.
  Integrated result;
  result.heights = image::make_image(width, height, 1, image::Depth::float32);
  std::vector<float>& values = result.heights.texels.floats();
  for_rows([&](int y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      if (x > 0) sum += step_s(x - 1, y);
      if (x + 1 < width) sum -= step_s(x, y);
      if (y > 0) sum += step_t(x, y - 1);
      if (y + 1 < height) sum -= step_t(x, y);
      values[at(x, y)] = static_cast<float>(sum);
    }
  });
  cosine(values, width, height);
  const auto eigenvalues = [](int n) {
    std::vector<double> of_axis;
    for (int k = 0; k < n; ++k) of_axis.push_back(2 - 2 * std::cos(std::numbers::pi * k / n));
    return of_axis;
  };
  const std::vector<double> of_s = eigenvalues(width);
  const std::vector<double> of_t = eigenvalues(height);
  for_rows([&](int l) {
    for (int k = 0; k < width; ++k)
      if (k != 0 || l != 0)
        values[at(k, l)] = static_cast<float>(
            values[at(k, l)] / (of_s[static_cast<std::size_t>(k)] + of_t[static_cast<std::size_t>(l)]));
  });
  values[0] = 0;
  inverse_cosine(values, width, height);

  std::vector<std::array<Sums, 2>> rows(static_cast<std::size_t>(height));
  for_rows([&](int y) {
    const auto add = [](Sums& sums, double wanted, double made) {
      sums.slopes += wanted;
      sums.squares += wanted * wanted;
      sums.left_out += (wanted - made) * (wanted - made);
    };
    auto& [s, t] = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < width; ++x) {
      if (x + 1 < width) add(s, step_s(x, y), double{values[at(x + 1, y)]} - values[at(x, y)]);
      if (y + 1 < height) add(t, step_t(x, y), double{values[at(x, y + 1)]} - values[at(x, y)]);
    }
  });
  std::array<Sums, 2> sums{};
  for (const auto& row : rows)
    for (std::size_t axis = 0; axis < 2; ++axis) {
      sums[axis].slopes += row[axis].slopes;
      sums[axis].squares += row[axis].squares;
      sums[axis].left_out += row[axis].left_out;
    }
  const double steps_s = std::max(1.0, (width - 1.0) * height);
  const double steps_t = std::max(1.0, width * (height - 1.0));
  result.tilt = {sums[0].slopes / steps_s, sums[1].slopes / steps_t};
  const double all = sums[0].squares - steps_s * result.tilt.x * result.tilt.x + sums[1].squares -
                     steps_t * result.tilt.y * result.tilt.y;
  const double left_out = sums[0].left_out + sums[1].left_out;
  // A plane has nothing but its mean slope, up to rounding.
  const bool varies = all > 1e-12 * (sums[0].squares + sums[1].squares);
  result.not_integrable = varies ? std::sqrt(left_out / all) : 0;
  return result;
}

} // namespace

Integrated integrate(image::Image slopes, Kernel kernel, Border border) {
  return border == Border::repeat ? integrate_repeated(std::move(slopes), kernel)
                                  : integrate_clamped(std::move(slopes));
}

} // namespace surfgrad::maps
