#include "bake/dither.hpp"

#include "bake/blue_noise.hpp"

#include <algorithm>

namespace surfgrad::bake {
namespace {

constexpr int most = 255;
// The channels take the mask about a third of it apart: their errors are independent.
constexpr int shift_x[] = {0, 21, 43, 43};
constexpr int shift_y[] = {0, 43, 21, 53};

} // namespace

DitherMask::DitherMask(std::vector<float> flat) : flat_(std::move(flat)) {
  for (const std::uint16_t rank : blue_noise())
    thresholds_.push_back((static_cast<float>(rank) + 0.5f) / (blue_noise_side * blue_noise_side));
}

void DitherMask::round_row(const float* from, int width, int channels, int y, float* to) const {
  for (int x = 0; x < width; ++x, from += channels, to += channels) {
    const bool flat = std::equal(flat_.begin(), flat_.end(), from);
    for (int c = 0; c < channels; ++c) {
      const int column = (x + shift_x[c]) % blue_noise_side;
      const int row = (y + shift_y[c]) % blue_noise_side;
      const float up = flat ? 0.5f : thresholds_[static_cast<std::size_t>(row * blue_noise_side + column)];
      const float value = from[c] > 0 ? from[c] : 0.0f; // also NaN
      const int code = std::min(most, static_cast<int>(std::min(value, 1.0f) * most + up));
      to[c] = static_cast<float>(code) / most;
    }
  }
}

Dither::Dither(int height, std::vector<float> flat, stage::BandSink take)
    : rows_left_(height), mask_(std::move(flat)), take_(std::move(take)) {}

void Dither::add(const image::Image& band) {
  stage::reshape(band_, band.width, band.height, band.channels);
  rows_left_ -= band.height;
  for (int y = 0; y < band.height; ++y) {
    float* to = band_.texels.floats().data() + band_.index(0, y);
    const float* from = band.texels.read(band.index(0, y), band.index(band.width, 0), to);
    mask_.round_row(from, band.width, band.channels, rows_left_ + y, to);
  }
  take_(band_);
}

} // namespace surfgrad::bake
