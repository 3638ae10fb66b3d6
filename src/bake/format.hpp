#pragma once

#include "bake/bake.hpp"

#include <surfgrad/vec.hpp>

#include <vector>

namespace surfgrad::bake {

/// How a map's texels stand for normals, and back.
class Format {
 public:
  /// Throws std::invalid_argument where the encoding cannot hold the space.
  explicit Format(const Options& options);

  [[nodiscard]] int channels() const { return channels_; }
  /// The texel of the normal (0, 0, 1).
  [[nodiscard]] std::vector<float> flat() const;

  /// What encoding a normal met.
  struct Encoded {
    float steepest = 0;   ///< the larger of its slopes, where slopes are stored
    bool clamped = false; ///< it is beyond the range; its direction is kept
  };
  [[nodiscard]] bool holds_slopes() const { return encoding_ == Encoding::derivative; }
  /// texel  `channels` values
  Encoded encode(vec3<float> normal, float* texel) const {
    if (holds_slopes()) return encode_slopes(normal, texel);
    encode_components(normal, texel);
    return {};
  }
  /// The same where no slopes are held.
  void encode_components(vec3<float> normal, float* texel) const {
    texel[0] = 0.5f * normal.x + 0.5f;
    texel[1] = 0.5f * (green_sign_ * normal.y) + 0.5f;
    if (channels_ == 3) texel[2] = encoding_ == Encoding::rgb ? 0.5f * normal.z + 0.5f : 1.0f;
  }
  /// Some multiple of the normal that every reader makes of a texel of a file.
  ///
  /// integers  the file holds codes of `most` + 1 values, scaled to [0, 1]
  [[nodiscard]] vec3<double> decode(const float* texel, bool integers, double most) const;

 private:
  Encoded encode_slopes(vec3<float> normal, float* texel) const;

  Encoding encoding_;
  float green_sign_;
  int channels_;
  bool codes_; ///< slopes are stored as codes in [0, 1], not as they are
  double range_;
  stack::NeutralCode neutral_;
  // What slopes are written as: neutral_value_ + value_a_slope_ * slope.
  float neutral_value_ = 0;
  float value_a_slope_ = 1;
};

} // namespace surfgrad::bake
