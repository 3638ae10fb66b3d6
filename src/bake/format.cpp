#include "bake/format.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace surfgrad::bake {
namespace {

/// Codes that lie between the flat one and that of the range.
double codes_of_range(double most, stack::NeutralCode neutral) {
  return neutral == stack::NeutralCode::between ? most / 2 : (most - 1) / 2;
}

} // namespace

Format::Format(const Options& options)
    : encoding_(options.encoding), green_sign_(options.green == stack::Green::up ? 1.0f : -1.0f),
      channels_(options.encoding == Encoding::rgb || options.full_blue ? 3 : 2),
      codes_(image::is_integer(options.depth)), range_(options.range), neutral_(options.neutral) {
  if (encoding_ != Encoding::rgb && options.space != Space::tangent)
    throw std::invalid_argument("two channels hold normals of a tangent space alone");
  if (!(range_ > 0)) throw std::invalid_argument("a range of slopes is greater than 0");
  value_a_slope_ = static_cast<float>(1 / range_);
  if (!codes_) return;
  const double most = options.depth == image::Depth::unorm8 ? 255 : 65535;
  const double half = codes_of_range(most, neutral_);
  neutral_value_ = static_cast<float>((most - half) / most);
  value_a_slope_ = static_cast<float>(half / most / range_);
}

std::vector<float> Format::flat() const {
  std::vector<float> texel(static_cast<std::size_t>(channels_));
  encode({0, 0, 1}, texel.data());
  return texel;
}

Format::Encoded Format::encode_slopes(vec3<float> normal, float* texel) const {
  Encoded result;
  normal.y *= green_sign_;
  vec2<float> slope = derivative_from_normal(normal);
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

vec3<double> Format::decode(const float* texel, bool integers, double most) const {
  if (encoding_ == Encoding::derivative) {
    const double half = codes_of_range(most, neutral_);
    const auto slope = [&](double value) {
      return range_ * (integers ? std::max(-1.0, (value * most - (most - half)) / half) : value);
    };
    return {-slope(texel[0]), -green_sign_ * slope(texel[1]), 1};
  }
  vec3<double> n{2.0 * texel[0] - 1, green_sign_ * (2.0 * texel[1] - 1), 0};
  n.z = encoding_ == Encoding::rgb ? 2.0 * texel[2] - 1 : std::sqrt(std::max(0.0, 1 - n.x * n.x - n.y * n.y));
  return n;
}

} // namespace surfgrad::bake
