#pragma once

#include "stage/bands.hpp"

#include <vector>

namespace surfgrad::bake {

/// Rounds values in [0, 1] to codes of 8 bits (code / 255), up or down by a mask of blue noise: their means
/// over a few texels are those of the values, where rounding to the nearest code leaves terraces. Flat texels
/// take the nearest code, all the same one.
class DitherMask {
 public:
  /// flat  the texel to leave alone; pictures have as many channels as it has, or one more; up to four
  explicit DitherMask(std::vector<float> flat);

  /// A row of a picture.
  ///
  /// y   counted in the whole picture from its bottom
  /// to  may be `from`
  void round_row(const float* from, int width, int channels, int y, float* to) const;

 private:
  std::vector<float> flat_;
  std::vector<float> thresholds_; ///< in (0, 1)
};

/// The mask on bands on their way to a sink.
class Dither {
 public:
  /// height  of the whole map
  Dither(int height, std::vector<float> flat, stage::BandSink take);

  /// The next rows from the top downwards.
  void add(const image::Image& band);

 private:
  int rows_left_;
  DitherMask mask_;
  stage::BandSink take_;
  image::Image band_{};
};

} // namespace surfgrad::bake
