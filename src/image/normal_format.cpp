#include "image/normal_format.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace surfgrad::image {
namespace {

/// Codes that lie between the flat one and that of the range.
double codes_of_range(double most, NeutralCode neutral) {
  return neutral == NeutralCode::between ? most / 2 : (most - 1) / 2;
}

} // namespace

double slope_of_value(double value, double most, double range, NeutralCode neutral) {
  if (most == 0) return range * value;
  const double half = codes_of_range(most, neutral);
  return range * std::max(-1.0, (value * most - (most - half)) / half);
}

NormalFormat::NormalFormat(const NormalCode& code)
    : encoding_(code.encoding), green_sign_(code.green_up ? 1.0f : -1.0f),
      channels_(code.encoding == NormalEncoding::rgb || code.full_blue ? 3 : 2),
      codes_(is_integer(code.depth)), range_(code.range), neutral_(code.neutral) {
  if (!(range_ > 0)) throw std::invalid_argument("a range of slopes is greater than 0");
  value_a_slope_ = static_cast<float>(1 / range_);
  if (!codes_) return;
  const double most = code.depth == Depth::unorm8 ? 255 : 65535;
  const double half = codes_of_range(most, neutral_);
  neutral_value_ = static_cast<float>((most - half) / most);
  value_a_slope_ = static_cast<float>(half / most / range_);
}

std::vector<float> NormalFormat::flat() const {
  std::vector<float> texel(static_cast<std::size_t>(channels_));
  encode({0, 0, 1}, texel.data());
  return texel;
}

NormalFormat::Encoded NormalFormat::encode_turned_slope(vec2<float> slope, float* texel) const {
  Encoded result;
  result.steepest = max_abs(slope);
  if (codes_ && result.steepest > static_cast<float>(range_)) {
    slope = (static_cast<float>(range_) / result.steepest) * slope;
    result.clamped = true;
  }
  texel[0] = neutral_value_ + value_a_slope_ * slope.x;
  texel[1] = neutral_value_ + value_a_slope_ * slope.y;
  if (channels_ == 3) texel[2] = 1.0f;
  return result;
}

vec3<double> NormalFormat::decode(const float* texel, bool integers, double most) const {
  if (encoding_ == NormalEncoding::derivative) {
    const auto slope = [&](double value) {
      return slope_of_value(value, integers ? most : 0, range_, neutral_);
    };
    return {-slope(texel[0]), -green_sign_ * slope(texel[1]), 1};
  }
  vec3<double> n{2.0 * texel[0] - 1, green_sign_ * (2.0 * texel[1] - 1), 0};
  n.z = encoding_ == NormalEncoding::rgb ? 2.0 * texel[2] - 1
                                         : std::sqrt(std::max(0.0, 1 - n.x * n.x - n.y * n.y));
  return n;
}

} // namespace surfgrad::image
