#pragma once

#include "image/image.hpp"

namespace surfgrad::gallery {

// Built-in maps of relief. Sizes in texels; 16-bit.

/// Normal map of a raised letter F on a field of knobs. Not tileable: it is for decals.
[[nodiscard]] image::Image letter_normals(int size);

/// The same as a cube map of object-space normals, six faces of `face` texels from left to right: the
/// letter on +z, upright with +x to its right, and knobs on every face.
[[nodiscard]] image::Image letter_cube(int face);

/// Tileable heights of rounded stones, each of its own height, with joints between them.
[[nodiscard]] image::Image cobble_heights(int size);

/// Tileable normal map of a rock face: few large forms, which betray repetition, and fine ones.
[[nodiscard]] image::Image crag_normals(int size);

} // namespace surfgrad::gallery
