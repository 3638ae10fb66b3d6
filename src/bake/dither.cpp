#include "bake/dither.hpp"

#include <utility>

namespace surfgrad::bake {

Dither::Dither(int height, std::vector<float> flat, stage::BandSink take)
    : rows_left_(height), dithering_(std::move(flat)), take_(std::move(take)) {}

void Dither::add(const image::Image& band) {
  stage::reshape(band_, band.width, band.height, band.channels);
  rows_left_ -= band.height;
  for (int y = 0; y < band.height; ++y) {
    float* to = band_.texels.floats().data() + band_.index(0, y);
    const float* from = band.texels.read(band.index(0, y), band.index(band.width, 0), to);
    dithering_.row(from, band.width, rows_left_ + y, to);
  }
  take_(band_);
}

} // namespace surfgrad::bake
