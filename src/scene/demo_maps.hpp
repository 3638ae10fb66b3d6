#pragma once

#include "image/image.hpp"

namespace surfgrad::scene {

/// Tileable normal map of rounded plates in a running bond, 16-bit. size in texels, a multiple of 8.
[[nodiscard]] image::Image plates_normal_map(int size);

/// Tileable normal map of a plain weave, 16-bit.
[[nodiscard]] image::Image weave_normal_map(int size);

/// Tileable mask of soft stripes, 8-bit grey.
[[nodiscard]] image::Image stripes_mask(int size);

} // namespace surfgrad::scene
