#pragma once

#include "image/image.hpp"
#include "image/normal_format.hpp"

#include <cstdint>
#include <functional>

namespace surfgrad::maps {

/// How slopes are written.
struct Writing {
  image::NormalCode code{};
  bool dither = false; ///< depth unorm8: blue noise in place of terraces
};

/// What writing slopes met.
struct Written {
  std::int64_t beyond_range = 0; ///< texels of encoding derivative; they keep their direction
  double steepest = 0;           ///< the largest slope along an axis
};

/// Receives a picture in bands of rows from its top to its bottom, each an image of its own (row 0 its
/// lowest).
using TakeBand = std::function<void(const image::Image& band)>;

/// Slopes as a map of normals or derivatives, band by band: the map as a whole is nowhere in memory.
Written write_slopes(const image::Image& slopes, const Writing& writing, const TakeBand& take);

} // namespace surfgrad::maps
