#pragma once

#include "bake/roughness.hpp"
#include "image/image.hpp"

namespace surfgrad::maps {

/// The normal of each texel of slopes: what averages to roughness_of_means.
[[nodiscard]] image::Image unit_normals(const image::Image& slopes);

/// The roughness that normals amount to which differ within texels, on top of that of the surface.
///
/// means    of unit normals, three channels
/// returns  one channel of floats, bake::widened_alpha's square root
[[nodiscard]] image::Image roughness_of_means(const image::Image& means, const bake::BaseRoughness& base);

} // namespace surfgrad::maps
