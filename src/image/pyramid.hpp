#pragma once

#include "image/map.hpp"

#include <vector>

namespace surfgrad::image {

/// How values become texels.
struct TexelCode {
  TexelFormat format = TexelFormat::floats;
  double scale = 1; ///< as Map::scale
};

/// A map of these texels (width * height * components, row 0 at the bottom) and its mip pyramid: sides
/// halve, rounded down, to 1x1; a texel is the average over its exact footprint in the level above, so
/// that odd sizes neither shift nor lose energy. Texels must be finite: a level spreads what is not.
/// Averages are of floats; codes are rounded from those, so that rounding does not add up over levels.
[[nodiscard]] Map with_pyramid(std::vector<float> texels, int width, int height, int components,
                               TexelCode code = {});

/// slope16 for slopes below 4 in magnitude, with the smallest power of two for which codes suffice; floats
/// for steeper ones. A power of two makes decoding exact, whether before filtering or after.
[[nodiscard]] TexelCode code_for_slopes(const std::vector<float>& slopes);

/// unorm16 where every value is a code of 16 bits (as every code of 8 bits is) to float rounding, else
/// floats.
[[nodiscard]] TexelCode code_for_scalars(const std::vector<float>& values);

} // namespace surfgrad::image
