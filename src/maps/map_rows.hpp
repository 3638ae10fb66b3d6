#pragma once

#include "bake/dither.hpp"
#include "image/image.hpp"

#include <optional>
#include <vector>

namespace surfgrad::maps {

/// A picture that is made row by row, of floats, and kept as a file of its depth will have it: as codes where
/// that is of integers. Rows may come from several threads.
class MapRows {
 public:
  /// flat  where given, a depth of 8 bits is dithered but for this texel
  MapRows(int width, int height, int channels, image::Depth depth,
          std::optional<std::vector<float>> flat = {});

  [[nodiscard]] int channels() const { return map_.channels; }
  /// Takes a row of width * channels values, which it may change.
  void put(int y, std::vector<float>& row);
  [[nodiscard]] image::Image take();

 private:
  image::Image map_;
  std::optional<bake::DitherMask> mask_{};
  image::Texels::Codes8 codes8_{}; ///< one of these three
  image::Texels::Codes16 codes16_{};
  image::Texels::Floats floats_{};
};

} // namespace surfgrad::maps
