#pragma once

#include "stage/bands.hpp"

#include <vector>

namespace surfgrad::bake {

/// Rounds a map's values in [0, 1] to codes of 8 bits (code / 255), up or down by a mask of blue noise: their
/// means over a few texels are those of the values, where rounding to the nearest code leaves terraces. Flat
/// texels take the nearest code, all the same one. Works on bands on their way to a sink.
class Dither {
 public:
  /// height  of the whole map
  /// flat    the texel to leave alone; pictures have up to four channels
  Dither(int height, std::vector<float> flat, stage::BandSink take);

  /// The next rows from the top downwards.
  void add(const image::Image& band);

 private:
  int rows_left_;
  std::vector<float> flat_;
  stage::BandSink take_;
  std::vector<float> thresholds_; ///< in (0, 1), the mask's
  image::Image band_{};
};

} // namespace surfgrad::bake
