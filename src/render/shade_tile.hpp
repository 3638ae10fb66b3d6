#pragma once

#include "engine/tiles.hpp"
#include "render/shading.hpp"

namespace surfgrad::render {

/// Linear radiance of composed pixels.
///
/// composed  with normal, sunlight and to_viewer
/// radiance  arrays with room for most_lanes beyond `count`
/// With the instruction set in use; same bytes on all.
void shade_pixels(const Shading& shading, const engine::TileWork::Results& composed, int count,
                  vec3<float*> radiance);

/// display_value of each value, in place; the array has room for most_lanes more.
void to_display(float* values, int count);

} // namespace surfgrad::render
