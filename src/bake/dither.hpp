#pragma once

#include "image/dither.hpp"
#include "stage/bands.hpp"

#include <vector>

namespace surfgrad::bake {

/// image::Dithering of the bands of a map on their way to a sink.
class Dither {
 public:
  /// height  of the whole map
  /// flat    the texel to leave alone
  Dither(int height, std::vector<float> flat, stage::BandSink take);

  /// The next rows from the top downwards.
  void add(const image::Image& band);

 private:
  int rows_left_;
  image::Dithering dithering_;
  stage::BandSink take_;
  image::Image band_{};
};

} // namespace surfgrad::bake
