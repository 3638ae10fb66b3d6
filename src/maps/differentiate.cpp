#include "maps/differentiate.hpp"

#include "maps/lines.hpp"

#include <surfgrad/derivative.hpp>

#include <cmath>
#include <vector>

namespace surfgrad::maps {
namespace {

using Block = LineBlock<double>;

/// The pole of the filter that finds the spline's coefficients: z + 1/z = -4.
/// source  Unser 1999, "Splines: a perfect fit for signal and image processing", box 2
const double pole = std::sqrt(3.0) - 2;

/// Terms of its response that a double can see: |pole|^30 < 2^-56.
constexpr std::size_t horizon = 30;

/// Coefficients of the periodic cubic spline through the values: a causal and an anticausal filter.
void to_periodic_coefficients(Block& v) {
  const std::size_t n = v.length();
  for (std::size_t l = 0; l < lanes; ++l) {
    double first = 0;
    double power = 1;
    for (std::size_t k = 0; k < horizon; ++k, power *= pole) first += power * v[(n - k % n) % n][l];
    v[0][l] = first;
  }
  for (std::size_t k = 1; k < n; ++k)
    for (std::size_t l = 0; l < lanes; ++l) v[k][l] += pole * v[k - 1][l];
  for (std::size_t l = 0; l < lanes; ++l) {
    double last = 0;
    double power = -pole;
    for (std::size_t k = 0; k < horizon; ++k, power *= pole) last += power * v[(n - 1 + k) % n][l];
    v[n - 1][l] = last;
  }
  for (std::size_t k = n - 1; k-- > 0;)
    for (std::size_t l = 0; l < lanes; ++l) v[k][l] = pole * (v[k + 1][l] - v[k][l]);
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t l = 0; l < lanes; ++l) v[k][l] *= 6;
}

/// Coefficients of the natural cubic spline, which bends no more at its ends: c[k-1] + 4 c[k] + c[k+1] = 6
/// v[k], the first and the last coefficients are the values. Gaussian elimination.
void to_natural_coefficients(Block& v) {
  const std::size_t n = v.length();
  if (n < 3) return;
  std::vector<double> upper(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double pivot = 4 - upper[k - 1];
    upper[k] = 1 / pivot;
    for (std::size_t l = 0; l < lanes; ++l) v[k][l] = (6 * v[k][l] - v[k - 1][l]) / pivot;
  }
  for (std::size_t k = n - 2; k > 0; --k)
    for (std::size_t l = 0; l < lanes; ++l) v[k][l] -= upper[k] * v[k + 1][l];
}

/// Half the difference of both neighbours.
void differences(const Block& v, Border border, double scale, Block& slopes) {
  const std::size_t n = v.length();
  const double half = 0.5 * scale;
  for (std::size_t k = 0; k < n; ++k) {
    const bool inside = k > 0 && k + 1 < n;
    const std::size_t before = k > 0 ? k - 1 : border == Border::repeat ? n - 1 : 0;
    const std::size_t after = k + 1 < n ? k + 1 : border == Border::repeat ? 0 : n - 1;
    // Where the border draws the last slope out, the difference of two texels is all of it.
    const double factor = inside || border == Border::repeat ? half : scale;
    for (std::size_t l = 0; l < lanes; ++l) slopes[k][l] = factor * (v[after][l] - v[before][l]);
  }
}

/// Means of three neighbours, of which the middle one has this weight.
void smooth(Border border, double middle, const Block& v, Block& result) {
  const std::size_t n = v.length();
  const double side = 0.5 * (1 - middle);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = k > 0 ? k - 1 : border == Border::repeat ? n - 1 : 0;
    const std::size_t after = k + 1 < n ? k + 1 : border == Border::repeat ? 0 : n - 1;
    for (std::size_t l = 0; l < lanes; ++l)
      result[k][l] = middle * v[k][l] + side * (v[before][l] + v[after][l]);
  }
}

/// What a kernel does across its slope: the weight of the middle one of three; 1 for nothing.
double middle_weight(Kernel kernel) {
  if (kernel == Kernel::sobel) return 0.5;
  if (kernel == Kernel::scharr) return 0.625;
  return 1;
}

/// Along an axis, into every other value of `slopes`.
void differentiate(image::Image& heights, Axis axis, Kernel kernel, Border border, double scale,
                   float* slopes) {
  const Lines from = lines_of(heights.width, heights.height, axis);
  const Lines to = lines_of(heights.width, heights.height, axis, 2);
  const float* const values = heights.texels.floats().data();
  for_blocks_of_lines(from, [&](std::size_t first, std::size_t count) {
    Block block(from.length);
    Block result(from.length);
    load(from, values, first, count, block);
    if (kernel == Kernel::bspline && from.length > 1)
      border == Border::repeat ? to_periodic_coefficients(block) : to_natural_coefficients(block);
    differences(block, border, scale, result);
    store(to, result, first, count, slopes);
  });
  if (middle_weight(kernel) == 1) return;
  const Lines across = lines_of(heights.width, heights.height, axis == Axis::s ? Axis::t : Axis::s, 2);
  for_blocks_of_lines(across, [&](std::size_t first, std::size_t count) {
    Block block(across.length);
    Block result(across.length);
    load(across, slopes, first, count, block);
    smooth(border, middle_weight(kernel), block, result);
    store(across, result, first, count, slopes);
  });
}

} // namespace

double slope_along(Kernel kernel, double w) {
  return std::sin(w) * (kernel == Kernel::bspline ? 3 / (2 + std::cos(w)) : 1);
}

double share_across(Kernel kernel, double v) {
  const double middle = middle_weight(kernel);
  return middle + (1 - middle) * std::cos(v);
}

image::Image slopes_of_heights(image::Image heights, Kernel kernel, Border border, double scale) {
  image::Image slopes = image::make_image(heights.width, heights.height, 2, image::Depth::float32);
  float* const values = slopes.texels.floats().data();
  differentiate(heights, Axis::s, kernel, border, scale, values);
  differentiate(heights, Axis::t, kernel, border, scale, values + 1);
  const auto width = static_cast<std::size_t>(slopes.width);
  image::in_parallel(static_cast<std::size_t>(slopes.height), width, [&](std::size_t y) {
    for (float* slope = values + 2 * y * width; slope != values + 2 * (y + 1) * width; slope += 2) {
      const float steepest = max_abs(vec2<float>{slope[0], slope[1]});
      if (!(steepest > static_cast<float>(max_slope))) continue;
      slope[0] *= static_cast<float>(max_slope) / steepest;
      slope[1] *= static_cast<float>(max_slope) / steepest;
    }
  });
  return slopes;
}

} // namespace surfgrad::maps
