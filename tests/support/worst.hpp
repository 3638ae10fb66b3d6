#pragma once

/// The largest error of a test in units of its bound, with the case that caused it.

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <string>
#include <surfgrad/vec.hpp>

namespace surfgrad::test {

class Worst {
 public:
  explicit Worst(std::string what) : what_(std::move(what)) {}
  Worst(const Worst&) = delete;
  Worst& operator=(const Worst&) = delete;

  /// Prints the worst case; fails if the bound was passed anywhere or nothing was compared.
  ~Worst() {
    EXPECT_GT(count_, 0) << what_ << ": nothing was compared";
    std::printf("  worst error / bound of %s: %.3g in %ld\n", what_.c_str(), ratio_, count_);
    EXPECT_LE(ratio_, 1.0) << what_ << ": case " << where_ << ", got " << got_ << ", expected " << expected_;
  }

  /// `where` names the case: its number from the seed is enough to find it again.
  void add(double got, double expected, double bound, long where) {
    ++count_;
    if (got == expected) return;
    const double ratio = std::abs(got - expected) / bound;
    if (!(ratio <= ratio_)) { // NaN counts as worst
      ratio_ = std::isnan(ratio) ? HUGE_VAL : ratio;
      got_ = got;
      expected_ = expected;
      where_ = where;
    }
  }
  void add(vec2<double> got, vec2<double> expected, double bound, long where) {
    add(got.x, expected.x, bound, where);
    add(got.y, expected.y, bound, where);
  }
  void add(vec3<double> got, vec3<double> expected, double bound, long where) {
    add(got.x, expected.x, bound, where);
    add(got.y, expected.y, bound, where);
    add(got.z, expected.z, bound, where);
  }
  [[nodiscard]] double ratio() const { return ratio_; }

 private:
  std::string what_;
  double ratio_ = 0;
  double got_ = 0;
  double expected_ = 0;
  long where_ = -1;
  long count_ = 0;
};

} // namespace surfgrad::test
