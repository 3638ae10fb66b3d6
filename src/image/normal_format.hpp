#pragma once

#include "image/map.hpp"

#include <surfgrad/derivative.hpp>
#include <surfgrad/vec.hpp>

#include <vector>

namespace surfgrad::image {

/// How a texel stands for a normal n.
enum class NormalEncoding {
  rgb,        ///< n / 2 + 1/2
  rg,         ///< the first two of these; readers reconstruct z. Tangent space alone
  derivative, ///< slopes, as a layer `derivative_map` reads them. Tangent space alone
};

/// How a map of normals is written.
struct NormalCode {
  NormalEncoding encoding = NormalEncoding::rgb;
  bool green_up = true;
  /// Encodings of two channels: a third one of 1, for files whose two channels would be grey and opacity.
  bool full_blue = false;
  /// What the map is to be written with: slopes are codes in integer files only.
  Depth depth = Depth::unorm16;
  /// Encoding derivative: slope of the largest code, and the code that means flat; see make_derivative_map.
  double range = 1;
  NeutralCode neutral = NeutralCode::between;
};

/// Slope that a value of a derivative map stands for.
///
/// value  as Image has it: code / most in integer files
/// most   largest code; 0 for files of floats
[[nodiscard]] double slope_of_value(double value, double most, double range, NeutralCode neutral);

/// How a map's texels stand for normals, and back.
class NormalFormat {
 public:
  /// Throws std::invalid_argument where the range is not above 0.
  explicit NormalFormat(const NormalCode& code);

  [[nodiscard]] int channels() const { return channels_; }
  /// The texel of the normal (0, 0, 1).
  [[nodiscard]] std::vector<float> flat() const;

  /// What encoding a normal met.
  struct Encoded {
    float steepest = 0;   ///< the larger of its slopes, where slopes are stored
    bool clamped = false; ///< it is beyond the range; its direction is kept
  };
  /// texel  `channels` values
  Encoded encode(vec3<float> normal, float* texel) const {
    normal.y *= green_sign_;
    if (encoding_ == NormalEncoding::derivative)
      return encode_turned_slope(derivative_from_normal(normal), texel);
    texel[0] = 0.5f * normal.x + 0.5f;
    texel[1] = 0.5f * normal.y + 0.5f;
    if (channels_ == 3) texel[2] = encoding_ == NormalEncoding::rgb ? 0.5f * normal.z + 0.5f : 1.0f;
    return {};
  }
  /// The same for a slope (dh/ds, dh/dt); encoding derivative.
  Encoded encode_slope(vec2<float> slope, float* texel) const {
    slope.y *= green_sign_;
    return encode_turned_slope(slope, texel);
  }
  /// Some multiple of the normal that every reader makes of a texel of a file.
  ///
  /// integers  the file holds codes of `most` + 1 values, scaled to [0, 1]
  [[nodiscard]] vec3<double> decode(const float* texel, bool integers, double most) const;

 private:
  Encoded encode_turned_slope(vec2<float> slope, float* texel) const;

  NormalEncoding encoding_;
  float green_sign_;
  int channels_;
  bool codes_; ///< slopes are stored as codes in [0, 1], not as they are
  double range_;
  NeutralCode neutral_;
  // What slopes are written as: neutral_value_ + value_a_slope_ * slope.
  float neutral_value_ = 0;
  float value_a_slope_ = 1;
};

} // namespace surfgrad::image
