#pragma once

#include <vector>

namespace surfgrad::maps {

/// How slopes at texel centres are measured from heights. All are exact for planes.
enum class Kernel {
  central, ///< (h[i+1] - h[i-1]) / 2
  sobel,   ///< that, averaged over the neighbouring rows by 1 2 1
  scharr,  ///< that, averaged by 3 10 3: the same response in every direction to second order
  bspline, ///< slope of the cubic spline through the heights, which follows a sine of 1/4 texel^-1 within 5 %
};

/// A kernel as weights: for slopes along s, `difference` along rows and `smoothing` across them.
struct Weights {
  std::vector<double> difference; ///< w[n - 1] times h[i+n] - h[i-n]
  double centre = 1;              ///< of the row itself
  double side = 0;                ///< of each of the rows beside it
};

[[nodiscard]] Weights weights_of(Kernel kernel);

/// What a kernel makes of the wave exp(i (u x + v y)), u and v in radians a texel: i * response is its slope
/// along x. The truth is u. Of the two factors one depends on u alone, the other on v.
[[nodiscard]] double response_along(const Weights& weights, double u);
[[nodiscard]] double response_across(const Weights& weights, double v);
[[nodiscard]] inline double response(const Weights& weights, double u, double v) {
  return response_along(weights, u) * response_across(weights, v);
}

} // namespace surfgrad::maps
