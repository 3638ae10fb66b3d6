#pragma once

#include "image/map.hpp"

#include <functional>
#include <vector>

namespace surfgrad::image {

/// How values become texels.
struct TexelCode {
  TexelFormat format = TexelFormat::floats;
  double scale = 1; ///< as Map::scale
};

/// Makes a row of texels (width * components floats, row 0 at the bottom). Called from any thread, and more
/// than once for some rows, with the same outcome.
using TexelRows = std::function<void(int y, float* texels)>;

/// Those of an array of width * height * components floats, which must outlive them.
[[nodiscard]] TexelRows rows_of(const std::vector<float>& texels, int width, int components);

/// A map of these texels and its mip pyramid: sides halve, rounded down, to 1x1; a texel is the average over
/// its exact footprint in the level above, so that odd sizes neither shift nor lose energy. Texels must be
/// finite: a level spreads what is not. Averages are of floats; codes are rounded from those, so that
/// rounding does not add up over levels.
///
/// read  of rows that are made for the last time
[[nodiscard]] Map with_pyramid(const TexelRows& rows, int width, int height, int components,
                               TexelCode code = {}, const RowsRead& read = {});

/// slope16 for slopes below 4 in magnitude, with the smallest power of two for which codes suffice; floats
/// for steeper ones. A power of two makes decoding exact, whether before filtering or after.
[[nodiscard]] TexelCode code_for_slopes(const TexelRows& slopes, int width, int height);

/// unorm16 where every value is a code of 16 bits (as every code of 8 bits is) to float rounding, else
/// floats.
[[nodiscard]] TexelCode code_for_scalars(const TexelRows& values, int width, int height);

} // namespace surfgrad::image
