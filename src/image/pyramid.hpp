#pragma once

#include "image/map.hpp"

#include <vector>

namespace surfgrad::image {

/// A map of these texels (width * height * components, row 0 at the bottom) and its mip pyramid: sides
/// halve, rounded down, to 1x1; a texel is the average over its exact footprint in the level above, so
/// that odd sizes neither shift nor lose energy. Texels must be finite: a level spreads what is not.
[[nodiscard]] Map with_pyramid(std::vector<float> texels, int width, int height, int components);

} // namespace surfgrad::image
