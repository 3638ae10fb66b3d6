#include "image/dither.hpp"

#include "image/blue_noise.hpp"

#include <algorithm>
#include <utility>

namespace surfgrad::image {
namespace {

constexpr int most = 255;
// The channels take the mask about a third of it apart: their errors are independent.
constexpr int shift_x[] = {0, 21, 43, 43};
constexpr int shift_y[] = {0, 43, 21, 53};

} // namespace

Dithering::Dithering(std::vector<float> flat) : flat_(std::move(flat)) {
  for (const std::uint16_t rank : blue_noise())
    thresholds_.push_back((static_cast<float>(rank) + 0.5f) / (blue_noise_side * blue_noise_side));
}

void Dithering::row(const float* from, int width, int y, float* to) const {
  const std::size_t channels = flat_.size();
  for (int x = 0; x < width; ++x, from += channels, to += channels) {
    const bool flat = std::equal(flat_.begin(), flat_.end(), from);
    for (std::size_t c = 0; c < channels; ++c) {
      const int column = (x + shift_x[c]) % blue_noise_side;
      const int row = (y + shift_y[c]) % blue_noise_side;
      const float up = flat ? 0.5f : thresholds_[static_cast<std::size_t>(row * blue_noise_side + column)];
      const float value = from[c] > 0 ? from[c] : 0.0f; // also NaN
      const int code = std::min(most, static_cast<int>(std::min(value, 1.0f) * most + up));
      to[c] = static_cast<float>(code) / most;
    }
  }
}

} // namespace surfgrad::image
