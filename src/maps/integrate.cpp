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

Integrated integrate_repeated(image::Image slopes, Kernel kernel) {
  const int width = slopes.width;
  const int height = slopes.height;
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  // Both slopes as one complex picture: their spectra are its symmetric halves.
  std::vector<Complex> spectrum(at(0, height));
  const float* const values = slopes.texels.floats().data();
  for (std::size_t i = 0; i < spectrum.size(); ++i) spectrum[i] = {values[2 * i], values[2 * i + 1]};
  slopes = {};
  fourier(spectrum, width, height);
  Integrated result;
  const double texels = static_cast<double>(width) * height;
  result.tilt = {spectrum[0].real() / texels, spectrum[0].imag() / texels};
  double all = 0;
  double left_out = 0;
  const Waves s(kernel, width);
  const Waves t(kernel, height);
  for (int l = 0; l < height; ++l) {
    for (int k = 0; k < width; ++k) {
      const int k_back = (width - k) % width;
      const int l_back = (height - l) % height;
      if (at(k_back, l_back) < at(k, l)) continue; // done with its partner
      const Complex a = spectrum[at(k, l)];
      const Complex b = std::conj(spectrum[at(k_back, l_back)]);
      const Complex p = 0.5 * (a + b);
      const Complex q = Complex(0, -0.5) * (a - b);
      const double along_s = s.along[static_cast<std::size_t>(k)] * t.across[static_cast<std::size_t>(l)];
      const double along_t = t.along[static_cast<std::size_t>(l)] * s.across[static_cast<std::size_t>(k)];
      const double square = along_s * along_s + along_t * along_t;
      const double share = std::norm(p) + std::norm(q);
      const double count = at(k_back, l_back) == at(k, l) ? 1 : 2;
      Complex h = 0;
      if (k != 0 || l != 0) {
        // The sine of pi is no exact zero.
        if (square > 1e-12) {
          const double kept =
              fade(square, s.square[static_cast<std::size_t>(k)] + t.square[static_cast<std::size_t>(l)]);
          h = kept * Complex(0, -1) * (along_s * p + along_t * q) / square;
        }
        all += count * share;
        left_out += count * (std::norm(p - Complex(0, along_s) * h) + std::norm(q - Complex(0, along_t) * h));
      }
      spectrum[at(k, l)] = h;
      spectrum[at(k_back, l_back)] = std::conj(h);
    }
  }
  result.not_integrable = all > 0 ? std::sqrt(left_out / all) : 0;
  inverse_fourier(spectrum, width, height);
  result.heights = image::make_image(width, height, 1, image::Depth::float32);
  std::transform(spectrum.begin(), spectrum.end(), result.heights.texels.floats().begin(),
                 [](const Complex& h) { return static_cast<float>(h.real()); });
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
  std::vector<double> values(at(0, height));
  for_rows([&](int y) {
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      if (x > 0) sum += step_s(x - 1, y);
      if (x + 1 < width) sum -= step_s(x, y);
      if (y > 0) sum += step_t(x, y - 1);
      if (y + 1 < height) sum -= step_t(x, y);
      values[at(x, y)] = sum;
    }
  });
  cosine(values, width, height);
  const auto eigenvalues = [](int n) {
    std::vector<double> result;
    for (int k = 0; k < n; ++k) result.push_back(2 - 2 * std::cos(std::numbers::pi * k / n));
    return result;
  };
  const std::vector<double> of_s = eigenvalues(width);
  const std::vector<double> of_t = eigenvalues(height);
  for_rows([&](int l) {
    for (int k = 0; k < width; ++k)
      if (k != 0 || l != 0)
        values[at(k, l)] /= of_s[static_cast<std::size_t>(k)] + of_t[static_cast<std::size_t>(l)];
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
      if (x + 1 < width) add(s, step_s(x, y), values[at(x + 1, y)] - values[at(x, y)]);
      if (y + 1 < height) add(t, step_t(x, y), values[at(x, y + 1)] - values[at(x, y)]);
    }
  });
  std::array<Sums, 2> sums{};
  for (const auto& row : rows)
    for (std::size_t axis = 0; axis < 2; ++axis) {
      sums[axis].slopes += row[axis].slopes;
      sums[axis].squares += row[axis].squares;
      sums[axis].left_out += row[axis].left_out;
    }
  Integrated result;
  const double steps_s = std::max(1.0, (width - 1.0) * height);
  const double steps_t = std::max(1.0, width * (height - 1.0));
  result.tilt = {sums[0].slopes / steps_s, sums[1].slopes / steps_t};
  const double all = sums[0].squares - steps_s * result.tilt.x * result.tilt.x + sums[1].squares -
                     steps_t * result.tilt.y * result.tilt.y;
  const double left_out = sums[0].left_out + sums[1].left_out;
  // A plane has nothing but its mean slope, up to rounding.
  const bool varies = all > 1e-12 * (sums[0].squares + sums[1].squares);
  result.not_integrable = varies ? std::sqrt(left_out / all) : 0;
  result.heights = image::make_image(width, height, 1, image::Depth::float32);
  std::transform(values.begin(), values.end(), result.heights.texels.floats().begin(),
                 [](double h) { return static_cast<float>(h); });
  return result;
}

} // namespace

Integrated integrate(image::Image slopes, Kernel kernel, Border border) {
  return border == Border::repeat ? integrate_repeated(std::move(slopes), kernel)
                                  : integrate_clamped(std::move(slopes));
}

} // namespace surfgrad::maps
