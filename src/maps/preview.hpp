#pragma once

#include "image/image.hpp"

namespace surfgrad::maps {

/// Side of each half of a preview.
inline constexpr int preview_side = 512;

/// A picture of slopes for people, three channels of display values: to the left a plate with these bumps lit
/// from the upper left, to the right how often each slope occurs (logarithmically, zero in the middle, a
/// slope of `range` along an axis at the border), brighter for more. The range is the smallest power of two
/// that holds 99.9 % of all slopes.
struct Preview {
  image::Image picture{};
  double range = 1;
};
[[nodiscard]] Preview preview(const image::Image& slopes);

} // namespace surfgrad::maps
