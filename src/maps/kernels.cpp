#include "maps/kernels.hpp"

#include <cmath>

namespace surfgrad::maps {
namespace {

/// Through the coefficients c of the spline, h = (c[i-1] + 4 c[i] + c[i+1]) / 6 and h' = (c[i+1] - c[i-1]) /
/// 2: the inverse of the first has the pole z = sqrt(3) - 2 (Unser 1999, "Splines: a perfect fit"), so that
/// the weights fall off by z a texel.
std::vector<double> spline_differences() {
  const double z = std::sqrt(3.0) - 2;
  double weight = 0.5 * std::sqrt(3.0) * (1 - z * z);
  std::vector<double> weights;
  // What is left out is less than the rounding of a slope to float.
  for (; std::abs(weight) > 0x1p-31; weight *= z) weights.push_back(weight);
  // What is left out would make planes a little too flat.
  double slope = 0;
  for (std::size_t n = 1; n <= weights.size(); ++n) slope += 2 * static_cast<double>(n) * weights[n - 1];
  for (double& w : weights) w /= slope;
  return weights;
}

} // namespace

Weights weights_of(Kernel kernel) {
  switch (kernel) {
  case Kernel::central:
    break;
  case Kernel::sobel:
    return {{0.5}, 0.5, 0.25};
  case Kernel::scharr:
    return {{0.5}, 0.625, 0.1875};
  case Kernel::bspline:
    return {spline_differences(), 1, 0};
  }
  return {{0.5}, 1, 0};
}

double response_along(const Weights& weights, double u) {
  double sum = 0;
  for (std::size_t n = 1; n <= weights.difference.size(); ++n)
    sum += 2 * weights.difference[n - 1] * std::sin(static_cast<double>(n) * u);
  return sum;
}

double response_across(const Weights& weights, double v) {
  return weights.centre + 2 * weights.side * std::cos(v);
}

} // namespace surfgrad::maps
