#pragma once

#include "image/image.hpp"
#include "maps/differentiate.hpp"

namespace surfgrad::maps {

/// A picture in another size, each texel the mean over its own area where it shrinks (of texels as constant
/// squares), linear between texel centres where it grows; axis by axis. Slopes and heights average linearly:
/// a tilted map keeps its tilt.
[[nodiscard]] image::Image resampled(image::Image picture, int width, int height, Border border);

} // namespace surfgrad::maps
