#pragma once

/// Comparison of a function's claimed gradient with the one that its values define.

#include <surfgrad/noise.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <random>

namespace surfgrad::test {

struct GradientCheck {
  int samples = 0;
  int kinks = 0; ///< samples left out: a kink lies within a step
  double largest_gradient = 0;
  double worst_error = 0;     ///< largest component of the difference
  vec3<double> worst_point{}; ///< where

  [[nodiscard]] double relative_error() const { return worst_error / largest_gradient; }
  [[nodiscard]] double kink_share() const { return static_cast<double>(kinks) / samples; }
};

/// Random points on a grid of 2^-30, so that adding a step of a power of two is exact.
class PointSource {
 public:
  PointSource(std::uint64_t seed, double extent) : engine_(seed), coordinate_(-extent, extent) {}
  vec3<double> operator()() {
    const auto snapped = [this] { return std::ldexp(std::round(std::ldexp(coordinate_(engine_), 30)), -30); };
    const double x = snapped();
    const double y = snapped();
    return {x, y, snapped()};
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> coordinate_;
};

/// Truth is the Richardson extrapolation of central differences of the values: its error is
/// O(step^4) where the function is smooth. A kink within a step shows as second differences that do
/// not scale with the step; this looks at values only, never at the gradient under test.
template <class Function>
GradientCheck check_gradient(Function f, PointSource points, int samples, double step = 0x1p-17) {
  constexpr double kink_threshold = 1e-7; // second difference a step; rounding leaves some 1e-11
  GradientCheck result;
  for (int i = 0; i < samples; ++i) {
    const vec3<double> p = points();
    const Noise<double> claimed = f(p);
    result.largest_gradient = std::max(result.largest_gradient, length(claimed.gradient));
    bool kink = false;
    double error = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const vec3<double> unit{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
      const auto value = [&](double distance) { return f(p + distance * unit).value; };
      const double far_up = value(step), far_down = value(-step);
      const double up = value(step / 2), down = value(-step / 2);
      const double bend_far = (far_up - 2 * claimed.value + far_down) / step;
      const double bend_near = (up - 2 * claimed.value + down) / step;
      kink |= std::abs(bend_far - 4 * bend_near) > kink_threshold;
      const double wide = (far_up - far_down) / (2 * step);
      const double narrow = (up - down) / step;
      const double off = std::abs((4 * narrow - wide) / 3 - dot(claimed.gradient, unit));
      error = std::isnan(off) ? std::numeric_limits<double>::infinity() : std::max(error, off);
    }
    ++result.samples;
    if (kink) {
      ++result.kinks;
    } else if (error > result.worst_error) {
      result.worst_error = error;
      result.worst_point = p;
    }
  }
  return result;
}

inline void print(const char* name, const GradientCheck& c) {
  std::cout << name << ": worst gradient error " << c.worst_error << " of " << c.largest_gradient
            << " (relative " << c.relative_error() << ") at (" << c.worst_point.x << ", " << c.worst_point.y
            << ", " << c.worst_point.z << "), " << c.kinks << " of " << c.samples << " left out at kinks\n";
}

} // namespace surfgrad::test
