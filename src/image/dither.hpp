#pragma once

#include <vector>

namespace surfgrad::image {

/// Rounds values in [0, 1] to codes of 8 bits (code / 255), up or down by a mask of blue noise: their means
/// over a few texels are those of the values, where rounding to the nearest code leaves terraces. Flat texels
/// take the nearest code, all the same one.
class Dithering {
 public:
  /// flat  the texel to leave alone: as many values as there are channels, up to 4
  explicit Dithering(std::vector<float> flat);

  /// A row of a picture.
  ///
  /// y   counted in the whole picture, the same way for all its rows
  /// to  may be `from`
  void row(const float* from, int width, int y, float* to) const;

 private:
  std::vector<float> flat_;
  std::vector<float> thresholds_; ///< in (0, 1), the mask's
};

} // namespace surfgrad::image
