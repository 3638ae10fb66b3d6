#pragma once

#include "bake/verify.hpp"

#include <surfgrad/vec.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace surfgrad::bake {

/// Angle between two directions; 180 where one of them is none.
[[nodiscard]] inline double angle_deg(vec3<double> a, vec3<double> b) {
  if (!(dot(a, a) > 0 && dot(b, b) > 0)) return 180;
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// Angles at the pixels of a picture, in whole numbers: their sum and their distribution do not depend on the
/// order.
class Angles {
 public:
  void add(double degrees, std::int64_t pixel) {
    ++count_;
    sum_ += std::llround(degrees * unit);
    ++bins_[bin_of(degrees)];
    if (degrees > most_ || (degrees == most_ && pixel < where_)) {
      most_ = degrees;
      where_ = pixel;
    }
  }
  void leave_out() { ++left_out_; }
  void add(const Angles& other) {
    count_ += other.count_;
    left_out_ += other.left_out_;
    sum_ += other.sum_;
    for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
    if (other.most_ > most_ || (other.most_ == most_ && other.where_ < where_)) {
      most_ = other.most_;
      where_ = other.where_;
    }
  }
  /// width  of the picture
  [[nodiscard]] Deviation summary(int width) const {
    const std::int64_t where = count_ == 0 ? 0 : where_;
    return {count_,
            left_out_,
            count_ == 0 ? 0 : static_cast<double>(sum_) / unit / static_cast<double>(count_),
            exceeded_by(1e-3),
            most(),
            static_cast<int>(where % width),
            static_cast<int>(where / width)};
  }

 private:
  [[nodiscard]] double most() const { return std::max(most_, 0.0); }
  /// The least angle, rounded up, that no more than this share of all exceeds.
  [[nodiscard]] double exceeded_by(double share) const {
    std::int64_t above = count_;
    std::size_t i = 0;
    for (; i + 1 < bins_.size(); ++i) {
      above -= bins_[i];
      if (static_cast<double>(above) <= share * static_cast<double>(count_)) break;
    }
    return std::min(most(), double{std::bit_cast<float>(static_cast<std::uint32_t>(i + 1) << bin_shift)});
  }

  static constexpr double unit = 1 << 24; // a part of 2^-24 degrees; the sum of 2^28 texels fits
  // Positive floats sort as their bits do: sign, exponent and eight bits of the fraction.
  static constexpr int bin_shift = 15;
  static std::size_t bin_of(double degrees) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(degrees)) >> bin_shift;
  }

  std::int64_t count_ = 0;
  std::int64_t left_out_ = 0;
  std::int64_t sum_ = 0;
  std::vector<std::int64_t> bins_ = std::vector<std::int64_t>(std::size_t{1} << (31 - bin_shift));
  double most_ = -1;
  std::int64_t where_ = 0;
};

} // namespace surfgrad::bake
